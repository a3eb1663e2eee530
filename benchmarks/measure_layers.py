#!/usr/bin/env python3
"""Measures what each layer of docs/layers.md costs in time, and its bytes.

    benchmarks/measure_layers.py SCENE [--size 160x90] [--rounds N] [--effects LIST] [--strategy NAME] [OPTION]...

Compiles a package for each layer, and one with no layer, and lets `glint bench` measure all of them: each round renders
a picture with every package, in random order, and divides its device time by that of the package without layers. What a
layer is computed from comes with it, and its time and bytes count. Layers of light are those of one source each.
Further options, such as --tracer, go to `glint compile` and `glint bench`.
Prints Markdown: the median of the rounds' ratios and its interval, and bytes a pixel.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
GLINT = ROOT / "build/release/bin/glint"
# "all" leaves these out. Those that need features of the device are not measured.
DIAGNOSTIC = ["lobes", "branches", "footprint", "texture-level", "reflection.hit-shader", "rays", "non-finite",
              "reflection.workgroup", "reflection.cases-run"]
# Layers of other sources cost what these do.
SOURCES = ["direct", "reflection"]


def run(*words):
    done = subprocess.run([GLINT, *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"measure_layers.py: glint {' '.join(map(str, words))}\n{done.stderr}")
    return done.stdout


def layers_of(package):
    """Name and bytes a pixel of each layer of a package."""
    return {layer["name"]: layer["bytes"] for layer in json.loads(run("inspect", package, "--json"))["layers"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scene")
    parser.add_argument("--size", default="160x90", help="default 160x90")
    parser.add_argument("--rounds", type=int, default=11, help="default 11")
    parser.add_argument("--effects", default="auto,indirect-diffuse", help="default auto,indirect-diffuse")
    parser.add_argument("--strategy", default="visibility", help="default visibility")
    arguments, further = parser.parse_known_args()
    same = ["--effects", arguments.effects, "--strategy", arguments.strategy, *further]
    with tempfile.TemporaryDirectory(prefix="glint-layers-") as name:
        work = pathlib.Path(name)
        run("compile", arguments.scene, "-o", work / "all", "--layers", "all", *same)
        known = [layer for layer in layers_of(work / "all")
                 if "." not in layer or layer.split(".")[0] in SOURCES]
        words = []
        for layer in [*known, *DIAGNOSTIC, "all"]:
            run("compile", arguments.scene, "-o", work / layer, "--layers", layer, *same)
            words += ["--candidate", f"{layer}={work / layer}"]
        # No setting of the sweep is measured: --only names one that has no other value here.
        run("bench", arguments.scene, "-o", work / "bench", *same, *words, "--only", "precision", "--depth", "singles",
            "--size", arguments.size, "--rounds", arguments.rounds, "--spp", 4, "--reference", "same",
            "--reference-spp", 128, "--reference-error", 1)
        report = json.loads((work / "bench/bench.json").read_text())
        default = report["points"][0]["time"]["median"]
        print(f"{report['machine']['device']}, {arguments.scene}, {arguments.size}, {arguments.strategy}, "
              f"{arguments.rounds} rounds, {default:.1f} ms without layers\n")
        print("| layer | comes with | bytes a pixel | time, with / without |")
        print("|---|---|---|---|")
        for point in report["points"]:
            if point["package"] is None:
                continue
            layers = layers_of(point["package"])
            others = [f"`{layer}`" for layer in layers if layer != point["name"]]
            ratio = point["ratio"]
            print(f"| `{point['name']}` | {', '.join(others) if len(others) < 4 else f'{len(others)} layers'} "
                  f"| {sum(layers.values())} | {ratio['median']:.3f} ({ratio['low']:.3f} to {ratio['high']:.3f}) |")


if __name__ == "__main__":
    main()
