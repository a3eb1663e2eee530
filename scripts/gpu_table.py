#!/usr/bin/env python3
"""Joins reports of `glint inspect PACKAGE --pipelines --json` of one GPU into a table for `--gpu`.

gpu_table.py NAME BASE.json [OTHER.json...] > benchmarks/data/gpus/NAME.json

BASE is of a package with --merge none, --shadows inline and --precision 32, the others of packages of the same
scene. Names of packages are reduced to that of their folder. The table has the numbers that tool/plan/gpu_costs.h
reads, and no others: it is compiled into glint.
"""
import json
import os
import sys

# Modules that shade or trace the rays of hits.
ROLES = ("HitTrace", "ShadeCase", "ShadowTrace", "SortedShade", "UberShade")
# Modules of further packages: choices compare the cases of packages, and the pass of their shadow rays.
COMPARED = ("ShadeCase", "ShadowTrace")
NUMBERS = ("cost", "weight", "occupancy", "spills", "scratchBytes")


def modules_of(report: dict, roles: tuple) -> list:
    """The rows of the summary that are read: ray queries come before ray tracing pipelines."""
    rows = {}
    for row in report["summary"]:
        if row["role"] in roles and (row["role"] not in rows or row["tracer"] == "ray-query"):
            rows[row["role"]] = {name: row[name] for name in ("role", "tracer", "modules", *NUMBERS)}
    return [rows[role] for role in sorted(rows)]


def main() -> None:
    name, *files = sys.argv[1:]
    reports = [json.load(open(file, encoding="utf-8")) for file in files]
    device = reports[0]["device"]
    for file, report in zip(files, reports):
        if report["device"]["name"] != device["name"]:
            sys.exit(f"{file}: is of {report['device']['name']}, and {files[0]} of {device['name']}")
    head = {
        "format": "glint-gpu",
        "version": 1,
        "name": name,
        "device": device["name"],
        "driver": device["driver"],
        "subgroupSize": device["subgroupSize"],
    }
    print(json.dumps(head, indent=1)[:-2] + ',\n "packages": [')
    for number, report in enumerate(reports):
        package = {
            "package": os.path.basename(os.path.normpath(report["package"])),
            **{name: report[name] for name in ("merge", "shadows", "precision")},
        }
        modules = modules_of(report, COMPARED if number else ROLES)
        # A module is a line, so that a change of the shaders is a readable difference.
        lines = ",\n   ".join(json.dumps(module) for module in modules)
        print(f"  {json.dumps(package)[:-1]}, \"summary\": [\n   {lines}]}}" + ("," if number + 1 < len(reports) else ""))
    print(" ]\n}")


if __name__ == "__main__":
    main()
