#!/usr/bin/env python3
"""Joins reports of `glint inspect PACKAGE --pipelines --json` of one GPU into a table for `--gpu`.

gpu_table.py NAME BASE.json [OTHER.json...] > benchmarks/data/gpus/NAME.json

BASE is of a package with --merge none, --shadows inline and --precision 32, the others of packages of the same
scene. Names of packages are reduced to that of their folder.
"""
import json
import os
import sys


def main() -> None:
    name, *files = sys.argv[1:]
    reports = [json.load(open(file, encoding="utf-8")) for file in files]
    device = reports[0]["device"]
    for file, report in zip(files, reports):
        if report["device"]["name"] != device["name"]:
            sys.exit(f"{file}: is of {report['device']['name']}, and {files[0]} of {device['name']}")
    table = {
        "format": "glint-gpu",
        "version": 1,
        "name": name,
        "device": device["name"],
        "driver": device["driver"],
        "subgroupSize": device["subgroupSize"],
        "packages": [
            {
                "package": os.path.basename(os.path.normpath(report["package"])),
                "merge": report["merge"],
                "shadows": report["shadows"],
                "precision": report["precision"],
                "summary": report["summary"],
            }
            for report in reports
        ],
    }
    json.dump(table, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
