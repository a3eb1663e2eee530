#!/usr/bin/env python3
"""Compares the pictures' cost of two builds of glint, interleaved.

    benchmarks/compare_builds.py BEFORE NOW SCENE... [--ways STRATEGY:TRACER,...] [--size WxH] [--spp N] [--rounds N]
                                 [--compile OPTIONS] [--sky S] [--processor] [--passes]

BEFORE and NOW are two programs `glint`. Each compiles a package of every scene for every way. In a round both render
it, first the one and in the next round the other. Prints Markdown, a row as soon as it is measured: the bytes of the
package's SPIR-V, and the median of ratios of the same round, NOW over BEFORE, with its 95 % interval (order
statistics), of the device time of a sample's passes. --processor adds the processor time of all threads for a sample,
which other programs on a CPU driver's machine disturb less: that of N samples less that of one. --passes adds the
device time of each pass.
"""
import argparse
import json
import math
import os
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(*words):
    """Runs a command; returns the seconds of processor time that it took, and what it printed."""
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        process = subprocess.Popen([str(word) for word in words], stdout=output, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        if process.returncode != 0:
            sys.exit(f"{' '.join(map(str, words))}: exit {process.returncode}\n{errors.read().decode()}")
        return usage.ru_utime + usage.ru_stime, output.read().decode()


def interval(values):
    """The median, and the order statistics that hold it with at least 95 % confidence if there are six values."""
    ordered = sorted(values)
    count = len(ordered)
    low, outside = 0, 2 * 0.5**count
    while low + 1 < count // 2 and outside + 2 * math.comb(count, low + 1) * 0.5**count <= 0.05:
        low += 1
        outside += 2 * math.comb(count, low) * 0.5**count
    return statistics.median(ordered), ordered[low], ordered[count - 1 - low]


def ratio(now, before):
    return "{:.3f} ({:.3f} to {:.3f})".format(*interval([b / a for a, b in zip(before, now)]))


class Case:
    """A scene that one build renders in one way."""

    def __init__(self, arguments, glint, scene, way, folder):
        self.arguments, self.glint, self.scene, self.folder = arguments, glint, scene, folder
        self.strategy, self.tracer = way
        self.package = folder / "package"
        folder.mkdir(parents=True)
        self.device, self.processor, self.passes = [], [], []
        run(glint, "compile", scene, "-o", self.package, "--strategy", self.strategy, "--tracer", self.tracer,
            *shlex.split(arguments.compile))
        self.bytes = sum(path.stat().st_size for path in self.package.rglob("*.spv"))

    def render(self, spp):
        sky = ["--sky", self.arguments.sky] if self.arguments.sky else []
        seconds, report = run(self.glint, "render", self.scene, "-o", self.folder / "picture.exr", "--package",
                              self.package, "--strategy", self.strategy, "--tracer", self.tracer, "--size",
                              self.arguments.size, "--spp", spp, "--json", *sky)
        return seconds, json.loads(report)["passes"]

    def measure(self):
        spp = self.arguments.spp
        once = self.render(1)[0] if self.arguments.processor else 0.0
        seconds, passes = self.render(spp)
        self.processor.append((seconds - once) / (spp - 1))
        self.device.append(sum(entry["milliseconds"] for entry in passes))
        times = {}
        for entry in passes:
            times[entry["name"]] = times.get(entry["name"], 0.0) + entry["milliseconds"]
        self.passes.append(times)


def print_passes(before, now):
    for name in now.passes[0]:
        if all(name in times for times in before.passes + now.passes):
            old, new = ([times[name] for times in case.passes] for case in (before, now))
            print(f"|  | {name} |  | {statistics.median(old):.3g} ms | {ratio(new, old)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("before", type=pathlib.Path, help="a program glint")
    parser.add_argument("now", type=pathlib.Path, help="another one")
    parser.add_argument("scenes", nargs="+", help="glTF files")
    parser.add_argument("--ways", default="uber:ray-query,visibility:ray-query,visibility:ray-pipeline,"
                        "hit-shaders:ray-pipeline", help="default uber and visibility with ray queries, visibility and "
                        "hit-shaders with ray tracing pipelines")
    parser.add_argument("--size", default="96x54", help="default 96x54")
    parser.add_argument("--spp", type=int, default=17, help="samples, at least 2; default 17")
    parser.add_argument("--rounds", type=int, default=9, help="default 9")
    parser.add_argument("--compile", default="", help="more options of glint compile, for both")
    parser.add_argument("--sky", help="as of glint render")
    parser.add_argument("--processor", action="store_true", help="measure processor time, too")
    parser.add_argument("--passes", action="store_true", help="print each pass, too")
    arguments = parser.parse_args()
    ways = [way.split(":") for way in arguments.ways.split(",")]
    more = arguments.processor
    print(f"{arguments.size}, {arguments.spp} samples, {arguments.rounds} rounds\n\n"
          "| scene | strategy, tracer | SPIR-V, bytes | device time of a sample, before | now / before |" +
          (" processor time, now / before |" if more else "") + "\n|---|---|---|---|---|" + ("---|" if more else ""),
          flush=True)
    with tempfile.TemporaryDirectory(prefix="glint-builds-") as name:
        for scene in arguments.scenes:
            for number, way in enumerate(ways):
                folder = pathlib.Path(name) / pathlib.Path(scene).stem / str(number)
                before = Case(arguments, arguments.before, scene, way, folder / "before")
                now = Case(arguments, arguments.now, scene, way, folder / "now")
                for turn in range(arguments.rounds):
                    for case in (before, now) if turn % 2 == 0 else (now, before):
                        case.measure()
                print(f"| {pathlib.Path(scene).stem} | {now.strategy}, {now.tracer} | "
                      f"{now.bytes / before.bytes:.3f} of {before.bytes:,} | {statistics.median(before.device):.3g} ms | "
                      f"{ratio(now.device, before.device)} |" +
                      (f" {ratio(now.processor, before.processor)} |" if more else ""), flush=True)
                if arguments.passes:
                    print_passes(before, now)


if __name__ == "__main__":
    main()
