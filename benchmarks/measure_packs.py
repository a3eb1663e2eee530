#!/usr/bin/env python3
"""Compares how long `glint compile` takes with a lobe of a pack and with the same lobe built in.

    benchmarks/measure_packs.py [--rounds N] [--keys K]

The pack is a copy of shaders/materials/sheen under another name and extension, and the scenes are those of
benchmarks/make_synthetic_scene.py: every second key has the lobe. Both are compiled in turn with empty caches, each
first in every second round. Prints Markdown: CPU seconds of all cores, and the ratio of each round, pack to built in.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import tempfile

from make_synthetic_scene import SWITCHES, write_scene
from measure_compile import ROOT, compile_scene, spread

OWN = "KHR_materials_sheen"
PACKS = "BENCH_materials_velvet"


def renamed(text):
    """Calls the sheen velvet, except in what the lobe includes: Glint's fit of its albedo."""
    def velvet(match):
        word = match.group()
        if word.lower().startswith(("sheenalbedo", "sheen_albedo", "materials/")) or word == "kMinSheenAlpha":
            return word
        return word.replace("sheen", "velvet").replace("Sheen", "Velvet").replace("SHEEN", "VELVET")

    return re.sub(r"materials/[\w/.]+|\w+", velvet, text.replace(OWN, PACKS))


def write_pack(folder):
    folder.mkdir(parents=True)
    for file in (ROOT / "shaders/materials/sheen").iterdir():
        if file.name != "sheen_albedo.glsl":
            (folder / file.name.replace("sheen", "velvet")).write_text(renamed(file.read_text()))


def write_scenes(work, keys):
    """Writes the scene with the built-in lobe, and the same with that of the pack; returns both paths."""
    own = write_scene(work / "own", keys, keys)
    pack = write_scene(work / "pack", keys, keys)
    scene = json.loads(renamed(pack.read_text()))
    pack.write_text(json.dumps(scene))
    return own, pack


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--rounds", type=int, default=7, help="default 7")
    parser.add_argument("--keys", type=int, default=32, help="default 32")
    arguments = parser.parse_args()
    least = 2 << SWITCHES.index("sheen")
    if arguments.keys < least or arguments.rounds < 1:
        parser.error(f"--keys must be at least {least}, of which half have the lobe, and --rounds at least 1")
    with tempfile.TemporaryDirectory(prefix="glint-packs-") as name:
        work = pathlib.Path(name)
        write_pack(work / "velvet" / "velvet")
        own, pack = write_scenes(work, arguments.keys)
        seconds = {"built in": [], "pack": []}
        modules = {}
        for round_number in range(arguments.rounds):
            order = list(seconds) if round_number % 2 == 0 else list(seconds)[::-1]
            for which in order:
                run = work / f"{which.replace(' ', '_')}_{round_number}"
                scene, options = (own, []) if which == "built in" else (pack, ["--materials", work / "velvet"])
                _, cpu, compiled, report = compile_scene(scene, run / "package", run / "cache", *options)
                seconds[which].append(cpu)
                modules[which] = (compiled, report["spirvBytes"])
    ratios = [ours / theirs for theirs, ours in zip(seconds["built in"], seconds["pack"])]
    print(f"{arguments.keys} keys, {arguments.rounds} rounds, {os.cpu_count()} cores\n")
    print("| lobe | modules | SPIR-V, bytes | CPU, s |")
    print("|---|---|---|---|")
    for which, values in seconds.items():
        print(f"| {which} | {modules[which][0]} | {modules[which][1]:,} | {spread(values)} |")
    print(f"\npack / built in: {statistics.median(ratios):.3f} ({min(ratios):.3f} to {max(ratios):.3f})")


if __name__ == "__main__":
    main()
