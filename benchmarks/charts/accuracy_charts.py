#!/usr/bin/env python3
"""Draws error against time of benches side by side, with their Pareto fronts. Needs python3-matplotlib.

    benchmarks/charts/accuracy_charts.py OUT.png BENCH.json...     BENCH.json: what `glint bench` wrote

Points are medians. Points that are not on a front are small. The table that `glint bench` prints names the points of a front.
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# The colours are those of Okabe and Ito.
COLORS = {"single": "#0072B2", "pair": "#56B4E9", "search": "#009E73"}


def label(point):
    words = point["name"].split(", ")
    return point["name"] if len(words) <= 2 else ", ".join(words[:1]) + f" and {len(words) - 1} more"


def draw(axes, report):
    metric = report["method"]["metric"]
    points = report["points"]
    value = lambda point: (point["time"]["median"], point["error"][metric]["median"])  # noqa: E731
    for kind, color in COLORS.items():
        chosen = [value(point) for point in points if point["kind"] == kind]
        if chosen:
            axes.scatter(*zip(*chosen), s=14, color=color, label=kind, zorder=2)
    front = [points[i] for i in report["front"]]
    axes.plot(*zip(*[value(point) for point in front]), color="#D55E00", marker="o", markersize=5, zorder=3, label="Pareto front",
              drawstyle="steps-post")
    axes.scatter(*value(points[0]), color="black", marker="D", s=36, zorder=4, label="default")
    for i, point in enumerate(front):
        axes.annotate(label(point), value(point), textcoords="offset points", xytext=(6, 6 if i % 2 else -11), fontsize=7)
    noise = report["reference"]["noise"].get(metric)
    if noise:
        axes.axhline(noise, color="grey", linestyle=":", linewidth=1, label="noise of the reference")
    scene, machine = report["scene"], report["machine"]
    axes.set_title(f"{scene['name']}, {scene['width']}x{scene['height']}, {machine['device'].split(' (')[0]}", fontsize=10)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("ms of a picture")
    axes.set_ylabel("relMSE of inliers" if metric == "trimmed" else metric)
    axes.grid(True, which="major", linewidth=0.3)


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: benchmarks/charts/accuracy_charts.py OUT.png BENCH.json...")
    reports = [json.loads(pathlib.Path(file).read_text(encoding="utf-8")) for file in sys.argv[2:]]
    figure, axes = plt.subplots(1, len(reports), figsize=(5.6 * len(reports), 4.6), squeeze=False)
    for place, report in zip(axes[0], reports):
        draw(place, report)
    axes[0][0].legend(fontsize=7, loc="lower left")
    figure.tight_layout()
    figure.savefig(sys.argv[1], dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main()
