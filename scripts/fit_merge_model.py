#!/usr/bin/env python3
"""Fits what the merge planner's cost model knows of code, and writes tool/plan/cost_constants.h. Needs NumPy.

Measurements: synthetic scenes (scripts/merge_scenes.py), compiled by `glint compile --strategy visibility` with --merge
none (a shader a key), family and all (shaders that branch); instructions and texture fetches of each case's SPIR-V from
the package's manifest. The fit is linear, least squares of relative errors, in two steps:

    1. shaders of one key:     instructions = those of the plain shader, lit or unlit, + sum of the key's features
    2. shaders that branch:    what they have beyond step 1 = inputs * kInputBranch + lobes * kLobeBranch

Constants below zero are dropped from the fit, as no code makes a hit faster. Keys of few features weigh more
(SIMPLE_WEIGHT), as scenes have more of them. A quarter of the random combinations is held out; the errors on them are
printed and stand in the header. The same `glint` gives the same header.

    scripts/fit_merge_model.py [--glint PATH] [--check]     default: build/release/bin/glint

--check writes nothing and exits 1 where a constant of the header is off by more than TOLERANCE. Takes about two minutes.
"""
import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import numpy as np

from merge_scenes import FEATURES, INPUTS, LOBES, TEXTURES, complete, make_scene

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADER = ROOT / "tool/plan/cost_constants.h"
SEED = 20250321
SIMPLE_WEIGHT = 2
TOLERANCE = 0.05, 5  # of a constant's value, or in instructions, whichever is more

# ---- Measurements


class Shader:
    """What a case's features are, and its code."""

    def __init__(self, entry):
        self.always, self.sometimes = frozenset(entry["always"]), frozenset(entry["sometimes"])
        code = entry["stages"]["visibility"]
        self.instructions, self.fetches = code["instructions"], code["textureFetches"]

    def features(self):
        return self.always | self.sometimes


def compile_scene(glint, folder, wishes, merge):
    scene, package = folder / "scene.gltf", folder / "scene.glint"
    scene.write_text(make_scene(list(dict.fromkeys(wishes))))
    command = [glint, "compile", scene, "-o", package, "--merge", merge, "--strategy", "visibility"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"fit_merge_model.py: {' '.join(map(str, command))}\n{done.stderr}")
    return [Shader(entry) for entry in json.loads((package / "manifest.json").read_text())["shaders"]]


def measure(glint):
    """(shaders of one key each feature alone, of random keys, shaders that branch)"""
    rng = random.Random(SEED)
    # Not alphaMask: rays test alpha before a case is reached.
    mixable = [f for f in FEATURES if f not in ("unlit", "specularGlossiness")]

    def random_key(most):
        return complete(rng.sample(mixable, 1 + rng.randrange(most)))

    single = [complete({f}) for f in FEATURES] + [complete({f, "normals", "baseColorTexture"}) for f in FEATURES]
    single += [frozenset(), complete({"unlit", "vertexColor"}), complete({"unlit", "baseColorTexture", "vertexColor"})]
    combined = [random_key(9) for _ in range(120)]
    families = []
    inputs = TEXTURES[:5] + [f for f in INPUTS if f != "clearcoatSharesNormal"]
    for lobes in (0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 3, 3):
        family = set(rng.sample([f for f in LOBES if f not in ("unlit", "specularGlossiness")], lobes))
        families += [complete(family | set(rng.sample(inputs, rng.randrange(7)))) for _ in range(4)]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        alone = compile_scene(glint, folder, single, "none")
        # Both kinds in one package: each keeps its place, so that what is held out is the same every time.
        together = compile_scene(glint, folder, combined, "none")
        branching = compile_scene(glint, folder, families, "family")
        for _ in range(28):
            branching += compile_scene(glint, folder, [random_key(6) for _ in range(rng.randint(2, 7))], "all")
    return alone, together, [shader for shader in branching if shader.sometimes]


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
        """Median and largest relative error, percent, and how far fetches are off at most."""
        relative = [abs(self.instructions(s) - s.instructions) / s.instructions * 100 for s in shaders]
        fetches = [abs(self.fetches @ self.row(s) - s.fetches) for s in shaders]
        return float(np.median(relative)), max(relative), max(fetches)


