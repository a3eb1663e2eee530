#!/usr/bin/env python3
"""Draws the host's time of an edit by the number of instances. Needs python3-matplotlib.

    benchmarks/charts/edit_times_chart.py CHART.png TIMES.json [PROGRAM]

With PROGRAM, which is glint_edit_times, it measures first, with 1,000 to 1,000,000 instances of one mesh, and writes
TIMES.json. The points are medians, the bars go from the least to the most.
"""
import json
import pathlib
import re
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COUNTS = (1_000, 10_000, 100_000, 1_000_000)
ROW = re.compile(r"\| (?P<edit>[^|]+) \| (?P<median>[\d.]+) \| (?P<least>[\d.]+) to (?P<most>[\d.]+) \| (?P<bytes>[\d,]+) \|")


def measure(program):
    results = []
    for count in COUNTS:
        command = [program, "--lamps", "0", "--objects", str(count), "--rounds", "41", "--triangles", "2"]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        for row in ROW.finditer(text):
            times = {name: float(row[name]) for name in ("median", "least", "most")}
            results.append({"edit": row["edit"], "instances": count, "bytes": int(row["bytes"].replace(",", "")), **times})
    return {"device": text.split(":")[0], "milliseconds": results}


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit("usage: benchmarks/charts/edit_times_chart.py CHART.png TIMES.json [PROGRAM]")
    data = pathlib.Path(sys.argv[2])
    if len(sys.argv) == 4:
        data.write_text(json.dumps(measure(sys.argv[3]), indent=1) + "\n", encoding="utf-8")
    report = json.loads(data.read_text(encoding="utf-8"))
    _, axes = plt.subplots(figsize=(7, 4.5))
    for edit in dict.fromkeys(row["edit"] for row in report["milliseconds"] if row["edit"] != "none"):
        rows = [row for row in report["milliseconds"] if row["edit"] == edit]
        medians = [row["median"] for row in rows]
        axes.errorbar([row["instances"] for row in rows], medians, marker="o", markersize=4, capsize=2, label=edit,
                      yerr=[[row["median"] - row["least"] for row in rows], [row["most"] - row["median"] for row in rows]])
    axes.set_title(report["device"], fontsize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("instances")
    axes.set_ylabel("ms of the host for an edit and its record()")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8, ncol=2, loc="upper center", bbox_to_anchor=(0.5, -0.16))
    plt.tight_layout()
    plt.savefig(sys.argv[1], dpi=110)


if __name__ == "__main__":
    main()
