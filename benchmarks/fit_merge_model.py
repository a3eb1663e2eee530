#!/usr/bin/env python3
"""Fits the merge planner's cost model of code, and writes tool/plan/cost_constants.h and the
"cost" of each feature in shaders/materials/*/*.json. Needs NumPy.

The measurements are benchmarks/data/merge_model.csv, which benchmarks/measure_merge_model.py makes and describes. The fit is linear,
least squares of relative errors, in two steps:

    1. shaders of one key:     instructions = those of the plain shader, lit or unlit, + sum of the key's features
    2. shaders that branch:    what they have beyond step 1 = inputs * kInputBranch + lobes * kLobeBranch

Constants below zero are dropped from the fit, as no code makes a hit faster. Keys of few features weigh more
(SIMPLE_WEIGHT), as scenes have more of them. A quarter of the random combinations is held out; the errors on them are
printed and stand in the header. The same measurements give the same header, byte for byte.

    benchmarks/fit_merge_model.py [--check]

--check writes nothing, and exits with 1 if the header is not what the measurements give.
"""
import argparse
import csv
import pathlib
import re
import sys

import numpy as np

from merge_scenes import LOBES

ROOT = pathlib.Path(__file__).resolve().parent.parent
MEASUREMENTS = ROOT / "benchmarks/data/merge_model.csv"
DECLARATIONS = ROOT / "shaders/materials"
HEADER = ROOT / "tool/plan/cost_constants.h"
SIMPLE_WEIGHT = 2


class Shader:
    """What a case's features are, and its code."""

    def __init__(self, row):
        self.kind = row["set"]
        self.always, self.sometimes = frozenset(row["always"].split()), frozenset(row["sometimes"].split())
        self.instructions, self.fetches = int(row["instructions"]), int(row["fetches"])

    def features(self):
        return self.always | self.sometimes


def read_measurements():
    """(shaders of one key each feature alone, of random keys, shaders that branch)"""
    with MEASUREMENTS.open(newline="", encoding="ascii") as file:
        shaders = [Shader(row) for row in csv.DictReader(file)]
    alone = [s for s in shaders if s.kind == "alone"]
    together = [s for s in shaders if s.kind == "together"]
    return alone, together, [s for s in shaders if s.kind in ("family", "all") and s.sometimes]


# ---- The fit


def least_squares(rows, values, weight):
    """Constants, none below zero, that minimise the weighted squares."""
    rows, values, weight = np.array(rows, float), np.array(values, float), np.array(weight, float)
    kept = list(range(rows.shape[1]))
    while True:
        found = np.linalg.lstsq(rows[:, kept] * weight[:, None], values * weight, rcond=None)[0]
        if found.min() >= 0:
            break
        kept.pop(int(found.argmin()))
    constants = np.zeros(rows.shape[1])
    constants[kept] = found
    return constants


def branch_row(shader):
    lobes = len(shader.sometimes & LOBES.keys())
    return [len(shader.sometimes) - lobes, lobes]


class Model:
    def __init__(self, simple, combined, branching):
        keys = simple + combined
        self.features = sorted({f for shader in keys for f in shader.features()} - {"unlit"})
        self.lit = next(s.instructions for s in simple if not s.features())
        self.unlit = next(s.instructions for s in simple if s.features() == {"unlit"})
        weight = [(SIMPLE_WEIGHT if s in simple else 1) / s.instructions for s in keys]
        rows = [self.row(s) for s in keys]
        self.code = np.round(least_squares(rows, [s.instructions - self.plain(s) for s in keys], weight))
        self.fetches = np.round(least_squares(rows, [s.fetches for s in keys], [1] * len(keys)), 1)
        self.branch = np.zeros(2)
        beyond = [s.instructions - self.instructions(s) for s in branching]
        weight = [1 / s.instructions for s in branching]
        self.branch = np.round(least_squares([branch_row(s) for s in branching], beyond, weight))

    def row(self, shader):
        return [float(f in shader.features()) for f in self.features]

    def plain(self, shader):
        return self.unlit if "unlit" in shader.always else self.lit

    def instructions(self, shader):
        return self.plain(shader) + self.code @ self.row(shader) + self.branch @ branch_row(shader)

    def errors(self, shaders):
        """How far the model is off on these shaders."""
        measured = np.array([s.instructions for s in shaders], float)
        wrong = np.array([self.instructions(s) for s in shaders]) - measured
        relative = np.abs(wrong) / measured * 100
        fetches = np.array([self.fetches @ self.row(s) - s.fetches for s in shaders])
        return {
            "count": len(shaders),
            "mean": float(relative.mean()),
            "most": float(relative.max()),
            "r2": float(1 - (wrong @ wrong) / ((measured - measured.mean()) @ (measured - measured.mean()))),
            "fetches": float(np.abs(fetches).max()),
        }


