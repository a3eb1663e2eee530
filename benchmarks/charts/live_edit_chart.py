#!/usr/bin/env python3
"""Draws where the time from an edit to its picture goes. Needs python3-matplotlib.

    benchmarks/charts/live_edit_chart.py CHART.png LABEL=FILE.json...      FILE.json: of glint_live_edit --json

Each file gives a bar of medians. Numbers also go to standard output, as a table in Markdown. With --processor the parts
are the processor times of the compiler and of the program that draws, which hardly depend on what else the machine does.
"""
import json
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# The parts of the bars, and the members of the JSON that each part sums.
PARTS = {
    "notice the edit": ["notice"],
    "read and plan": ["read", "plan"],
    "compile GLSL": ["compile"],
    "write and load": ["write", "load"],
    "make pipelines": ["replace", "pipelines"],
    "first frame": ["first frame"],
}
PROCESSOR = {"compiler": ["compiler"], "program that draws": ["renderer"]}
GOAL_MS = 500


def median(edits, names):
    return statistics.median(sum(edit["whole"].get(name, 0.0) for name in names) for edit in edits)


def bar_of(label, path, parts):
    """The bar of a file: (label, the median of each part, the median of their sum)."""
    edits = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["edits"]
    everything = [name for names in parts.values() for name in names]
    return label, [median(edits, names) for names in parts.values()], median(edits, everything)


def print_table(bars, parts):
    print("| | " + " | ".join(parts) + " | in all |")
    print("|---|" + "--:|" * (len(parts) + 1))
    for label, values, total in bars:
        cells = [f"{value:.0f}" for value in values] + [f"**{total:.0f}**"]
        print(f"| {label} | " + " | ".join(cells) + " |")


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--processor"]
    parts = PROCESSOR if "--processor" in sys.argv else PARTS
    if len(arguments) < 2 or not all("=" in argument for argument in arguments[1:]):
        sys.exit("usage: benchmarks/charts/live_edit_chart.py [--processor] CHART.png LABEL=FILE.json...")
    bars = []
    for argument in arguments[1:]:
        label, path = argument.split("=", 1)
        bars.append(bar_of(label, path, parts))
    print_table(bars, parts)
    _, axes = plt.subplots(figsize=(9, 0.8 + 0.55 * len(bars)))
    for row, (_, values, total) in enumerate(bars):
        left = 0.0
        for number, value in enumerate(values):
            axes.barh(row, value, left=left, color=f"C{number}", height=0.65,
                      label=list(parts)[number] if row == 0 else None)
            left += value
        axes.text(left, row, f" {total:.0f}", va="center", fontsize=8)
    axes.set_xlim(right=1.1 * max(total for _, _, total in bars))  # room for the sums
    axes.axvline(GOAL_MS, color="k", linestyle="--", linewidth=1)
    axes.set_yticks(range(len(bars)), [label for label, _, _ in bars], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("ms of processor time from the edit to its picture" if parts is PROCESSOR
                    else "ms from the edit to its picture (dashed: half a second)")
    axes.grid(True, axis="x", alpha=0.3)
    axes.legend(fontsize=8, bbox_to_anchor=(1.01, 1), loc="upper left")
    plt.tight_layout()
    plt.savefig(arguments[0], dpi=110)


if __name__ == "__main__":
    main()
