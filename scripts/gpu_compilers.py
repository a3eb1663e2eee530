#!/usr/bin/env python3
"""Reduces the reports of scripts/gpu_compilers.sh, and writes the tables of docs/gpu_compilers.md from them.

    scripts/gpu_compilers.py reduce REPORTS OUT.csv    REPORTS has GPU.PACKAGE.json of `glint inspect --pipelines`
    scripts/gpu_compilers.py tables FOLDER DOCUMENT    FOLDER has before.csv and after.csv
    scripts/gpu_compilers.py choices GLINT DOCUMENT NAME=SCENE...    what `auto` chooses with benchmarks/data/gpus

A row of the CSV is a pipeline on a GPU. The facts are those of `glint inspect --pipelines`; `valid` says whether Mesa's
checks of its own intermediate code passed for the package, `instructions` is the driver's count.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess

FACTS = ["registers", "spills", "scratchBytes", "codeBytes", "occupancy", "cost"]
COLUMNS = ["gpu", "package", "pipeline", "tracer", "strategies", "share", "valid", "failure", "subgroup", *FACTS]
COLUMNS += ["instructions", "spirv"]
GPUS = {
    "navi21": "Radeon RX 6800 (RDNA 2)",
    "navi31": "Radeon RX 7900 (RDNA 3)",
    "gfx1200": "Radeon RX 9060 (RDNA 4)",
    "a740": "Adreno 740",
    "a750": "Adreno 750",
    "dg2": "Arc A-series",
}
STRATEGIES = ["uber", "sorted-uber", "visibility", "hit-shaders"]
PACKAGES = {"gallery": "gallery", "sheenchair": "SheenChair", "cases64": "64 cases"}
# A row of the tables: its name, and the pipelines that it is of.
GROUPS = [
    ("cases (visibility)", r"ShadeCase |shade \S"),
    ("uber", r"UberShade"),
    ("sorted uber", r"SortedShade"),
    ("hit shaders", r"HitTrace"),
    ("trace", r"Trace$"),
    ("first hits", r"Lighting$|FirstHit |first \S"),  # `Lighting` shaded those of all cases
    ("walk", r"EffectWalk"),
    ("all others", r""),
]


def number(value):
    """A number without digits that say nothing."""
    return "" if value is None else f"{value:.6g}"


def instructions_of(pipeline):
    counts = [
        statistic["value"]
        for executable in pipeline["executables"]
        for statistic in executable["statistics"]
        if statistic["name"] in ("Instructions", "Instruction Count")
    ]
    return sum(counts) if counts else None


def rows_of(path):
    gpu, package = path.stem.split(".")
    report = json.loads(path.read_text())
    valid = "no" if path.with_suffix(".invalid").exists() else "yes"
    for pipeline in report["pipelines"]:
        modules = pipeline["modules"]
        yield {
            "gpu": gpu,
            "package": package,
            "pipeline": pipeline["name"],
            "tracer": pipeline["tracer"] or "",
            "strategies": " ".join(pipeline["strategies"]),
            "share": number(sum(module["share"] for module in modules)),
            "valid": valid,
            "failure": pipeline["failure"] or "",
            "subgroup": pipeline["subgroupSize"],
            **{name: number(pipeline["facts"][name]) for name in FACTS},
            "instructions": number(instructions_of(pipeline)),
            "spirv": number(sum(module["instructions"] for module in modules)),
        }


def reduce(reports, target):
    order = {name: i for i, name in enumerate([*GPUS, *PACKAGES])}
    rows = [row for path in reports.glob("*.*.json") for row in rows_of(path)]
    rows.sort(key=lambda row: (order[row["gpu"]], order[row["package"]], row["pipeline"], row["tracer"]))
    target.parent.mkdir(parents=True, exist_ok=True)
    with target.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"{len(rows)} rows in {target}")


def read(path):
    """{(gpu, package): {group: [row]}}; a row's facts are numbers or None."""
    measured = {}
    if not path.exists():
        return measured
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            for name in [*FACTS, "instructions", "share"]:
                row[name] = float(row[name]) if row[name] else None
            group = next(name for name, pattern in GROUPS if re.match(pattern, row["pipeline"]))
            measured.setdefault((row["gpu"], row["package"]), {}).setdefault(group, []).append(row)
    return measured


def span(rows, fact, show):
    """The least and the most of a fact."""
    values = [row[fact] for row in rows if row[fact] is not None]
    if not values:
        return "-"
    low, high = show(min(values)), show(max(values))
    return low if low == high else f"{low} to {high}"


