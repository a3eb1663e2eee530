"""Makes the measurements and tables of benchmarks/measure_merge.sh, which describes them."""
import argparse
import json
import math
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import time

from merge_scenes import FEATURES, complete, make_scene
from replace_module import replace

POLICIES = ["none", "family", "auto", "all"]
SIZE = "96x54"
# The switch is measured on these scenes. They have at most as many cases as compile in reasonable time
# without folding, and some have few.
SWITCH_SCENES = ["SheenChair", "ClearCoatTest", "gallery"]
SWITCH_RUNS = 2
# The time that a naive switch may take; a longer time is reported as more. A switch that takes longer than
# LONG_MS is made once.
PATIENCE_S = 240
LONG_MS = 20_000
# The number of images with warm pipelines. The fastest counts.
FRAMES = 3
# With more keys than this, the driver's compiler gets no switch with everything inlined.
MOST_INLINED_KEYS = 16


def run_json(command, patience=None, environment=None):
    variables = {**os.environ, **(environment or {})}
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=patience, env=variables)
    if done.returncode != 0:
        sys.exit(f"measure_merge.py: {' '.join(map(str, command))}\n{done.stderr}")
    return json.loads(done.stdout)


def make_synthetic(path, keys=48, seed=20250410):
    """A grid of squares of as many keys, and a mirror in front of it that sees them."""
    rng = random.Random(seed)
    mixable = [f for f in FEATURES if f not in ("unlit", "specularGlossiness", "dispersion")]
    wishes = {}
    while len(wishes) < keys:
        wishes[complete(rng.sample(mixable, 1 + rng.randrange(6)))] = None
    columns = 8
    placed = [(wish, i % columns - 3.5, i // columns - 2.5, 0, 0.95) for i, wish in enumerate(wishes)]
    path.write_text(make_scene(list(wishes), placed, mirror=(0, 0, 6, 12)))


class Measurer:
    def __init__(self, glint, work):
        self.glint, self.work = glint, work

    def plan(self, scene):
        """Keys, and by policy what tells its plan from another's."""
        found = run_json([self.glint, "explain", scene, "--plan", "--merge", "auto", "--json"])["plan"]
        return found["keys"], {p["merge"]: (p["cases"], round(p["inVain"], 6)) for p in found["policies"]}

    def compile(self, scene, merge, strategy, package):
        shutil.rmtree(package, ignore_errors=True)
        made = run_json(
            [self.glint, "compile", scene, "-o", package, "--merge", merge, "--strategy", strategy]
            + ["--effects", "shadow,reflection", "--emit", "glsl,header", "--cache", "none", "--json"]
        )
        counts = made["counts"]
        return {
            "cases": counts["cases"],
            "files": counts["uniqueSpirv"],
            "bytes": made["spirvBytes"],
            "compile": made["milliseconds"],
        }

    def render(self, scene, strategy, package):
        """Cold: pipelines and the first image, which compiles on lavapipe. Then frames with the driver's cache."""
        cache = self.work / "driver-cache"
        shutil.rmtree(cache, ignore_errors=True)
        cache.mkdir()
        environment = {"MESA_SHADER_CACHE_DIR": str(cache.resolve())}
        command = [self.glint, "render", scene, "-o", self.work / "image.exr", "--package", package, "--json"]
        command += ["--strategy", strategy, "--size", SIZE, "--spp", 2, "--max-roughness", 1]
        cold = run_json(command, PATIENCE_S, environment)
        warm = [run_json(command, PATIENCE_S, environment)["passes"] for _ in range(FRAMES)]
        return {
            "pipelines": cold["pipelineCreationMs"],
            "first": cold["renderMs"],
            "frame": min(sum(each["milliseconds"] for each in passes) for passes in warm),
        }


# ---- Tables


def median(runs, what):
    return statistics.median(run[what] for run in runs)


def ratios(runs, base, what):
    """Of each run to the base's of the same round."""
    return [ours[what] / theirs[what] for ours, theirs in zip(runs, base) if theirs[what] > 0]


def spread(values):
    if not values:
        return "–"
    low, high = min(values), max(values)
    middle = f"{statistics.median(values):.2f}"
    return middle if f"{low:.2f}" == f"{high:.2f}" else f"{middle} ({low:.2f} to {high:.2f})"


def geometric_mean(values):
    return math.exp(statistics.fmean(map(math.log, values)))


def print_scenes(results):
    print("| scene | keys | `--merge` | cases | files | SPIR-V, kB | compile, ms | pipelines, ms | frame, ms |", end="")
    print(" SPIR-V × `none` | compile × | pipelines × | frame × |")
    print("|---|" + "---|" * 12)
    for name, (keys, by_policy, same) in results.items():
        for merge, runs in by_policy.items():
            names = ", ".join(f"`{m}`" for m in POLICIES if same[m] == merge)
            first = runs[0]
            row = f"| {name} | {keys} | {names} | {first['cases']} | {first['files']} | {first['bytes'] / 1000:.0f} |"
            row += "".join(f" {median(runs, what):.0f} |" for what in ("compile", "pipelines", "frame"))
            if merge == "none":
                row += " 1 | 1 | 1 | 1 |"
            else:
                row += f" {runs[0]['bytes'] / by_policy['none'][0]['bytes']:.2f} |"
                for what in ("compile", "pipelines", "frame"):
                    row += f" {spread(ratios(runs, by_policy['none'], what))} |"
            print(row)


def print_means(results):
    print("| over `none`, geometric mean of the scenes (least to most) | SPIR-V | compile | pipelines | frame |")
    print("|---|---|---|---|---|")
    for merge in POLICIES[1:]:
        row = f"| `{merge}` |"
        for what in ("bytes", "compile", "pipelines", "frame"):
            each = []
            for _, by_policy, same in results.values():
                each += [statistics.median(ratios(by_policy[same[merge]], by_policy["none"], what))]
            row += f" {geometric_mean(each):.2f} ({min(each):.2f} to {max(each):.2f}) |"
        print(row)


def print_switches(results):
    print("| scene | keys | switch | cases | SPIR-V of the switch, kB | pipelines, s | first image, s | frame, ms |", end="")
    print(" SPIR-V × `none` | pipelines × | first image × | frame × |")
    print("|---|" + "---|" * 11)
    for (name, keys), switches in results.items():
        for switch, runs in switches.items():
            cases = runs[0]["cases"]
            row = f"| {name} | {keys} | {switch} | {cases} | {runs[0]['switch'] / 1000:.0f} |"
            base = switches["`none`"]
            size = f" {runs[0]['switch'] / base[0]['switch']:.2f} |"
            if "pipelines" not in runs[0]:
                print(row + f" more than {PATIENCE_S} | | |" + size + " | | |")
                continue
            row += f" {median(runs, 'pipelines') / 1000:.2f} | {median(runs, 'first') / 1000:.2f} |"
            row += f" {median(runs, 'frame'):.1f} |" + size
            for what in ("pipelines", "first", "frame"):
                row += f" {spread(ratios(runs, base, what))} |"
            print(row)


# ---- What is measured


def measure_scenes(measurer, scenes, runs, minutes):
    """Rounds over all scenes, those of few keys first, until the time is up. Also the names of those left out."""
    results, alike = {}, []
    for scene in scenes:
        keys, plans = measurer.plan(scene)
        if keys < 2:
            alike.append(scene.stem)
            continue
        same = {merge: next(m for m in POLICIES if plans[m] == plans[merge]) for merge in POLICIES}
        results[scene] = keys, {merge: [] for merge in POLICIES if same[merge] == merge}, same
    begin = time.monotonic()
    for made in range(runs):
        for scene, (_, by_policy, _) in sorted(results.items(), key=lambda item: item[1][0]):
            if time.monotonic() - begin > 60 * minutes:
                break
            for merge, found in by_policy.items():
                package = measurer.work / "package"
                found.append(measurer.compile(scene, merge, "visibility", package))
                found[-1].update(measurer.render(scene, "visibility", package))
            print(f"round {made + 1}: {scene.stem}", file=sys.stderr, flush=True)
    late = [scene.stem for scene, (_, by_policy, _) in results.items() if not by_policy["none"]]
    measured = {scene.stem: result for scene, result in results.items() if scene.stem not in late}
    return measured, alike, late


def make_naive(package, inlined):
    """Puts the switch as glslang leaves it into a package of --merge none."""
    naive = package / "naive.spv"
    command = ["glslangValidator", "-V", "--target-env", "vulkan1.2", package / "glsl/uber.comp", "-o", naive]
    subprocess.run(command, check=True, capture_output=True)
    if inlined:
        passes = ["--merge-return", "--inline-entry-points-exhaustive", "--eliminate-dead-functions"]
        subprocess.run(["spirv-opt", *passes, naive, "-o", naive], check=True, capture_output=True)
    replace(package, "uber.spv", naive)


def measure_switches(measurer, scenes, minutes):
    results = {}
    begin = time.monotonic()
    for scene in scenes:
        if time.monotonic() - begin > 60 * minutes:
            break
        keys, _ = measurer.plan(scene)
        names = ["`none`", "`family`", "`auto`", "naive"] + ["naive, inlined"] * (keys <= MOST_INLINED_KEYS)
        packages, made, switches = {}, {}, {name: [] for name in names}
        for switch in names:
            package = packages[switch] = measurer.work / f"switch-{len(packages)}"
            if "naive" in switch:
                shutil.rmtree(package, ignore_errors=True)
                shutil.copytree(packages["`none`"], package)
                make_naive(package, "inlined" in switch)
                made[switch] = dict(made["`none`"])
            else:
                made[switch] = measurer.compile(scene, switch.strip("`"), "uber", package)
            made[switch]["switch"] = (package / "uber.spv").stat().st_size
        for _ in range(SWITCH_RUNS):
            for switch, runs in switches.items():
                if runs and runs[-1].get("pipelines", LONG_MS) >= LONG_MS:
                    continue
                runs.append(dict(made[switch]))
                try:
                    runs[-1].update(measurer.render(scene, "uber", packages[switch]))
                except subprocess.TimeoutExpired:
                    print(f"{scene.stem}, {switch}: given up", file=sys.stderr)
        results[scene.stem, keys] = switches
        print(f"{scene.stem}: switches", file=sys.stderr, flush=True)
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--glint", required=True)
    parser.add_argument("--work", required=True, type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=2)
    parser.add_argument("--minutes", type=float, default=4, help="after these no further scene starts, nor switch")
    parser.add_argument("--switches-only", action="store_true", help="only the naive switch beside Glint's")
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    begin = time.monotonic()
    make_synthetic(arguments.work / "synthetic.gltf")
    measurer = Measurer(arguments.glint, arguments.work)
    switched = [scene for scene in arguments.scenes if scene.stem in SWITCH_SCENES]
    if not arguments.switches_only:
        results, alike, late = measure_scenes(measurer, arguments.scenes, arguments.runs, arguments.minutes)
        print_scenes(results)
        print(f"\nOne key, so that every policy makes the same: {', '.join(alike) or 'none'}.\n")
        if late:
            print(f"Not reached in {arguments.minutes:g} minutes (--minutes of measure_merge.py): {', '.join(late)}.\n")
        print_means(results)
        print(flush=True)
    switched.sort(key=lambda scene: SWITCH_SCENES.index(scene.stem))
    print_switches(measure_switches(measurer, switched, arguments.minutes))
    seconds = time.monotonic() - begin
    rounds = f"{arguments.runs} rounds at most, {SWITCH_RUNS} of the switches"
    print(f"\nMedians of {rounds}; {seconds:.0f} s in all.")


if __name__ == "__main__":
    main()
