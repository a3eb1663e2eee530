#!/usr/bin/env python3
"""Writes the tables of docs/specification.md from the JSON of glint_spec_oracle.

usage: scripts/specification_table.py SPECIFICATION.json [DOCUMENT.md]

Groups of rows, the bounds, and every row in which Glint's light is not within 2 % of the specification's. With a
document it replaces what stands there between the marks, otherwise it prints. Exits 1 if a row is outside of 1 ± 0.02
and nothing says why.
"""
import json
import re
import sys

OUTSIDE = 0.02


def away(value):
    return abs(value - 1)


def group_by(rows, key):
    groups = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups.items()


def table(columns, lines):
    return "\n".join([f"| {' | '.join(columns)} |", "|" + "---|" * len(columns),
                      *(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)]) + "\n"


def compensation(row):
    return "on" if row["compensation"] else "off"


def span(values):
    return f"{min(values):.3f} to {max(values):.3f}"


def groups(rows):
    columns = ("group", "light", "compensation", "rows", "ratio", "relative difference, up to", "over prediction",
               "noise, up to", "outside 1 ± 0.02")
    order = list(dict.fromkeys(row["group"] for row in rows))
    parts = group_by(rows, lambda row: (row["group"], row["light"], compensation(row)))
    return table(columns, [
        (*key, len(part), span([row["ratio"] for row in part]),
         f"{max(row['relativeDifference'] for row in part):.3f}", span([row["statedRatio"] for row in part]),
         f"{max(row['noise'] for row in part):.3f}", sum(away(row["ratio"]) > OUTSIDE for row in part))
        for key, part in sorted(parts, key=lambda item: order.index(item[0][0]))])


def bounds(rows):
    columns = ("bound", "what is approximated beyond the prediction", "rows", "farthest from the prediction",
               "noise of that row")
    lines = []
    for (bound, why), part in group_by(rows, lambda row: (row["bound"], row["boundBecause"])):
        worst = max(part, key=lambda row: away(row["statedRatio"]))
        lines.append((f"{100 * bound:.1f} %", why, len(part), f"{100 * away(worst['statedRatio']):.2f} %",
                      f"{100 * worst['noise']:.2f} %"))
    return table(columns, lines)


class Notes:
    def __init__(self):
        self.texts = []

    def mark(self, share, text):
        if text not in self.texts:
            self.texts.append(text)
        return f"{100 * share:+.1f} % [{self.texts.index(text) + 1}]"

    def __str__(self):
        return "".join(f"{i}. {text}\n" for i, text in enumerate(self.texts, 1))


def stated(row, notes):
    marks = [notes.mark(one["share"], f"{one['what']}: {one['why']}" if one["why"] else one["what"])
             for one in row["approximations"]]
    if away(row["statedRatio"]) >= 0.005 or not marks:
        why = row["boundBecause"] if away(row["statedRatio"]) > row["noise"] else "the noise of the samples"
        marks.append(notes.mark(row["statedRatio"] - 1, f"over the prediction: {why}"))
    return ", ".join(marks)


def unexplained(row):
    return not row["approximations"] and away(row["statedRatio"]) > row["bound"] + row["noise"]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = json.load(file)
    outside = [row for row in rows if away(row["ratio"]) > OUTSIDE]
    notes = Notes()
    parts = ""
    for (light, switch), part in group_by(outside, lambda row: (row["light"], compensation(row))):
        parts += f"\n### {light[0].upper()}{light[1:]}, compensation {switch}\n\n"
        parts += table(("group", "material", "ratio", "relative difference", "predicted", "stated"),
                       [(row["group"], row["material"], f"{row['ratio']:.3f}", f"{row['relativeDifference']:.3f}",
                         f"{row['predictedRatio']:.3f}", stated(row, notes)) for row in part])
    text = (f"{len(rows)} rows, {len(outside)} of them outside of 1 ± 0.02.\n\n## Groups\n\n{groups(rows)}\n"
            f"## Bounds\n\n{bounds(rows)}\n## What is stated\n\n{notes}\n## Rows outside of 1 ± 0.02\n{parts}")
    if len(sys.argv) == 2:
        print(text, end="")
    else:
        with open(sys.argv[2], encoding="utf-8") as file:
            document = file.read()
        marks = re.compile("(?<=<!-- begin specification -->\n).*(?=<!-- end specification -->)", re.DOTALL)
        with open(sys.argv[2], "w", encoding="utf-8") as file:
            file.write(marks.sub(lambda _: text, document))
    bare = [row for row in outside if unexplained(row)]
    for row in bare:
        print(f"{row['group']}: {row['material']}, {row['light']}, compensation {compensation(row)}: "
              f"{row['ratio']:.3f}, and nothing says why", file=sys.stderr)
    return 1 if bare else 0


if __name__ == "__main__":
    sys.exit(main())
