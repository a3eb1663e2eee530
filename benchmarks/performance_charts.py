#!/usr/bin/env python3
"""Makes charts and tables of the measurements of `glint bench --calibrate`. Needs python3-matplotlib.

    benchmarks/performance_charts.py CALIBRATION.json... CHARTS.png      the tables go to standard output, in Markdown

A chart for each cost, kind of hits and number of rays: time as a ratio to uber's against the number of cases, medians
with their quartiles. The first table says from how many cases on a strategy is faster than uber: where the line through
the medians, over the logarithm of cases, crosses 1 for the last time, and what it gains at the most cases. The second
says where the time goes, of every point: tracing and ordering measured alone, as visibility does them, and shading as
what is left of a strategy's time, as passes that shade overlap where nothing is measured between them.
"""
import argparse
import collections
import math
import pathlib

import calibrations
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# The colours are those of Okabe and Ito.
COLORS = {"uber": "black", "visibility": "#0072B2", "sorted-uber": "#D55E00", "hit-shaders": "#009E73"}
MEGA = 1e6


def name_of_rays(rays):
    return f"{rays / MEGA:.0f} M" if rays >= MEGA / 2 else f"{rays / 1e3:.0f} k"


def lines_of(report):
    """{(cost, coherence): {pixels: {strategy: [(cases, ratio)]}}}: pixels are one a ray, whatever is left out."""
    lines = collections.defaultdict(lambda: collections.defaultdict(lambda: collections.defaultdict(list)))
    for point in report["points"]:
        size = point["width"] * point["height"]
        for measure in point["strategies"]:
            if "skipped" not in measure and not measure["difference"]["wrong"]:
                place = lines[point["cost"], point["coherence"]][size]
                place[measure["strategy"]].append((point["cases"], measure["ratio"]))
    return lines


def instructions_of(report, cost):
    values = [point["instructions"] for point in report["points"] if point["cost"] == cost]
    return sum(values) / len(values)


def crossing(line):
    """Cases from which on the medians are below 1: None where the last one is not, 0 where all are."""
    line = [(cases, ratio["median"]) for cases, ratio in sorted(line, key=lambda entry: entry[0])]
    if line[-1][1] >= 1:
        return None
    for (below, above_one), (above, below_one) in reversed(list(zip(line, line[1:]))):
        if above_one >= 1:
            way = (above_one - 1) / (above_one - below_one)
            return math.exp(math.log(below) + way * (math.log(above) - math.log(below)))
    return 0


def draw(axes, strategies, title):
    axes.axhline(1, color=COLORS["uber"], linewidth=1, label="uber")
    for strategy, line in strategies.items():
        if strategy == "uber":
            continue
        line = sorted(line, key=lambda entry: entry[0])
        median = [ratio["median"] for _, ratio in line]
        spread = [[m - r["q1"] for m, (_, r) in zip(median, line)], [r["q3"] - m for m, (_, r) in zip(median, line)]]
        axes.errorbar([cases for cases, _ in line], median, yerr=spread, color=COLORS[strategy], marker="o",
                      markersize=4, linewidth=1.2, capsize=2, label=strategy)
    axes.set_title(title, fontsize=9)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log", base=2)
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.grid(True, which="major", linewidth=0.3)


def charts(report, file):
    lines = lines_of(report)
    sizes = sorted({size for by_size in lines.values() for size in by_size})
    figure, axes = plt.subplots(len(sizes), len(lines), figsize=(3.2 * len(lines), 2.7 * len(sizes) + 0.4), squeeze=False,
                                sharex=True, sharey=True)
    for column, ((cost, coherence), by_size) in enumerate(lines.items()):
        for row, size in enumerate(sizes):
            draw(axes[row][column], by_size[size],
                 f"{cost}, {coherence}, {name_of_rays(size)} rays")
        axes[-1][column].set_xlabel("cases")
    for row in axes:
        row[0].set_ylabel("time / uber's")
    axes[0][0].legend(fontsize=7)
    costs = ", ".join(f"{cost}: {instructions_of(report, cost):.0f} instructions a case"
                      for cost in dict.fromkeys(cost for cost, _ in lines))
    figure.suptitle(f"{report['machine']['device'].split(' (')[0]}; {costs}", fontsize=9)
    # A few outliers in the quartiles must not flatten the medians.
    medians = [ratio["median"] for by_size in lines.values() for by_name in by_size.values() for line in by_name.values()
               for _, ratio in line]
    axes[0][0].set_ylim(min(medians) / 1.3, max(medians) * 1.3)
    figure.tight_layout()
    figure.savefig(file, dpi=100, metadata={"Software": None})


def table(report):
    names = [name for name in COLORS if name != "uber"]
    rows = [["cost", "hits", "rays", *(f"{name}: from cases, gain" for name in names)]]
    rows.append(["---"] * len(rows[0]))
    for (cost, coherence), by_size in lines_of(report).items():
        for size, strategies in sorted(by_size.items()):
            row = [cost, coherence, name_of_rays(size)]
            for name in names:
                line = strategies.get(name)
                if not line:
                    row.append("-")
                    continue
                at = crossing(line)
                most, ratio = max(line, key=lambda entry: entry[0])
                start = "never" if at is None else "always" if at == 0 else f"{at:.0f}"
                row.append(f"{start}; {1 / ratio['median']:.2f} × at {most}")
            rows.append(row)
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def split_table(report):
    """Milliseconds: the time of uber, and of the others that times their ratio to it in the same round."""
    rows = [["cases", "cost", "hits", "rays", "trace", "order", "shade, visibility", "shade, sorted-uber", "uber, trace and shade"]]
    rows.append(["---"] * len(rows[0]))
    kinds = list(lines_of(report))
    for point in sorted(report["points"], key=lambda p: (kinds.index((p["cost"], p["coherence"])), p["rays"], p["cases"])):
        measures = {measure["strategy"]: measure for measure in point["strategies"] if "skipped" not in measure}
        if not {"uber", "visibility", "sorted-uber"} <= set(measures):
            continue
        whole = measures["uber"]["time"]["median"]
        traced = measures["visibility"]["split"]
        row = [str(point["cases"]), point["cost"], point["coherence"], name_of_rays(point["rays"]),
               f"{traced['trace']:.2f}", f"{traced['order']:.3f}"]
        for name in ("visibility", "sorted-uber"):
            split = measures[name]["split"]
            rest = whole * measures[name]["ratio"]["median"] - split["dispatch"] - split["trace"] - split["order"]
            row.append(f"{rest:.2f}")
        rows.append(row + [f"{whole:.2f}"])
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("calibrations", type=pathlib.Path, nargs="+")
    parser.add_argument("charts", type=pathlib.Path)
    arguments = parser.parse_args()
    report = calibrations.merged(arguments.calibrations)
    charts(report, arguments.charts)
    print(table(report))
    print()
    print(split_table(report))


if __name__ == "__main__":
    main()
