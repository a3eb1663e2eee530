#!/usr/bin/env python3
"""Measures how long `glint compile` takes and what it repeats, for the figures and charts of docs/compile_times.md.

    benchmarks/measure_compile.py [--part edits|materials|keys|glslc] [--rounds N] [--charts FOLDER]

Scenes are those of benchmarks/make_synthetic_scene.py. With strategy visibility and --merge none, each key has a shader.
Prints Markdown.
Wall is what a clock shows, CPU the time on all cores, which other programs disturb less. Needs glslc for that part and
matplotlib for charts.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from make_synthetic_scene import MAX_KEYS, write_scene

ROOT = pathlib.Path(__file__).resolve().parent.parent
GLINT = ROOT / "build/release/bin/glint"
MATERIALS = [100, 1000, 10000, 100000]
KEYS = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512]


def timed(command):
    """Runs a command; its output, wall and CPU seconds."""
    start = time.monotonic()
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE) as process:
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"measure_compile.py: failed: {' '.join(map(str, command))}")
    return output, time.monotonic() - start, usage.ru_utime + usage.ru_stime


def compile_scene(scene, package, cache, *options):
    """One run: wall and CPU seconds, the number of modules compiled, and the whole report."""
    command = [GLINT, "compile", scene, "-o", package, "--strategy", "visibility", "--merge", "none", "--json"]
    output, wall, cpu = timed([*command, "--cache", cache, *options])
    report = json.loads(output)
    return wall, cpu, report["modules"]["compiled"], report


def spread(values, unit=""):
    """Median, and the range."""
    if len(values) == 1:
        return f"{values[0]:.2f}{unit}"
    return f"{statistics.median(values):.2f}{unit} ({min(values):.2f} to {max(values):.2f})"


def measure_edits(work, rounds):
    """10,000 materials over 64 keys, and one edit each."""
    scene = write_scene(work / "edits", 10000, 64)
    text = scene.read_text()
    cache, package = work / "cache", work / "edits.glint"

    def edit(change):
        document = json.loads(text)
        change(document)
        scene.write_text(json.dumps(document))

    def other_texture(document):
        material = next(m for m in document["materials"] if "baseColorTexture" in m["pbrMetallicRoughness"])
        material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0

    def other_value(document):
        document["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.123

    def other_key(document):
        document["extensionsUsed"].append("KHR_materials_anisotropy")
        document["materials"][0].setdefault("extensions", {})["KHR_materials_anisotropy"] = {"anisotropyStrength": 0.7}

    steps = {
        "cold": None,
        "nothing changed": lambda: None,
        "other pixels in an image": lambda: (scene.parent / "other.png").write_bytes(
            (scene.parent / "normal.png").read_bytes()
        ),
        "another texture in a material": lambda: edit(other_texture),
        "another value in a material": lambda: edit(other_value),
        "a new feature in a material": lambda: edit(other_key),
    }
    results = {}
    for _ in range(rounds):
        shutil.rmtree(cache, ignore_errors=True)
        shutil.rmtree(package, ignore_errors=True)
        scene = write_scene(work / "edits", 10000, 64)
        for name, change in steps.items():
            if change is not None:
                change()
            wall, cpu, compiled, report = compile_scene(scene, package, cache)
            results.setdefault(name, []).append((wall, cpu, compiled, report["upToDate"]))
            if name.startswith("an"):
                scene.write_text(text)
                compile_scene(scene, package, cache)
    print("\n| 10,000 materials, 64 keys | modules compiled | wall, s | CPU, s |\n|---|---:|---:|---:|")
    for name, runs in results.items():
        count = "0, up to date" if runs[0][3] else str(runs[0][2])
        print(f"| {name} | {count} | {spread([r[0] for r in runs])} | {spread([r[1] for r in runs])} |")


def measure_growth(work, rounds, axis, limit):
    """Cold runs and runs that have nothing to do, by the number of materials or of keys."""
    points = [n for n in (MATERIALS if axis == "materials" else KEYS) if n <= limit]
    rows = []
    for number in points:
        materials, keys = (number, 64) if axis == "materials" else (MAX_KEYS, number)
        scene = write_scene(work / "growth", materials, keys)
        cold, warm, compiled = [], [], 0
        for _ in range(rounds):
            shutil.rmtree(work / "cache", ignore_errors=True)
            shutil.rmtree(work / "growth.glint", ignore_errors=True)
            wall, cpu, compiled, _ = compile_scene(scene, work / "growth.glint", work / "cache")
            cold.append((wall, cpu))
            wall, cpu, _, report = compile_scene(scene, work / "growth.glint", work / "cache")
            if not report["upToDate"]:
                sys.exit("measure_compile.py: the second run was not up to date")
            warm.append((wall, cpu))
        rows.append((number, compiled, cold, warm))
    other = "64 keys" if axis == "materials" else f"{MAX_KEYS} materials"
    print(f"\n| {axis}, at {other} | modules | cold: CPU, s | nothing changed: wall, s | CPU, s |")
    print("|---:|---:|---:|---:|---:|")
    for number, compiled, cold, warm in rows:
        cells = [spread([c for _, c in cold]), spread([w for w, _ in warm]), spread([c for _, c in warm])]
        print(f"| {number:,} | {compiled} | " + " | ".join(cells) + " |")
    return rows


def draw(axis, rows, folder):
    """A chart of CPU time, both axes logarithmic."""
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 3.6))
    numbers = [row[0] for row in rows]
    median = lambda runs: statistics.median(cpu for _, cpu in runs)
    axes.plot(numbers, [median(row[2]) for row in rows], "o-", color="#0072b2", label="cold")
    axes.plot(numbers, [median(row[3]) for row in rows], "s--", color="#d55e00", label="nothing changed")
    axes.set(xscale="log", yscale="log", xlabel=axis, ylabel="CPU time, s")
    axes.grid(True, which="major", color="#dddddd")
    axes.legend()
    figure.tight_layout()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"compile_{axis}.png", dpi=120, metadata={"Software": None})


def measure_glslc(work, rounds, keys):
    """The same permutations by one glslc process each, and by glint with 1 and 2 jobs; interleaved."""
    scene = write_scene(work / "glslc", keys, keys)
    package = work / "glslc.glint"
    compile_scene(scene, package, work / "cache", "--emit", "glsl")
    sources = sorted((package / "glsl").iterdir())
    runs = {"glslc -O": [], "glint, 1 job": [], "glint, 2 jobs": []}
    sizes = {}
    for _ in range(rounds):
        wall, cpu, total = 0.0, 0.0, 0
        for source in sources:
            _, w, c = timed(["glslc", "-O", "--target-env=vulkan1.2", source, "-o", work / "out.spv"])
            wall, cpu, total = wall + w, cpu + c, total + (work / "out.spv").stat().st_size
        runs["glslc -O"].append((wall, cpu))
        sizes["glslc -O"] = total
        for jobs in (1, 2):
            name = f"glint, {jobs} job" + ("s" if jobs > 1 else "")
            out = work / "jobs.glint"
            shutil.rmtree(out, ignore_errors=True)
            wall, cpu, compiled, report = compile_scene(scene, out, "none", "--jobs", jobs)
            runs[name].append((wall, cpu))
            sizes[name] = sum((out / f).stat().st_size for f in os.listdir(out) if f.endswith(".spv"))
    print(f"\n{keys} keys: {len(sources)} modules, {rounds} rounds")
    print("\n| | wall, s | CPU, s | glslc's wall over it | glslc's CPU over it | SPIR-V bytes |")
    print("|---|---:|---:|---:|---:|---:|")
    for name, values in runs.items():
        over = [
            [base[i] / value[i] for base, value in zip(runs["glslc -O"], values)] for i in range(2)
        ]
        cells = [spread([v[0] for v in values]), spread([v[1] for v in values]), spread(over[0]), spread(over[1])]
        print(f"| {name} | " + " | ".join(cells) + f" | {sizes[name]:,} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parts = ["edits", "materials", "keys", "glslc"]
    parser.add_argument("--part", action="append", choices=parts, help="may be repeated; default all")
    parser.add_argument("--rounds", type=int, default=3, help="of every measurement; default 3")
    parser.add_argument("--keys", type=int, default=64, help="of part glslc; default 64")
    parser.add_argument("--limit", type=int, default=MATERIALS[-1], help="the most materials or keys")
    parser.add_argument("--charts", type=pathlib.Path, help="folder for compile_materials.png and compile_keys.png")
    arguments = parser.parse_args()
    if not GLINT.exists():
        sys.exit("measure_compile.py: build first: cmake --preset release && cmake --build --preset release")
    for part in arguments.part or parts:
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder)
            if part == "edits":
                measure_edits(work, arguments.rounds)
            elif part == "glslc":
                measure_glslc(work, arguments.rounds, arguments.keys)
            else:
                rows = measure_growth(work, arguments.rounds, part, arguments.limit)
                if arguments.charts:
                    draw(part, rows, arguments.charts)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
