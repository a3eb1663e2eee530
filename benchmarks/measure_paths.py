#!/usr/bin/env python3
"""Measures the strategies by the number of bounces.

    benchmarks/measure_paths.py SCENE [--glint FILE] [--bounces 1,2,4,8] [--strategies LIST] [--size WxH] [--rounds N]
                                [--tracer NAME] [--merge POLICY] [--emissive-lights on|off|auto]

Renders everything once, all at the same time, to fill the driver's cache, and says on stderr how long each took. Then
all strategies and numbers of bounces are rendered in turn, in an order that changes from round to round, each with the
package that has those bounces. The sky is no light (--no-sky-light), and neither are emissive triangles without
--emissive-lights. Prints Markdown: the device time of all passes of a sample, as the median with its least and
greatest value, and the ratio of each strategy to uber in the same round. If it is stopped by SIGTERM, as timeout(1)
does, it prints what it has measured until then.

SCENE is a file, or box:K for a closed box that is made here: its walls are squares of materials over K keys, as in
benchmarks/make_synthetic_scene.py, so that no path leaves it.
"""
import argparse
import json
import pathlib
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time

from make_synthetic_scene import write_scene

ROOT = pathlib.Path(__file__).resolve().parent.parent


SIDE = 8  # squares along an edge of the box
# Quaternions that turn a square's front from +z to face the box's centre from each of its walls, with the wall's axis.
WALLS = [(2, -1, (0, 0, 0, 1)), (2, 1, (0, 1, 0, 0)), (0, -1, (0, 0.5 ** 0.5, 0, 0.5 ** 0.5)),
         (0, 1, (0, -(0.5 ** 0.5), 0, 0.5 ** 0.5)), (1, -1, (-(0.5 ** 0.5), 0, 0, 0.5 ** 0.5)),
         (1, 1, (0.5 ** 0.5, 0, 0, 0.5 ** 0.5))]


def write_box(folder, keys):
    """Writes a closed box with a camera and a lamp in it; returns the path of scene.gltf."""
    count = 6 * SIDE * SIDE
    path = write_scene(folder, count, keys)
    scene = json.loads(path.read_text())
    for number, node in enumerate(scene["nodes"]):
        axis, sign, rotation = WALLS[number // (SIDE * SIDE)]
        place = [(number // SIDE) % SIDE - (SIDE - 1) / 2, number % SIDE - (SIDE - 1) / 2]
        place.insert(axis, sign * SIDE / 2)
        # Slightly too large, so that neighbours overlap and no ray finds a gap.
        node.update(translation=place, rotation=rotation, scale=[1.001] * 3)
    scene["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.2, "aspectRatio": 16 / 9, "znear": 0.01}}]
    scene["nodes"] += [{"camera": 0, "translation": [0, 0, SIDE / 2 - 0.5]},
                       {"extensions": {"KHR_lights_punctual": {"light": 0}}}]
    scene["scenes"][0]["nodes"] += [count, count + 1]
    scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 20}]}}
    scene["extensionsUsed"] = sorted({*scene.get("extensionsUsed", []), "KHR_lights_punctual"})
    path.write_text(json.dumps(scene))
    return path


def compile_packages(arguments, folder):
    """Compiles the scene once for each number of bounces, for all strategies."""
    tracer = "all" if arguments.tracer == "auto" else arguments.tracer
    for bounces in arguments.bounces:
        subprocess.run([arguments.glint, "compile", arguments.scene, "-o", folder / str(bounces), "--bounces",
                        str(bounces), "--strategy", ",".join(arguments.strategies), "--tracer", tracer, "--effects",
                        "shadow,reflection", "--max-roughness", "1", "--no-sky-light",
                        f"--emissive-lights={arguments.emissive_lights}", "--merge", arguments.merge],
                       check=True, capture_output=True)


def stats_of(folder, strategy, bounces):
    return folder / f"stats-{strategy}-{bounces}.json"


def start_render(arguments, folder, strategy, bounces):
    """Starts the render and returns its process."""
    stats = stats_of(folder, strategy, bounces)
    return subprocess.Popen([arguments.glint, "render", arguments.scene, "-o", stats.with_suffix(".png"), "--package",
                             folder / str(bounces), "--bounces", str(bounces), "--strategy", strategy, "--tracer",
                             arguments.tracer, "--size", arguments.size, "--spp", str(arguments.spp),
                             "--max-roughness", "1", "--stats", stats], stdout=subprocess.DEVNULL)


