#!/usr/bin/env python3
"""Draws time and error of `--lights auto` by the number of lights, before and after. Needs python3-matplotlib.

    benchmarks/charts/lights_chart.py CHART.png MOST TIMES.json ERRORS.json

MOST is the largest number of lights of which `auto` takes all. The measurements are what `benchmarks/measure_lights.py
--samples 16 auto --before PROGRAM --reference-spp N --json` wrote: the times are of the first, and the errors of a
sample of a pixel, edges and textures included, of the second.
"""
import json
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

def after(rows, most):
    """The rows of what `auto` takes."""
    return [row for row in rows if row["choice"] == ("all" if row["lights"] <= most else "16")]


def draw(axes, report, most, value):
    rows = report["results"]
    for chosen, label, style in (([row for row in rows if row["choice"] == "auto before"], "before", "rs-"),
                                 (after(rows, most), "after", "bo-")):
        axes.plot([row["lights"] for row in chosen], [value(row) for row in chosen], style, markersize=4, label=label)
    axes.set_title(f"{report['scene']}, {report['device']}, {report['size']}", fontsize=9)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.grid(True, which="both", alpha=0.3)


def main():
    if len(sys.argv) != 5:
        sys.exit("usage: benchmarks/charts/lights_chart.py CHART.png MOST TIMES.json ERRORS.json")
    times, errors = (json.loads(pathlib.Path(path).read_text(encoding="utf-8")) for path in sys.argv[3:])
    _, (above, below) = plt.subplots(2, 1, figsize=(7, 7), sharex=True)
    draw(above, times, int(sys.argv[2]), lambda row: statistics.median(row["frameMilliseconds"]))
    draw(below, errors, int(sys.argv[2]), lambda row: row["errorOfSample"])
    whole = [row for row in errors["results"] if row["choice"] == "all"]
    below.plot([row["lights"] for row in whole], [row["errorOfSample"] for row in whole], "k--", linewidth=1,
               label="--lights all")
    above.set_ylabel("ms of a frame")
    below.set_ylabel("relMse of a frame")
    below.set_xlabel("point lights")
    above.legend(fontsize=8)
    below.legend(fontsize=8)
    below.set_xticks([1, 4, 16, 64, 256, 1024, 4096], ["1", "4", "16", "64", "256", "1,024", "4,096"])
    plt.tight_layout()
    plt.savefig(sys.argv[1], dpi=110)


if __name__ == "__main__":
    main()