def whole(value):
    return f"{value:.0f}"


def percent(value):
    return f"{100 * value:.0f} %"


def kilobytes(value):
    return f"{value / 1024:.0f}"


# Heading, fact, text of a value.
SHOWN = [
    ("registers", "registers", whole),
    ("occupancy", "occupancy", percent),
    ("spills", "spills", whole),
    ("scratch, bytes", "scratchBytes", whole),
    ("instructions", "instructions", whole),
    ("code, kB", "codeBytes", kilobytes),
    ("cost", "cost", whole),
]


def cell(before, after, fact, show):
    now = span(after, fact, show)
    then = span(before, fact, show) if before else now
    return now if then == now else f"{then} → {now}"


def table(gpu, before, after):
    lines = ["| package | pipelines | n | " + " | ".join(heading for heading, _, _ in SHOWN) + " |"]
    lines.append("|---|---|---:|" + "---:|" * len(SHOWN))
    for package, name in PACKAGES.items():
        groups = after.get((gpu, package), {})
        for group, _ in GROUPS:
            rows = groups.get(group, [])
            if rows:
                old = before.get((gpu, package), {}).get(group, [])
                made = sum(1 for row in rows if not row["failure"])
                count = f"{made}" if made == len(rows) else f"{made} of {len(rows)}"
                cells = [cell(old, rows, fact, show) for _, fact, show in SHOWN]
                lines.append(f"| {name} | {group} | {count} | " + " | ".join(cells) + " |")
    return lines


def weighted(rows, fact):
    """The mean of a fact over the hits of the cases."""
    known = [(row["share"] or 0, row[fact]) for row in rows if row[fact] is not None]
    total = sum(share for share, _ in known)
    return sum(share * value for share, value in known) / total if total else None


def spilling(groups):
    return sorted({row["pipeline"] for rows in groups.values() for row in rows if row["spills"]})


def summary(before, after):
    lines = ["| GPU | package | occupancy of a hit's case | least | cost of a hit | uber | pipelines that spill | invalid code |"]
    lines.append("|---|---|---:|---:|---:|---:|---:|---|")
    for gpu, title in GPUS.items():
        for package, name in PACKAGES.items():
            texts = []
            for groups in (before.get((gpu, package)), after.get((gpu, package))):
                if not groups:
                    texts.append(None)
                    continue
                cases = groups.get("cases (visibility)", [])
                uber = groups.get("uber", [])
                occupancy = weighted(cases, "occupancy")
                cost = weighted(cases, "cost")
                rows = [row for rows in groups.values() for row in rows]
                texts.append([
                    "-" if occupancy is None else percent(occupancy),
                    span(cases, "occupancy", percent).split(" to ")[0],
                    "-" if cost is None else whole(cost),
                    span(uber, "cost", whole),
                    str(len(spilling(groups))),
                    "no" if all(row["valid"] == "yes" for row in rows) else "yes",
                ])
            then, now = texts
            if now:
                cells = [b if a is None or a == b else f"{a} → {b}" for a, b in zip(then or [None] * len(now), now)]
                lines.append(f"| {title} | {name} | " + " | ".join(cells) + " |")
    return lines


def explain(glint, scene, gpu):
    """What auto chooses for a scene, with the table of a GPU or without one."""
    command = [glint, "explain", scene, "--merge", "auto", "--json"]
    command += ["--gpu", f"benchmarks/data/gpus/{gpu}.json"] if gpu else []
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def milliseconds(explained):
    """The estimates of all strategies, the fastest first."""
    estimates = sorted(explained["strategies"]["estimates"], key=lambda row: row["milliseconds"])
    return ", ".join(f"{row['strategy']} {row['milliseconds']:.3g}" for row in estimates)


def choice_rows(glint, scenes):
    """A row for each GPU and scene: what auto chooses, and why. "a → b" is what the table changes."""
    yield "| GPU | scene | shaders of `--merge auto` | strategy | shadows | precision | estimates, ms |"
    yield "|---|---|---:|---|---|---|---|"
    for name, scene in scenes:
        usual = explain(glint, scene, None)
        was = [str(usual["strategies"]["cases"]), usual["strategies"]["strategy"], "inline", "32"]
        yield f"| none | {name} | " + " | ".join([*was, milliseconds(usual)]) + " |"
        for gpu, title in GPUS.items():
            explained = explain(glint, scene, gpu)
            chosen = {choice["setting"]: choice["value"] for choice in explained["gpu"]["choices"]}
            now = [str(explained["strategies"]["cases"]), explained["strategies"]["strategy"]]
            now += [chosen["shadows"], chosen["precision"]]
            cells = [b if a == b else f"{a} → {b}" for a, b in zip(was, now)]
            yield f"| {title} | {name} | " + " | ".join([*cells, milliseconds(explained)]) + " |"


