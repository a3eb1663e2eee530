#!/usr/bin/env python3
"""Runs the commands of README.md as a reader would paste them, and compares what they print with what stands there.

usage: scripts/readme.py [--only cheap|built|all] [--update] [--folder DIR] [README.md]

A block of commands is fenced as sh, and the block fenced as text right after it is what it prints. The blocks run from
top to bottom in one shell, in the folder DIR (default: the repository). A comment before a block of commands says more:

  <!-- once -->  it installs or builds, and is run with --only all, the default
  <!-- gpu -->   it takes hours without a GPU, and is not run
  <!-- slow -->  it takes more than some seconds, and is run with --only built and all

In what is printed, times (12.3 ms, 4 s) may differ, and so may the width of gaps. A line of three dots stands for any
number of lines, and three dots within a line for any text. --update writes what was printed into README.md, where it
differs and has no dots. Prints each block's name and wall clock. Exits 1 if a command fails or prints something else.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"(?:<!-- (?P<mark>\w+) -->\n)?```sh\n(?P<commands>.*?)```\n(?:\n```text\n(?P<prints>.*?)```\n)?", re.S)
TIME = re.compile(r"\d[\d,.]*(?= ?(?:ms|s|min)\b)")
DOTS = "…"


def simplify(line):
    return re.sub(r"\s+", " ", TIME.sub("#", line)).strip()


def pattern(expected):
    """Returns a regular expression for the simplified lines of a block, each of which ends with a line feed."""
    text = ""
    for line in expected.splitlines():
        if line.strip() == DOTS:
            text += r"(?:.*\n)*?"
        else:
            text += ".*".join(re.escape(part) for part in simplify(line).split(DOTS)) + r"\n"
    return re.compile(text)


def agrees(expected, printed):
    lines = "".join(simplify(line) + "\n" for line in printed.splitlines())
    return pattern(expected).fullmatch(lines) is not None


class Shell:
    """One bash, so that variables last from block to block."""

    def __init__(self, folder):
        self.process = subprocess.Popen(["bash"], cwd=folder, stdin=subprocess.PIPE, text=True)

    def run(self, commands):
        with tempfile.TemporaryDirectory() as work:
            done = pathlib.Path(work, "done")
            self.process.stdin.write(f"{{ set -e; {commands}\n set +e; }} >{work}/output 2>&1 </dev/null\n"
                                     f"echo $? >{done}.part; mv {done}.part {done}\n")
            self.process.stdin.flush()
            while not done.exists() and self.process.poll() is None:
                time.sleep(0.02)
            printed = pathlib.Path(work, "output").read_text(errors="replace")
            return done.exists() and done.read_text().strip() == "0", printed


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].removeprefix("usage: "))
    parser.add_argument("--only", choices=["cheap", "built", "all"], default="all")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT)
    parser.add_argument("readme", nargs="?", type=pathlib.Path, default=ROOT / "README.md")
    arguments = parser.parse_args()
    text = arguments.readme.read_text()
    shell = Shell(arguments.folder)
    failures = 0
    ran = 0
    for block in BLOCK.finditer(text):
        if block["mark"] in {"cheap": ("gpu", "once", "slow"), "built": ("gpu", "once"), "all": ("gpu",)}[arguments.only]:
            continue
        ran += 1
        start = time.monotonic()
        ok, printed = shell.run(block["commands"])
        name = block["commands"].strip().splitlines()[0]
        print(f"{time.monotonic() - start:8.1f} s  {name}", flush=True)
        if not ok:
            print(f"failed:\n{block['commands']}{printed}")
            return 1
        expected = block["prints"]
        if expected is None or agrees(expected, printed):
            continue
        if arguments.update and DOTS not in expected:
            text = text.replace(f"{block['commands']}```\n\n```text\n{expected}", f"{block['commands']}```\n\n```text\n{printed}")
            continue
        failures += 1
        print(f"README.md has\n{expected}but this was printed:\n{printed}")
    if arguments.update:
        arguments.readme.write_text(text)
    print(f"{ran} blocks ran, {failures} of them printed something else")
    return 1 if failures or ran == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