def fit():
    alone, together, branching = read_measurements()
    model = Model(alone, *([s for i, s in enumerate(shaders) if i % 4] for shaders in (together, branching)))
    errors = {"one key": model.errors(together[::4]), "branches": model.errors(branching[::4])}
    return model, errors, (len(alone) + len(together), len(branching))


# ---- The header


def constants_of(model):
    """Name and value of everything in the header that was measured."""
    values = {
        "kUnlitInstructions": model.unlit,
        "kLitInstructions": model.lit - model.unlit,
        "kInputBranch": model.branch[0],
        "kLobeBranch": model.branch[1],
    }
    for feature, code, fetches in zip(model.features, model.code, model.fetches):
        values[feature], values[feature + " fetches"] = code, fetches
    return values


def header_text(model, errors, counts):
    values = constants_of(model)
    held = "".join(
        f"//     {kind:<10} {e['count']:7} {e['mean']:10.1f} %{e['most']:9.1f} %{e['r2']:8.3f}{e['fetches']:14.1f}\n"
        for kind, e in errors.items()
    )
    return f"""// Made by benchmarks/fit_merge_model.py from benchmarks/data/merge_model.csv; run it again rather than edit\n// this.
//
// Fitted to {counts[0]} shaders of one key and {counts[1]} that branch, less a quarter of the random ones. On that quarter
// the model is off, in instructions, and in texture fetches:
//
//                shaders  mean error  largest      R2  fetches, most
{held}//
// The mean and the largest error are relative; R2 is that of the instructions.
#pragma once

namespace glint::compiler::fitted {{

// SPIR-V instructions of the shader of one unlit key without other features, and what being lit adds.
inline constexpr double kUnlitInstructions = {values['kUnlitInstructions']:.1f};
inline constexpr double kLitInstructions = {values['kLitInstructions']:.1f};

// Instructions beyond the features' own code, for each feature that a shader branches on.
inline constexpr double kInputBranch = {values['kInputBranch']:.1f};
inline constexpr double kLobeBranch = {values['kLobeBranch']:.1f};

// The code of a feature itself is in its declaration ("cost").

}}  // namespace glint::compiler::fitted
"""


def declaration_texts(model):
    """The declarations by path, with the costs of their features."""
    values = constants_of(model)
    texts, written = {}, set()
    for path in sorted(DECLARATIONS.glob("*/*.json")):
        def with_cost(match):
            name = match.group(2)
            if name not in values:
                sys.exit(f"{path}: {name} has a cost and was not measured")
            written.add(name)
            cost = f'{{ "instructions": {values[name]:g}, "fetches": {values[name + " fetches"]:g} }}'
            return f'{match.group(1)}"cost": {cost}'

        pattern = r'("name": "(\w+)"(?:(?!"name":).)*?)"cost": \{[^}]*\}'
        texts[path] = re.sub(pattern, with_cost, path.read_text(encoding="utf-8"), flags=re.DOTALL)
    missing = {name for name in values if not name.startswith("k") and not name.endswith(" fetches")} - written
    if missing:
        sys.exit(f"no declaration has a place for the cost of: {', '.join(sorted(missing))}")
    return texts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with the header instead of writing it")
    arguments = parser.parse_args()
    model, errors, counts = fit()
    for kind, error in errors.items():
        off = f"off by {error['mean']:.1f} % in the mean, {error['most']:.1f} % at most, R2 {error['r2']:.3f}"
        print(f"held out, {kind}: {error['count']} shaders: {off}; fetches by {error['fetches']:.1f} at most")
    texts = {HEADER: header_text(model, errors, counts), **declaration_texts(model)}
    for path, text in texts.items():
        name = path.relative_to(ROOT)
        if path.read_text(encoding="utf-8") == text:
            continue
        if arguments.check:
            sys.exit(f"{name} is not what the measurements give: run benchmarks/fit_merge_model.py")
        path.write_text(text, encoding="utf-8")
        print(f"wrote {name}")
    print("the costs are what the measurements give")


if __name__ == "__main__":
    main()
