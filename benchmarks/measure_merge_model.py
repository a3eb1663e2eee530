#!/usr/bin/env python3
"""Measures the code of cases for benchmarks/fit_merge_model.py, and writes benchmarks/data/merge_model.csv.

Synthetic scenes (benchmarks/merge_scenes.py) are compiled by `glint compile --strategy visibility`; the manifest of each
package has the instructions and texture fetches of its cases' SPIR-V. Each row of the CSV is one case:

    set            the purpose of the measurement, below
    always         the features that all of its keys have, separated by blanks
    sometimes      the features on which it branches
    instructions   of the SPIR-V, and so are the next two
    fetches
    bytes

    alone      --merge none: each feature by itself, and on a textured surface; the fit uses all of them
    together   --merge none: random keys of up to nine wishes
    family     --merge family: random keys with the same lobes
    all        --merge all: two to seven random keys in one case

The same `glint` gives the same file, byte for byte.

    benchmarks/measure_merge_model.py [--glint PATH]      default: build/release/bin/glint; about a minute
"""
import argparse
import csv
import json
import pathlib
import random
import subprocess
import sys
import tempfile

from merge_scenes import FEATURES, INPUTS, LOBES, TEXTURES, complete, make_scene

ROOT = pathlib.Path(__file__).resolve().parent.parent
MEASUREMENTS = ROOT / "benchmarks/data/merge_model.csv"
COLUMNS = ["set", "always", "sometimes", "instructions", "fetches", "bytes"]
SEED = 20250321
# These features replace the lobes of metal and roughness, and mix with no other.
EXCLUSIVE = ("unlit", "specularGlossiness")


def compile_scene(glint, folder, kind, wishes, merge):
    """A row of COLUMNS for each case of a scene with these wishes."""
    scene, package = folder / "scene.gltf", folder / "scene.glint"
    scene.write_text(make_scene(list(dict.fromkeys(wishes))))
    command = [glint, "compile", scene, "-o", package, "--merge", merge, "--strategy", "visibility", "--cache", "none"]
    command += ["--no-trust-textures"]  # what the wishes ask for stays, whatever the textures hold
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"measure_merge_model.py: {' '.join(map(str, command))}\n{done.stderr}")
    rows = []
    for entry in json.loads((package / "manifest.json").read_text())["shaders"]:
        code = entry["stages"]["visibility"]
        features = [" ".join(sorted(entry[which])) for which in ("always", "sometimes")]
        rows.append([kind, *features, code["instructions"], code["textureFetches"], code["bytes"]])
    return rows


def measure(glint):
    rng = random.Random(SEED)
    mixable = [f for f in FEATURES if f not in EXCLUSIVE]

    def random_key(most):
        return complete(rng.sample(mixable, 1 + rng.randrange(most)))

    # alphaMask is left out, because rays test alpha before a case is reached.
    alone = [complete({f}) for f in FEATURES] + [complete({f, "normals", "baseColorTexture"}) for f in FEATURES]
    alone += [frozenset(), complete({"unlit", "vertexColor"}), complete({"unlit", "baseColorTexture", "vertexColor"})]
    together = [random_key(9) for _ in range(120)]
    families = []
    inputs = TEXTURES[:5] + [f for f in INPUTS if f != "clearcoatSharesNormal"]
    for lobes in (0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 3, 3):
        family = set(rng.sample([f for f in LOBES if f not in EXCLUSIVE], lobes))
        families += [complete(family | set(rng.sample(inputs, rng.randrange(7)))) for _ in range(4)]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        rows = compile_scene(glint, folder, "alone", alone, "none")
        rows += compile_scene(glint, folder, "together", together, "none")
        rows += compile_scene(glint, folder, "family", families, "family")
        for _ in range(28):
            wishes = [random_key(6) for _ in range(rng.randint(2, 7))]
            rows += compile_scene(glint, folder, "all", wishes, "all")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="the command that compiles")
    rows = measure(parser.parse_args().glint)
    with MEASUREMENTS.open("w", newline="", encoding="ascii") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)
    print(f"wrote {MEASUREMENTS.relative_to(ROOT)}: {len(rows)} cases")


if __name__ == "__main__":
    main()
