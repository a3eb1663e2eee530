#!/usr/bin/env python3
"""Measures the window: frames a second, the time to the first picture, and memory over many frames.

    benchmarks/view/measure.py SCENE [--program FILE] [--size WxH] [--runs N] [--frames N] [--only rate,start,memory]
                               [--options WORDS]

Everything runs in an Xvfb of its own, with caches of its own: GLINT_CACHE and MESA_SHADER_CACHE_DIR are folders that
are made for it. WORDS are further options of glint view. Prints Markdown.

rate     samples a second while the picture accumulates, over the last 32 of 64 samples: without the panel, with it,
         and while the chart of passes waits for each pass
start    wall clock from the start of the process to the first sample on the device, with both caches empty, and with
         the caches that the runs before have filled; medians with least and greatest values. Beside it is the
         processor time of the whole run, which draws one sample and ends
memory   resident memory and the device's memory early and after --frames frames of 64x36 pixels, in which the camera
         orbits, the window changes its size, the panel comes and goes, and a setting changes
"""
import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Screen:
    """An X server without a screen."""

    def __enter__(self):
        read, write = os.pipe()
        os.set_inheritable(write, True)
        self.process = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x1000x24", "-nolisten",
                                         "tcp"], pass_fds=[write], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(write)
        text = b""
        while not text.endswith(b"\n"):
            part = os.read(read, 16)
            if not part:
                raise SystemExit("no Xvfb (scripts/setup.sh --window installs it)")
            text += part
        self.display = ":" + text.decode().strip()
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()


class Window:
    def __init__(self, arguments, display, folder):
        self.arguments = arguments
        self.display = display
        self.folder = folder

    def run(self, script, more, caches):
        """Runs a script. Returns the seconds until the first sample, and the process's processor time in seconds."""
        (self.folder / "script").write_text(script)
        environment = dict(os.environ, DISPLAY=self.display, GLINT_CACHE=str(caches / "glint"),
                           MESA_SHADER_CACHE_DIR=str(caches / "mesa"))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.monotonic()
        process = subprocess.Popen([self.arguments.program, "script", "view", str(self.arguments.scene.resolve()),
                                    "--verbose"] + more + self.arguments.options.split(), cwd=self.folder, env=environment, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        first = None
        said = []
        for line in process.stdout:
            said.append(line)
            if first is None and "first sample" in line:
                first = time.monotonic() - start
        if process.wait() != 0:
            raise SystemExit("".join(said))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return first, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def report(self, name):
        return json.loads((self.folder / name).read_text())


def spread(values, digits=1):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def measure_rate(window, caches):
    size = ["--size", window.arguments.size, "--spp", "64"]
    again = "key Home\nwait complete\n"  # a new picture
    rows = {"without the panel": [], "with the panel": [], "with the tab Passes, which waits for each pass": []}
    for _ in range(window.arguments.runs):
        window.run(f"wait complete\n{again}report bare.json\nquit\n", size + ["--no-panel"], caches)
        window.run(f"wait complete\n{again}report panel.json\nclick tab Passes\nwait complete\nreport passes.json\n"
                   "quit\n", size, caches)
        for values, name in zip(rows.values(), ("bare", "panel", "passes")):
            values.append(window.report(f"{name}.json")["samplesPerSecond"])
    print("| frames a second, each with a sample | |\n|---|---|")
    for name, values in rows.items():
        print(f"| {name} | {spread(values)} |")


def measure_start(window, folder):
    size = ["--size", window.arguments.size, "--spp", "1"]
    script = "wait complete\nreport start.json\nquit\n"
    rows = {"both caches empty": [], "caches that an earlier run has filled": []}
    for run in range(window.arguments.runs):
        caches = folder / f"caches-{run}"
        for values in rows.values():
            values.append(window.run(script, size, caches))
    print("| start | first picture, s | processor time of the whole run, s |\n|---|---|---|")
    for name, values in rows.items():
        print(f"| {name} | {spread([first for first, _ in values], 2)} | {spread([cpu for _, cpu in values], 2)} |")


def measure_memory(window, caches):
    # Each round has 1,000 frames. Samples never end, so that each frame draws one.
    lap = """
        drag 20 20 44 26
        wait frames 400
        drag 44 26 20 20
        size 504 262
        key Tab
        wait frames 100
        number skip-below 0.1
        number skip-below 0
        key Tab
        size 64 62
        wait frames 400
    """
    laps = max(1, window.arguments.frames // 1000)
    script = f"wait frames 100\n{lap}"  # what is made once is there after it
    script += "".join(f"report {number}.json\n{lap}" for number in range(laps)) + f"report {laps}.json\nquit\n"
    size = ["--size", "64x36", "--no-panel"]
    window.run("wait complete\nquit\n", size + ["--spp", "1"], caches)  # fills the caches
    window.run(script, size + ["--spp", "65536"], caches)
    print("| frames | samples | resident, KiB | renderer, KiB | scene, KiB |\n|---|---|---|---|---|")
    for number in range(laps + 1):
        report = window.report(f"{number}.json")
        sizes = " | ".join(f"{report[key] // 1024:,}" for key in ("residentBytes", "rendererBytes", "sceneBytes"))
        print(f"| {report['frames']:,} | {report['samplesDrawn']:,} | {sizes} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--program", default=str(ROOT / "build/release/tests/glint-view-script"))
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--frames", type=int, default=10000)
    parser.add_argument("--only", default="rate,start,memory")
    parser.add_argument("--options", default="")
    arguments = parser.parse_args()
    with Screen() as screen, tempfile.TemporaryDirectory() as folder:
        window = Window(arguments, screen.display, pathlib.Path(folder))
        caches = pathlib.Path(folder) / "caches"
        for what in arguments.only.split(","):
            if what == "rate":
                measure_rate(window, caches)
            elif what == "start":
                measure_start(window, pathlib.Path(folder))
            elif what == "memory":
                measure_memory(window, caches)
            else:
                raise SystemExit(f"--only takes rate, start and memory, not {what}")


if __name__ == "__main__":
    main()
