#!/usr/bin/env python3
"""Puts benches of one scene on several machines side by side, as a Markdown table of single settings.

    benchmarks/accuracy_table.py BENCH.json...     BENCH.json: what `glint bench` wrote

Time and error are ratios of medians to the default of the same bench; "tie": the interval holds 1.
"""
import json
import pathlib
import sys


def cells(point, base, metric):
    if point is None:
        return ["", ""]
    time = "tie" if point["timeTie"] else f"{point['ratio']['median']:.2f}"
    if point["sameImage"]:
        return [time, "same picture"]
    error = point["error"][metric]["median"] / base["error"][metric]["median"]
    return [time, "tie" if point["errorTie"] else f"{error:.3g}"]


def main():
    reports = [json.loads(pathlib.Path(file).read_text(encoding="utf-8")) for file in sys.argv[1:]]
    if not reports:
        sys.exit("usage: benchmarks/accuracy_table.py BENCH.json...")
    names = []
    for report in reports:
        names += [p["name"] for p in report["points"] if p["kind"] == "single" and p["name"] not in names]
    devices = [report["machine"]["device"].split(" (")[0] for report in reports]
    print("| setting | " + " | ".join(f"time, {device} | error, {device}" for device in devices) + " |")
    print("|---|" + "---|---|" * len(reports))
    first = ["default"]
    for report in reports:
        base, metric = report["points"][0], report["method"]["metric"]
        first += [f"{base['time']['median']:.3g} ms", f"{base['error'][metric]['median']:.3g}"]
    print("| " + " | ".join(first) + " |")
    for name in sorted(names, key=lambda n: [s["name"] for s in reports[0]["settings"]].index(n.split(" ")[0])):
        row = [name]
        for report in reports:
            point = next((p for p in report["points"] if p["kind"] == "single" and p["name"] == name), None)
            row += cells(point, report["points"][0], report["method"]["metric"])
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