def fit(glint):
    alone, together, branching = measure(glint)
    trained = [[s for i, s in enumerate(shaders) if i % 4] for shaders in (together, branching)]
    model = Model(alone, *trained)
    held = {"keys": together[::4], "branching": branching[::4]}
    errors = {}
    for kind, shaders in held.items():
        errors[kind] = model.errors(shaders)
        median, most, fetches = errors[kind]
        off = f"instructions off by {median:.1f} % in the median, {most:.1f} % at most; fetches by {fetches:.1f} at most"
        print(f"held out, {kind}: {len(shaders)} shaders: {off}")
    return model, errors, (len(alone) + len(together), len(branching))


# ---- The header


def pascal(feature):
    return feature[0].upper() + feature[1:]


def constants_of(model):
    """Name and value of everything in the header that was measured."""
    values = {
        "kUnlitInstructions": model.unlit,
        "kLitInstructions": model.lit - model.unlit,
        "kInputBranch": model.branch[0],
        "kLobeBranch": model.branch[1],
    }
    for feature, code, fetches in zip(model.features, model.code, model.fetches):
        values[pascal(feature)], values[pascal(feature) + " fetches"] = code, fetches
    return values


def header_text(model, errors, counts):
    values = constants_of(model)
    rows = "".join(
        f"    {{Feature::{name}, {values[name]:.1f}, {values[name + ' fetches']:.1f}}},\n"
        for name in values
        if not name.startswith("k") and not name.endswith(" fetches")
    )
    keys, branching = errors["keys"], errors["branching"]
    return f"""// Made by scripts/fit_merge_model.py from measurements; run it again rather than edit this.
//
// Fitted to {counts[0]} shaders of one key and {counts[1]} that branch, less a quarter of the random ones. On that quarter
// instructions are off by {keys[0]:.0f} % in the median and {keys[1]:.0f} % at most without branches, by {branching[0]:.0f} % and
// {branching[1]:.0f} % with them.
#pragma once

#include "plan/features.h"

namespace glint::fitted {{

// SPIR-V instructions of the shader of one unlit key without other features, and what being lit adds.
inline constexpr double kUnlitInstructions = {values['kUnlitInstructions']:.1f};
inline constexpr double kLitInstructions = {values['kLitInstructions']:.1f};

// What a shader has beyond its features' own code for each feature that it branches on.
inline constexpr double kInputBranch = {values['kInputBranch']:.1f};
inline constexpr double kLobeBranch = {values['kLobeBranch']:.1f};

// What a shader has more for a feature; nothing for those that are not listed.
struct FeatureCode {{
    Feature feature;
    double instructions;
    double fetches;
}};

inline constexpr FeatureCode kFeatureCode[] = {{
{rows}}};

}}  // namespace glint::fitted
"""


def read_header():
    """The constants of the header as it is, by the names of constants_of()."""
    text = HEADER.read_text() if HEADER.exists() else ""
    values = {name: float(value) for name, value in re.findall(r"double (k\w+) = ([\d.]+);", text)}
    for name, instructions, fetches in re.findall(r"\{Feature::(\w+), ([\d.]+), ([\d.]+)\}", text):
        values[name], values[name + " fetches"] = float(instructions), float(fetches)
    return values


def differences(wanted, found):
    for name in sorted(wanted.keys() | found.keys()):
        if name not in wanted or name not in found:
            yield f"{name}: {'is measured no more' if name not in wanted else 'is missing'}"
            continue
        allowed = 0.05 if name.endswith(" fetches") else max(TOLERANCE[0] * abs(wanted[name]), TOLERANCE[1])
        if abs(wanted[name] - found[name]) > allowed:
            yield f"{name}: {found[name]:g}, measured {wanted[name]:g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--glint", default=ROOT / "build/release/bin/glint", help="the command that compiles")
    parser.add_argument("--check", action="store_true", help="compare with the header instead of writing it")
    arguments = parser.parse_args()
    model, errors, counts = fit(arguments.glint)
    if arguments.check:
        off = list(differences(constants_of(model), read_header()))
        print("\n".join(off) if off else f"{HEADER.relative_to(ROOT)} is what was measured")
        sys.exit(bool(off))
    HEADER.write_text(header_text(model, errors, counts))
    print(f"wrote {HEADER.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
