"""Reads files of `glint bench --calibrate` for the scripts that use several."""
import json
import sys


def merged(paths):
    """Returns one calibration with the points of all, which must be of one device. Its command lists the command of each."""
    reports = [json.loads(path.read_text(encoding="utf-8")) for path in paths]
    whole = reports[0]
    for path, report in zip(paths[1:], reports[1:]):
        for member in ("device", "driver", "tracers"):
            if report["machine"][member] != whole["machine"][member]:
                sys.exit(f"{path}: its {member} is not that of {paths[0]}: give calibrations of one device")
        whole["points"] += report["points"]
        whole["command"] += "; " + report["command"]
    if not whole["points"]:
        sys.exit(f"{', '.join(map(str, paths))}: no points")
    return whole
