#!/usr/bin/env python3
"""Times frames of scenes, and of copies with shuffled triangles and nodes, by --traversal-order, on any device.

    benchmarks/measure_order.py [--glint PROGRAM] [--tracer auto|ray-query|ray-pipeline] [--rounds N] [--size WxH] SCENE...

Each round renders everything once, so that what else the machine does slows all alike. Prints Markdown: device
milliseconds of a frame's passes and of building acceleration structures, medians and quartiles of the rounds.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ORDERS = ("input", "halving")


def quartiles(values):
    low, median, high = statistics.quantiles(values, n=4) if len(values) > 1 else [values[0]] * 3
    return f"{median:.3f} ({low:.3f} to {high:.3f})"


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stderr}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default="build/release/bin/glint")
    parser.add_argument("--tracer", default="auto")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    options = parser.parse_args()
    shuffle = pathlib.Path(__file__).with_name("shuffle_scene.py")
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        copies, rows = [], {}
        for number, name in enumerate(options.scenes):
            scene = pathlib.Path(name)
            run(sys.executable, shuffle, scene, folder / f"shuffled{number}")
            for kind, path in (("as it is", scene), ("shuffled", folder / f"shuffled{number}" / scene.name)):
                package = folder / f"package{number}{kind[0]}"
                tracer = "all" if options.tracer == "auto" else options.tracer
                run(options.glint, "compile", path, "-o", package, "--strategy", "uber", "--effects",
                    "all", "--tracer", tracer)
                copies.append((scene.stem, kind, path, package))
        for _ in range(options.rounds):
            for scene, kind, path, package in copies:
                for order in ORDERS:
                    stats = folder / "stats.json"
                    run(options.glint, "render", path, "-o", folder / "image.exr", "--package", package, "--strategy",
                        "uber", "--tracer", options.tracer, "--size", options.size, "--spp", 1, "--traversal-order",
                        order, "--stats", stats)
                    report = json.loads(stats.read_text())
                    row = rows.setdefault((scene, kind, order), {"frame": [], "build": [], "order": []})
                    row["frame"].append(sum(entry["milliseconds"] for entry in report["passes"]))
                    scene_statistics = report["sceneStatistics"]
                    row["build"].append(scene_statistics["blasBuildMs"] + scene_statistics["tlasBuildMs"])
                    row["order"].append(scene_statistics["orderMs"])
        print(f"{report['device']}, {report['driver']}, {report['tracer']}; {options.size}; {options.rounds} rounds\n")
        print("| scene | triangles come | order | frame, ms | of input | build, ms | ordering, ms |")
        print("|---|---|---|---|---|---|---|")
        for (scene, kind, order), row in rows.items():
            base = rows[scene, kind, "input"]["frame"]
            ratio = [frame / other for frame, other in zip(row["frame"], base)]
            print(f"| {scene} | {kind} | {order} | {quartiles(row['frame'])} | {quartiles(ratio)} | "
                  f"{quartiles(row['build'])} | {quartiles(row['order'])} |")


if __name__ == "__main__":
    main()
