#!/usr/bin/env python3
"""Writes the tables of docs/specification.md from the JSON of glint_spec_oracle.

usage: scripts/specification_table.py SPECIFICATION.json [DOCUMENT.md]

Groups of rows, the bounds, and each row's ratio of Glint's light to the specification's and relative difference, with
what is stated where the ratio is outside of 1 ± 0.02. With a document it replaces what stands there between the marks,
otherwise it prints. Exits 1 if nothing is stated about a row outside.
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


def statements(row):
    """What is stated about a row, as pairs of a text and the share of the light that it changes."""
    yield from ((f"{one['what']}: {one['why']}" if one["why"] else one["what"], one["share"])
                for one in row["approximations"])
    if away(row["statedRatio"]) >= 0.005:
        noisy = away(row["statedRatio"]) <= row["noise"]
        why = "the noise of the samples" if noisy else row["boundBecause"]
        yield f"over the prediction: {why}", row["statedRatio"] - 1


def materials(rows, notes):
    """All rows of a group: a line for each material, a column for each light. `notes` grows by what is stated."""
    lights = list(dict.fromkeys(row["light"] for row in rows))
    lines = []
    for material, part in group_by(rows, lambda row: row["material"]):
        cells = dict.fromkeys(lights, "")
        shares = {}
        for row in part:
            outside = away(row["ratio"]) > OUTSIDE
            ratio = f"**{row['ratio']:.3f}**" if outside else f"{row['ratio']:.3f}"
            cells[row["light"]] = f"{ratio}, {row['relativeDifference']:.3f}"
            for text, share in statements(row) if outside else ():
                shares[text] = max(shares.get(text, 0.0), share, key=abs)
        stated = (f"{100 * share:+.1f} % [{notes.setdefault(text, len(notes) + 1)}]" for text, share in shares.items())
        lines.append((material, *cells.values(), ", ".join(stated)))
    return table(("material", *lights, "stated"), lines)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = json.load(file)
    outside = [row for row in rows if away(row["ratio"]) > OUTSIDE]
    notes = {}
    tables = "\n".join(f"### {group[0].upper()}{group[1:]}, compensation {switch}\n\n{materials(part, notes)}"
                       for (group, switch), part in group_by(rows, lambda row: (row["group"], compensation(row))))
    numbered = "".join(f"{number}. {text}\n" for text, number in notes.items())
    text = (f"{len(rows)} rows, {len(outside)} of them outside of 1 ± 0.02.\n\n## Groups\n\n{groups(rows)}\n"
            f"## Bounds\n\n{bounds(rows)}\n## What is stated\n\n{numbered}\n## Rows\n\n{tables}")
    if len(sys.argv) == 2:
        print(text, end="")
    else:
        with open(sys.argv[2], encoding="utf-8") as file:
            document = file.read()
        marks = re.compile("(?<=<!-- begin specification -->\n).*(?=<!-- end specification -->)", re.DOTALL)
        with open(sys.argv[2], "w", encoding="utf-8") as file:
            file.write(marks.sub(lambda _: text, document))
    bare = [row for row in outside if not any(statements(row))]
    for row in bare:
        print(f"{row['group']}: {row['material']}, {row['light']}, compensation {compensation(row)}: "
              f"{row['ratio']:.3f}, and nothing says why", file=sys.stderr)
    return 1 if bare else 0


if __name__ == "__main__":
    sys.exit(main())
