#!/usr/bin/env python3
"""Makes tool/plan/strategy_constants.h, the costs of strategies that Glint knows without a calibration.

    benchmarks/fit_strategy_costs.py [--check]
    benchmarks/fit_strategy_costs.py --points FOLDER/calibration.json... [--program PATH]

The first writes the header from the device files benchmarks/data/strategy_costs_cpu.json and benchmarks/data/strategy_costs_gpu.json,
those of them that there are; --check writes nothing and exits 1 where the header is not what they give. The second first
fits the device file of that type anew to what `glint bench --calibrate -o FOLDER` has measured, in one run or more, by the
same program code (glint_fit_strategies, which the build makes) as `glint bench --calibrate` does. The same files give the
same header, byte for byte.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import calibrations

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADER = ROOT / "tool/plan/strategy_constants.h"
PROGRAM = ROOT / "build/release/bin/glint_fit_strategies"
TYPES = ("gpu", "cpu")
TERMS = ["launchesMs", "casesMs", "raysNs", "incoherenceNs", "bucketsNs", "instructionsPs", "divergencePs", "codePs", "missesPs"]


def device_file(kind):
    return ROOT / f"benchmarks/data/strategy_costs_{kind}.json"


def fit(points, program):
    """Replaces the device file of the type that the points are of."""
    calibration = calibrations.merged(points)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "calibration.json"
        file.write_text(json.dumps(calibration), encoding="utf-8")
        subprocess.run([program, file, device_file(calibration["machine"]["deviceType"])], check=True)


def number(value):
    """Four digits: no constant is known better."""
    return f"{float(f'{value:.4g}')!r}"


def quoted(text):
    return json.dumps(text, ensure_ascii=False)


def percent(value):
    return f"{100 * value:.1f} %"


def comment(device):
    """What the fit is worth."""
    regret = device["regret"]
    lines = [f"{device['device']}, {device['driver']}"]
    for row in device["strategies"]:
        fitted = row["fit"]
        lines.append(
            f"    {row['strategy']:<12} {fitted['points']:>4} points, estimates off by {percent(fitted['medianError'])}"
            f" (median), {percent(fitted['worstError'])} at most"
        )
    how = "of constants fitted to other scenes" if regret["heldOut"] else "of constants fitted to the same points"
    lines.append(
        f"    what auto takes over the fastest, less 1, {how}: {percent(regret['median'])} (median),"
    )
    lines.append(
        f"    {percent(regret['worst'])} at most; within 5 % at {percent(regret['withinFivePercent'])} of {regret['points']} points"
    )
    return [f"// {line}" for line in lines]


def rows(device, name):
    lines = comment(device)
    lines.append(f"inline constexpr StrategyConstants {name}[] = {{")
    for row in device["strategies"]:
        values = ", ".join(number(row["constants"].get(term, 0.0)) for term in TERMS)
        lines.append(f"    {{{quoted(row['strategy'])}, {{{values}}}}},")
    return lines + ["};", ""]


def header():
    devices = [json.loads(device_file(kind).read_text(encoding="utf-8")) for kind in TYPES if device_file(kind).exists()]
    names = {"cpu": "kCpu", "gpu": "kGpu"}
    lines = [
        "// clang-format off",
        "// Made by benchmarks/fit_strategy_costs.py from benchmarks/data/strategy_costs_*.json; run it again rather than edit this.",
        "// Errors are of estimates by constants that were fitted to other scenes than the one that is estimated.",
        "#pragma once",
        "",
        '#include "plan/strategy_cost.h"',
        "",
        "#include <span>",
        "#include <string_view>",
        "",
        "namespace glint::compiler::fitted {",
        "",
        "struct StrategyConstants {",
        "    std::string_view strategy;",
        "    TermValues constants;  // in the units of costTerms()",
        "};",
        "",
        "// As DeviceCosts.",
        "struct DeviceRow {",
        "    std::string_view device;",
        "    std::string_view driver;",
        "    bool onCpu;",
        "    double subgroupSize;",
        "    std::string_view tracer;",
        "    std::string_view shadows;",
        "    std::string_view command;",
        "    std::span<const StrategyConstants> strategies;",
        "};",
        "",
    ]
    for device in devices:
        lines += rows(device, names[device["deviceType"]])
    lines.append("inline constexpr DeviceRow kDevices[] = {")
    for device in devices:
        lines.append(f"    {{{quoted(device['device'])}, {quoted(device['driver'])},")
        on_cpu = "true" if device["deviceType"] == "cpu" else "false"
        lines.append(
            f"     {on_cpu}, {number(device['subgroupSize'])}, {quoted(device['tracer'])}, {quoted(device['shadows'])},"
        )
        lines.append(f"     {quoted(device['command'])},")
        lines.append(f"     {names[device['deviceType']]}}},")
    lines += ["};", "", "}  // namespace glint::compiler::fitted", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--points", type=pathlib.Path, nargs="+")
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    arguments = parser.parse_args()
    if arguments.points:
        fit(arguments.points, arguments.program)
    text = header()
    if arguments.check:
        if HEADER.read_text(encoding="utf-8") != text:
            sys.exit("tool/plan/strategy_constants.h is not what the device files give: run benchmarks/fit_strategy_costs.py")
        return
    HEADER.write_text(text, encoding="utf-8")
    print(f"{HEADER.relative_to(ROOT)}: written")


if __name__ == "__main__":
    main()
