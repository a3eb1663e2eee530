#!/usr/bin/env python3
"""Computes the theoretical occupancy of the pipelines in a file of glint render --stats FILE --pipeline-statistics, as Markdown.

  benchmarks/occupancy.py STATS.json [THREADS]     THREADS: of a workgroup, default 64

For NVIDIA GPUs of compute capability 9.0 (Hopper), where the driver says how many registers a thread has. The limits are those of
the CUDA C++ Programming Guide, "Technical Specifications per Compute Capability": 65,536 registers, 64 warps (2,048 threads) and
32 workgroups a multiprocessor, 255 registers a thread. Registers are given to warps 256 at a time, by each of the four
schedulers from its quarter (CUDA occupancy calculator). Shared memory is left out of account. The driver decides
how the shaders of a ray tracing pipeline are launched, so their number is what registers alone would allow.
"""
import json
import sys

REGISTERS = 65536
WARPS = 64
WORKGROUPS = 32
SCHEDULERS = 4
UNIT = 256
WARP = 32


def warps_resident(registers, threads):
    """Warps of a multiprocessor, by registers a thread and threads a workgroup."""
    a_warp = -(-registers * WARP // UNIT) * UNIT
    by_registers = SCHEDULERS * (REGISTERS // SCHEDULERS // a_warp) if a_warp else WARPS
    warps_a_workgroup = -(-threads // WARP)
    workgroups = min(WORKGROUPS, min(by_registers, WARPS) // warps_a_workgroup)
    return workgroups * warps_a_workgroup


def registers_of(executable):
    """Registers a thread, or None where the driver does not say, or says it in more than one number."""
    found = [s["value"] for s in executable["statistics"]
             if "register" in s["name"].lower() and "spill" not in s["name"].lower()]
    return found[0] if len(found) == 1 else None


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    threads = int(sys.argv[2]) if len(sys.argv) == 3 else 64
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    if report.get("pipelineStatistics") is None:
        sys.exit("occupancy.py: the file has no statistics: render with --pipeline-statistics, on a device that has them")
    print(f"{report['device']}, {report['driver']}; workgroups of {threads} threads\n")
    print("| pipeline | executable | registers | warps of 64 | occupancy |\n|---|---|---|---|---|")
    for pipeline in report["pipelineStatistics"]:
        for executable in pipeline["executables"]:
            registers = registers_of(executable)
            if registers is None:
                continue
            warps = warps_resident(registers, threads)
            print(f"| {pipeline['name']} | {executable['name']} | {registers} | {warps} | {100 * warps // WARPS} % |")


if __name__ == "__main__":
    main()