def reason_rows(glint, scene):
    """What each table says, and the reasons for shadows and precision, which it gives for all scenes."""
    yield "| GPU | a case that branches | " + " | ".join(f"`{name}`" for name in STRATEGIES) + " | shadows and precision |"
    yield "|---|---:|" + "---:|" * len(STRATEGIES) + "---|"
    for gpu, title in GPUS.items():
        said = explain(glint, scene, gpu)["gpu"]
        factors = {row["strategy"]: row for row in said["strategies"]}
        cells = ["-" if said["branchFactor"] is None else f"{said['branchFactor']:.2f}"]
        for name in STRATEGIES:
            row = factors.get(name)
            stack = f", {row['scratchBytes']:.0f} B" if row and row["scratchBytes"] else ""
            cells.append(
                f"{row['factor']:.2f} ({percent(row['occupancy'])}, {row['spills']:.0f} spills{stack})" if row else "-"
            )
        yield f"| {title} | " + " | ".join(cells) + " | " + " ".join(choice["why"] for choice in said["choices"]) + " |"


def write_choices(glint, document, scenes):
    scenes = [scene.split("=", 1) for scene in scenes]
    blocks = {"choices": list(choice_rows(glint, scenes)), "reasons": list(reason_rows(glint, scenes[0][1]))}
    write_blocks(document, blocks)


# The aims of a case: GPU, fact, whether a value reaches it.
AIMS = [
    ("Adreno 740: occupancy, 50 %", "a740", "occupancy", percent, lambda value: value >= 0.5),
    ("RX 7900: occupancy, 60 %", "navi31", "occupancy", percent, lambda value: value >= 0.6),
    ("Arc: spills, 0", "dg2", "spills", whole, lambda value: value == 0),
]


def cases_of(measured, gpu, package):
    rows = measured.get((gpu, package), {}).get("cases (visibility)", [])
    return {row["pipeline"].split(" ", 1)[1]: row for row in rows}


def cases(before, after):
    """Each case of the smaller packages, and how many of the 64, with the aims that it reaches."""
    lines = ["| package | case | " + " | ".join(aim[0] for aim in AIMS) + " |"]
    lines.append("|---|---|" + "---:|" * len(AIMS))
    for package, title in PACKAGES.items():
        names = sorted({name for aim in AIMS for name in cases_of(after, aim[1], package)})
        if len(names) > 20:
            cells = []
            for _, gpu, fact, show, reaches in AIMS:
                now = cases_of(after, gpu, package).values()
                then = cases_of(before, gpu, package).values()
                text = cell(list(then), list(now), fact, show)
                cells.append(f"{text}; {sum(reaches(row[fact]) for row in now)} of {len(now)} reach it")
            lines.append(f"| {title} | all {len(names)} | " + " | ".join(cells) + " |")
            continue
        for name in names:
            cells = []
            for _, gpu, fact, show, reaches in AIMS:
                row = cases_of(after, gpu, package).get(name)
                old = cases_of(before, gpu, package).get(name)
                text = "-" if row is None else cell([old] if old else None, [row], fact, show)
                cells.append(text + (" ✓" if row and reaches(row[fact]) else ""))
            short = re.sub(r"_.*", "", name)
            lines.append(f"| {title} | {short} | " + " | ".join(cells) + " |")
    return lines


def write_tables(folder, document):
    before, after = read(folder / "before.csv"), read(folder / "after.csv")
    write_blocks(document, {"summary": summary(before, after), "cases": cases(before, after), **{gpu: table(gpu, before, after) for gpu in GPUS}})


def write_blocks(document, blocks):
    text = document.read_text()
    for name, lines in blocks.items():
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        if begin not in text:
            raise SystemExit(f"{document} has no {begin.strip()}")
        head, rest = text.split(begin)
        text = head + begin + "\n" + "\n".join(lines) + "\n\n" + end + rest.split(end, 1)[1]
    document.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("what", choices=["reduce", "tables", "choices"])
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("target", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*")
    arguments = parser.parse_args()
    if arguments.what == "choices":
        write_choices(arguments.source, arguments.target, arguments.scenes)
    else:
        (reduce if arguments.what == "reduce" else write_tables)(arguments.source, arguments.target)


if __name__ == "__main__":
    main()
