#!/usr/bin/env python3
"""Measures how long `glint compile --watch` takes after an edit, for docs/compile_times.md.

    benchmarks/compile/measure_watch.py [--models N] [--rounds N] [GLINT…]

A list has N models with a material each: copies of examples/materials/models/blinn_phong, of which every second has a
texture. Every program (default: the built one) watches a copy of its own, and gets the same edits in turn: of one
model's GLSL, and of one value in the list. A program may have options behind it in the same word. Prints Markdown:
medians in milliseconds of the parts that the watch prints, of the time from the edit to its line, with the least and
the most, and of processor time; and the ratio of the time to that of the first program. At the end each watch's package
is compared with that of a fresh run.
"""
import argparse
import json
import os
import pathlib
import re
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODEL = ROOT / "examples/materials/models/blinn_phong"
COMPILE = ["compile", "materials.json", "--materials", "packs", "--effects", "shadow", "--strategy", "visibility"]
LINE = re.compile(r"(\d+) ms: read (\d+), plan (\d+), compile (\d+), write (\d+)")


def name_of(number):
    return "model" + "".join(chr(ord("a") + number // 26**place % 26) for place in (2, 1, 0))


def write_list(folder, count):
    materials = []
    for number in range(count):
        name = name_of(number)
        (folder / "packs" / name).mkdir(parents=True)
        for source in MODEL.iterdir():
            text = source.read_text().replace("blinnPhong", name).replace("BlinnPhong", name.capitalize())
            text = text.replace("BLINN_PHONG", name.upper()).replace("blinn_phong", name)
            text = text.replace('"short": "Blinn', f'"short": "M{number}').replace("n + 2.0", f"n + 2.{number:04d}")
            (folder / "packs" / name / source.name.replace("blinn_phong", name)).write_text(text)
        materials.append({"name": name, "model": name, "values": {"specular": [0.1 + 1e-4 * number, 0.2, 0.3]}})
        if number % 2 == 1:
            materials[-1]["textures"] = {"specularTexture": "texture.png"}
    shutil.copy(ROOT / "examples/cmake-consumer/scene/tiles.png", folder / "texture.png")
    (folder / "materials.json").write_text(json.dumps({"materialList": 1, "materials": materials}))


def processor_ms(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) * 1000 / os.sysconf("SC_CLK_TCK")


def next_line(process):
    for line in process.stdout:
        if found := LINE.search(line):
            return [int(number) for number in found.groups()[1:]]
    sys.exit("measure_watch.py: a watch has ended")


def edited(folder, kind, number, round_number):
    """The file that the edit replaces, and its new text."""
    if kind == "value":
        file = folder / "materials.json"
        document = json.loads(file.read_text())
        document["materials"][number]["values"]["specular"][2] = 0.4 + 1e-3 * round_number
        return file, json.dumps(document)
    file = folder / "packs" / name_of(number) / f"{name_of(number)}.glsl"
    return file, file.read_text().replace("n + 4.0", f"n + 4.{round_number + 1}")


def measure(folder, process, kind, number, round_number):
    time.sleep(0.5)
    file, text = edited(folder, kind, number, round_number)
    new = file.with_suffix(".new")
    new.write_text(text)
    before = processor_ms(process)
    start = time.monotonic()
    new.rename(file)
    parts = next_line(process)
    return [*parts, (time.monotonic() - start) * 1000, processor_ms(process) - before]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint", nargs="*", default=[str(ROOT / "build/release/bin/glint")], metavar="GLINT")
    parser.add_argument("--models", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    programs = []
    for words in map(shlex.split, arguments.glint):
        programs.append([os.path.abspath(words[0]), *COMPILE, *words[1:]])
    with tempfile.TemporaryDirectory() as work:
        watches = []
        for index, program in enumerate(programs):
            folder = pathlib.Path(work) / str(index)
            write_list(folder, arguments.models)
            options = ["-o", "out", "--cache", pathlib.Path(work) / "cache", "--watch"]
            watches.append((folder, subprocess.Popen([*program, *options], cwd=folder, text=True,
                                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)))
            next_line(watches[-1][1])
        print("| edit | program | read | plan | compile | write | from the edit to the line | processor time |")
        print("|---|---|--:|--:|--:|--:|--:|--:|")
        for kind in ("GLSL", "value"):
            results = [[] for _ in watches]
            for turn in range(arguments.rounds):
                order = range(len(watches)) if turn % 2 == 0 else reversed(range(len(watches)))
                for index in order:
                    number = 7 * turn % arguments.models
                    results[index].append(measure(*watches[index], kind, number, turn))
            for index, rows in enumerate(results):
                middle = [round(statistics.median(column)) for column in zip(*rows)]
                times = [row[4] for row in rows]
                ratios = sorted(row[4] / first[4] for row, first in zip(rows, results[0]))
                print(f"| {kind} | {arguments.glint[index]} | " + " | ".join(map(str, middle[:4])) +
                      f" | {middle[4]} ({min(times):.0f} to {max(times):.0f}); {statistics.median(ratios):.2f} "
                      f"({ratios[0]:.2f} to {ratios[-1]:.2f}) | {middle[5]} |", flush=True)
        for (folder, process), program in zip(watches, programs):
            process.terminate()
            process.wait()
            subprocess.run([*program, "-o", "fresh", "-q", "--cache", pathlib.Path(work) / "cache"], cwd=folder,
                           check=True)
            if subprocess.run(["diff", "-rq", "out", "fresh"], cwd=folder).returncode != 0:
                sys.exit(f"measure_watch.py: the package of {program[0]} is not that of a fresh run")


if __name__ == "__main__":
    main()
