#!/usr/bin/env python3
"""Reduces measurements to what the charts and tables of the documents need, for benchmarks/data.

    benchmarks/reduce.py IN.json OUT.json     IN.json: what `glint bench`, `glint bench --calibrate`, bench_ordering or
                                              bench_traversal wrote

Medians, intervals, quartiles, commands, device, driver and commit stay. What goes: the values of single rounds, pictures,
the times of passes, error metrics other than the one by which the bench ordered its points, and what follows from the
rest. Numbers keep all their digits. The elements of the longest list stand one a line, so that a change is seen.
"""
import json
import pathlib
import sys

POINT = ("id", "name", "kind", "settings", "time", "ratio", "timeTie", "error", "errorTie", "sameImage", "rays", "cases")
SCENE = ("name", "triangles", "materials", "instances", "lights", "camera", "width", "height")
REFERENCE = ("transport", "what", "samples", "relativeError", "target", "reached", "noise", "settings")
MACHINE = ("device", "driver", "deviceType", "tracers", "cpu", "cores", "os")
ENTRY = ("cases", "cost", "coherence", "shares", "lights", "shadows", "width", "height", "rays", "hits", "hitShare",
         "coherentShare", "filledCases", "instructions", "work", "samples", "strategies", "fastest")
STRATEGY = ("strategy", "skipped", "tracer", "ordering", "time", "ratio", "split", "difference")


def only(object_, names):
    return {name: object_[name] for name in names if name in object_}


def without_values(interval):
    return {name: value for name, value in interval.items() if name != "values"}


def reduced_bench(report):
    metric = report["method"]["metric"]
    points = []
    for point in report["points"]:
        kept = only(point, POINT)
        kept["time"] = without_values(point["time"])
        kept["error"] = {metric: point["error"][metric]}
        points.append(kept)
    return {**only(report, ("format", "version", "tool", "commit", "date", "command")), "scene": only(report["scene"], SCENE),
            "machine": only(report["machine"], MACHINE), "method": report["method"],
            "reference": only(report["reference"], REFERENCE),
            "settings": [only(setting, ("name", "default", "values")) for setting in report["settings"]],
            "points": points, "front": report["front"], **only(report, ("errorParts",))}


def reduced_calibration(report):
    entries = []
    for entry in report["points"]:
        kept = only(entry, ENTRY)
        kept["strategies"] = [only(measure, STRATEGY) for measure in entry["strategies"]]
        for measure in kept["strategies"]:
            if "time" in measure:
                measure["time"] = without_values(measure["time"])
        entries.append(kept)
    return {**only(report, ("format", "version", "tool", "commit", "date", "command")), "machine": only(report["machine"], MACHINE),
            "method": report["method"], "complete": report["complete"], "points": entries}


def reduced(report):
    kinds = {"glint-bench": reduced_bench, "glint-calibration": reduced_calibration}
    # Reports of bench_ordering and bench_traversal have medians and intervals only.
    return kinds.get(report.get("format"), lambda same: same)(report)


def text(report):
    """JSON whose longest list has an element a line."""
    longest = max((name for name, value in report.items() if isinstance(value, list)), key=lambda name: len(report[name]))
    lines = []
    for name, value in report.items():
        if name == longest:
            elements = ",\n".join("  " + json.dumps(element, ensure_ascii=False, separators=(",", ":")) for element in value)
            lines.append(f'"{name}":[\n{elements}\n]')
        else:
            lines.append(f'"{name}":' + json.dumps(value, ensure_ascii=False, separators=(",", ":")))
    return "{" + ",\n".join(lines) + "}\n"


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: benchmarks/reduce.py IN.json OUT.json")
    report = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    pathlib.Path(sys.argv[2]).write_text(text(reduced(report)), encoding="utf-8")


if __name__ == "__main__":
    main()
