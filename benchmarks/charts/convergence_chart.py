#!/usr/bin/env python3
"""Draws the first table of measure_convergence.py. Needs python3-matplotlib.

    benchmarks/charts/convergence_chart.py CHART.png TABLE.md      TABLE.md: what measure_convergence.py printed

The chart shows the error of each kind of light against the number of samples, both on logarithmic axes, and a dashed
line that falls as one over the root of the samples.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def rows_of(path):
    """The numbers of samples, and the errors of each kind of light."""
    table = pathlib.Path(path).read_text(encoding="utf-8").split("\n\n")[0]
    cells = [[cell.strip() for cell in line.strip("| ").split("|")] for line in table.splitlines()]
    samples = [int(cell.split()[0]) for cell in cells[0][1:-1]]
    return samples, {row[0]: [float(cell) for cell in row[1:-1]] for row in cells[2:]}


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: benchmarks/charts/convergence_chart.py CHART.png TABLE.md")
    samples, errors = rows_of(sys.argv[2])
    _, axes = plt.subplots(figsize=(7, 4.5))
    for kind, values in errors.items():
        axes.plot(samples, values, marker="o", markersize=4, label=kind)
    start = 1.5 * max(values[0] for values in errors.values())
    axes.plot(samples, [start * (samples[0] / count) ** 0.5 for count in samples], "k--", linewidth=1,
              label="one over the root of the samples")
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(samples, [str(count) for count in samples])
    axes.set_xlabel("samples of a pixel")
    axes.set_ylabel("RMSE, linear light")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8, bbox_to_anchor=(1.01, 1), loc="upper left")
    plt.tight_layout()
    plt.savefig(sys.argv[1], dpi=110)


if __name__ == "__main__":
    main()
