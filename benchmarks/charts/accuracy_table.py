#!/usr/bin/env python3
"""Puts benches side by side, as a Markdown table.

    benchmarks/charts/accuracy_table.py BENCH.json...            one scene on several machines: single settings
    benchmarks/charts/accuracy_table.py --parts BENCH.json...    several scenes: the parts of the default's error

BENCH.json: what `glint bench` wrote. Time and error are ratios of medians to the default of the same bench; "tie": the
interval holds 1. Parts are shares of the default's error that go with an exact value alone: bias, and in brackets noise.
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


def percent(share):
    text = f"{100 * share:.0f} %"
    return "0 %" if text == "-0 %" else text


def removed(report, part):
    """A cell of the table of parts."""
    if part is None:
        return "–"
    point = report["points"][part["point"]]
    time = "tie" if point["timeTie"] else f"× {point['ratio']['median']:.2f}"
    return f"{percent(part['bias'])} ({percent(part['noise'])}), {time}"


def print_parts(reports):
    metric = [report["method"]["metric"] for report in reports]
    rows = [["exact value alone"] + [report["scene"]["name"] for report in reports],
            ["error of the default"] + [f"{r['points'][0]['error'][m]['median']:.2g}" for r, m in zip(reports, metric)],
            ["its noise"] + [percent(report["errorParts"]["noise"]) for report in reports]]
    found = [{(part["setting"], part["to"]): part for part in report["errorParts"]["parts"]} for report in reports]
    for key in sorted({key for parts in found for key in parts},
                      key=lambda key: -max(parts[key]["bias"] for parts in found if key in parts)):
        rows.append([f"`--{key[0]} {key[1]}`"] +
                    [removed(report, parts.get(key)) for report, parts in zip(reports, found)])
    rows.append(["the rest"] + [percent(report["errorParts"]["rest"]) for report in reports])
    rows.append(["all these values together"] + [removed(report, report["errorParts"]["exact"]) for report in reports])
    rows.insert(1, ["---"] * len(rows[0]))
    for row in rows:
        print("| " + " | ".join(row) + " |" if row[0] != "---" else "|" + "---|" * len(row))


def main():
    arguments = [word for word in sys.argv[1:] if word != "--parts"]
    reports = [json.loads(pathlib.Path(file).read_text(encoding="utf-8")) for file in arguments]
    if not reports:
        sys.exit("usage: benchmarks/charts/accuracy_table.py [--parts] BENCH.json...")
    if "--parts" in sys.argv:
        print_parts(reports)
        return
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
