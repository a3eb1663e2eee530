#!/usr/bin/env python3
"""Makes the chart and tables of the measurements of bench_ordering --json and cub_sort. Needs python3-matplotlib.

    benchmarks/charts/ordering_chart.py CHART.png CUB.jsonl ORDERING.json...      tables go to standard output, in Markdown

The chart shows the times of tile-sort, of CUB's sort of pairs and of a plain copy against the number of buckets, a panel
for each number of hits.
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

SPREADS = {"random": "uniform", "Zipf": "Zipf", "picture": "picture"}
# A run in which the GPU's clock was lower shows in its copy. Times are left out if the copy beside them took
# this many times the fastest copy of the file.
SLOW_CLOCK = 1.3


def rows_of(paths):
    """{(hits, buckets, spread, ordering): times}, of the first file that has them."""
    rows = {}
    for path in paths:
        measured = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["rows"]
        fastest = {}
        for row in measured:
            fastest[row["hits"]] = min(fastest.get(row["hits"], 1e9), row["plainCopy"]["median"])
        for row in measured:
            if row["plainCopy"]["median"] < SLOW_CLOCK * fastest[row["hits"]]:
                for entry in row["orderings"]:
                    key = (row["hits"], row["buckets"], row["spread"], entry["ordering"])
                    rows.setdefault(key, {**entry, "plainCopy": row["plainCopy"]})
    return rows


def sizes(rows):
    return sorted({(hits, buckets) for hits, buckets, _, name in rows if name == "tile-sort"})


def cell(entry):
    total, copy = entry["total"], entry["plainCopy"]["median"]
    return f"{total['median']:.1f} ({total['low']:.1f} to {total['high']:.1f}), {total['median'] / copy:.2f}"


def print_best(rows, cub):
    print("| hits | buckets | " + " | ".join(SPREADS.values()) + " | copy | CUB, 32-bit keys | CUB, narrow keys |")
    print("|---|---|" + "---|" * (len(SPREADS) + 3))
    for hits, buckets in sizes(rows):
        found = [rows.get((hits, buckets, spread, "tile-sort")) for spread in SPREADS]
        copy = next((f"{e['plainCopy']['median']:.1f}" for e in found if e), "-")
        other = cub.get((hits, buckets))
        sorts = [f"{other[k]['median']:.0f}" if other else "-" for k in ("sort", "sortNarrowKeys")]
        print(f"| {hits} | {buckets} | " + " | ".join(cell(e) if e else "-" for e in found) + f" | {copy} | " + " | ".join(sorts) + " |")


def print_all(rows):
    names = sorted(dict.fromkeys(name for *_, name in rows), key="tile-sort".__eq__)
    print(f"\n| hits | buckets | spread | {' | '.join(names)} |")
    print("|---|---|---|" + "---|" * len(names))
    for hits, buckets in sorted({(h, b) for h, b, _, name in rows if name != "tile-sort"}):
        for spread, title in SPREADS.items():
            found = [rows.get((hits, buckets, spread, name)) for name in names]
            cells = " | ".join(f"{e['total']['median']:.0f}" if e else "-" for e in found)
            print(f"| {hits} | {buckets} | {title} | {cells} |")


def draw(rows, cub, path):
    counts = sorted({hits for hits, _ in sizes(rows)})
    figure, axes = plt.subplots(1, len(counts), figsize=(4.2 * len(counts), 3.6), squeeze=False)
    for axis, hits in zip(axes[0], counts):
        for spread, color in zip(SPREADS, ("#0072B2", "#009E73", "#D55E00")):
            points = [(b, rows[hits, b, spread, "tile-sort"]) for h, b in sizes(rows) if h == hits and (h, b, spread, "tile-sort") in rows]
            axis.plot([b for b, _ in points], [e["total"]["median"] for _, e in points], "o-", color=color, label=f"tile-sort, {SPREADS[spread]}")
        sorts = sorted((b, e) for (h, b), e in cub.items() if h == hits)
        axis.plot([b for b, _ in sorts], [e["sortNarrowKeys"]["median"] for _, e in sorts], "s--", color="black", label="CUB, narrow keys")
        copies = [e["plainCopy"]["median"] for (h, _, _, name), e in rows.items() if (h, name) == (hits, "tile-sort")]
        axis.axhline(sorted(copies)[len(copies) // 2], color="grey", label="copy of 4 bytes a hit")
        axis.set(xscale="log", title=f"{hits / 2**20:.0f} · 2²⁰ hits", xlabel="buckets", ylabel="µs", ylim=(0, None))
        axis.set_xticks([2, 16, 64, 256, 1024], ["2", "16", "64", "256", "1024"])
    axes[0][0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main(chart, cub_path, *ordering_paths):
    rows = rows_of(ordering_paths)
    lines = pathlib.Path(cub_path).read_text(encoding="utf-8").splitlines()
    cub = {(row["hits"], row["buckets"]): row for row in map(json.loads, lines)}
    print_best(rows, cub)
    print_all(rows)
    draw(rows, cub, chart)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