def finish(process):
    if process.wait() != 0:
        sys.exit("measure_paths.py: a render failed")


def device_time(arguments, folder, strategy, bounces):
    """Returns the milliseconds of the last sample's passes."""
    stats = stats_of(folder, strategy, bounces)
    finish(start_render(arguments, folder, strategy, bounces))
    return sum(entry["milliseconds"] for entry in json.loads(stats.read_text())["passes"])


def fill_driver_cache(arguments, folder, cases):
    """Renders each case once, all at the same time: a driver may take minutes for one uber shader, on one thread."""
    start = time.monotonic()
    running = {case: start_render(arguments, folder, *case) for case in cases}
    try:
        while running:
            time.sleep(0.1)
            for case in [case for case, process in running.items() if process.poll() is not None]:
                finish(running.pop(case))
                print(f"{case[0]}, {case[1]} bounces: first render after {time.monotonic() - start:.0f} s",
                      file=sys.stderr, flush=True)
    finally:
        for process in running.values():
            process.kill()


def spread(values):
    return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def print_table(title, arguments, times):
    """Prints a row for each number of bounces that every strategy has rendered at least once."""
    print(f"{title}, {arguments.size}, at most {arguments.rounds} rounds, ms of a sample\n")
    print("| bounces | rounds | uber, ms | " +
          " | ".join(f"{strategy} / uber" for strategy in arguments.strategies[1:]) + " |")
    print("|---|---|---|" + "---|" * (len(arguments.strategies) - 1))
    for count in arguments.bounces:
        rounds = min(len(times[(strategy, count)]) for strategy in arguments.strategies)
        if rounds == 0:
            continue
        uber = times[("uber", count)][:rounds]
        ratios = [[now / then for now, then in zip(times[(strategy, count)], uber)]
                  for strategy in arguments.strategies[1:]]
        print(f"| {count} | {rounds} | {spread(uber)} | " + " | ".join(spread(ratio) for ratio in ratios) + " |")


def stop(*_):
    sys.exit("measure_paths.py: stopped before the last round")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scene", help="a glTF file, or box:K")
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="default build/release/bin/glint")
    parser.add_argument("--bounces", default="1,2,4,8", help="default 1,2,4,8")
    parser.add_argument("--strategies", default="uber,visibility,sorted-uber,hit-shaders",
                        help="default uber,visibility,sorted-uber,hit-shaders; the first must be uber")
    parser.add_argument("--size", default="640x360", help="default 640x360")
    parser.add_argument("--spp", type=int, default=4, help="samples; the last one is timed; default 4")
    parser.add_argument("--rounds", type=int, default=5, help="default 5")
    parser.add_argument("--tracer", default="auto", help="auto, ray-query or ray-pipeline; default auto")
    parser.add_argument("--merge", default="none", help="merge policy; default none")
    parser.add_argument("--emissive-lights", default="off", help="on, off or auto; default off")
    arguments = parser.parse_args()
    arguments.bounces = [int(count) for count in arguments.bounces.split(",")]
    arguments.strategies = arguments.strategies.split(",")
    if arguments.strategies[0] != "uber":
        parser.error("--strategies must begin with uber, which is what the others are measured against")
    chance = random.Random(1)
    with tempfile.TemporaryDirectory(prefix="glint-paths-") as name:
        folder = pathlib.Path(name)
        title = arguments.scene
        if title.startswith("box:"):
            arguments.scene = write_box(folder / "box", int(title[len("box:"):]))
        compile_packages(arguments, folder)
        cases = [(strategy, count) for strategy in arguments.strategies for count in arguments.bounces]
        times = {case: [] for case in cases}
        signal.signal(signal.SIGTERM, stop)
        try:
            fill_driver_cache(arguments, folder, cases)
            for _ in range(arguments.rounds):
                for case in chance.sample(cases, len(cases)):
                    times[case].append(device_time(arguments, folder, *case))
        finally:
            print_table(title, arguments, times)


if __name__ == "__main__":
    main()
