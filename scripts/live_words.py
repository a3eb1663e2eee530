#!/usr/bin/env python3
"""Counts the 32-bit words that a SPIR-V module keeps, at its peak and while rays are traced, and its loads from memory.

    scripts/live_words.py [--values] PACKAGE/*.spv

A value is live between its definition and its last use, in the order of the module. Drivers order instructions anew, but
their registers follow these numbers: RADV's and ANV's are 0.8 to 0.95 times the peak. Addresses into the frame's
constants count two words each, although they are the same for all threads. `--values` lists what is live at both
places. Loads are those through addresses of buffers, as the module has them; those of one word are counted apart,
because Adreno's driver reads each by itself. It needs spirv-dis of SPIRV-Tools.
"""
import argparse
import collections
import pathlib
import re
import subprocess

Instruction = collections.namedtuple("Instruction", "result opcode operands text")
TERMINATORS = {"OpBranch": 0, "OpBranchConditional": 1, "OpSwitch": 1}
MERGES = ("OpLoopMerge", "OpSelectionMerge")


class Module:
    """The blocks of a module, and the size of each value in words."""

    def __init__(self, path):
        text = subprocess.run(["spirv-dis", "--raw-id", "--no-color", path], capture_output=True, text=True, check=True)
        self.sizes, self.constants, self.types = {}, {}, {}
        self.addresses = set()  # types of pointers to the memory of buffers
        self.blocks = {}  # label: instructions
        block = None
        for line in map(str.strip, text.stdout.splitlines()):
            match = re.match(r"(?:(%\d+) = )?(Op\w+)(.*)", line)
            if not match:
                continue
            result, opcode, rest = match.groups()
            operands = re.findall(r"%\d+", re.sub(r'"[^"]*"', "", rest))
            if opcode == "OpLabel":
                block = self.blocks.setdefault(result, [])
            elif opcode in ("OpFunction", "OpFunctionParameter", "OpFunctionEnd"):
                block = None
            elif block is None:
                self.read_global(result, opcode, operands, rest.split())
            else:
                if result:
                    self.types[result] = operands.pop(0)
                if opcode not in ("OpLine", "OpNoLine"):
                    block.append(Instruction(result, opcode, operands, line))
        self.kept = {
            instruction.result
            for instructions in self.blocks.values()
            for instruction in instructions
            if instruction.result and instruction.opcode not in ("OpVariable", "OpUndef")
        }

    def read_global(self, result, opcode, operands, words):
        if opcode in ("OpTypeInt", "OpTypeFloat"):
            self.sizes[result] = int(words[0]) / 32
        elif opcode == "OpTypeVector":
            self.sizes[result] = self.sizes.get(operands[0], 0) * int(words[1])  # truth values take none
        elif opcode == "OpTypePointer":
            self.sizes[result] = 2 if words[0] == "PhysicalStorageBuffer" else 0
            if words[0] == "PhysicalStorageBuffer":
                self.addresses.add(result)
        elif opcode == "OpTypeForwardPointer":
            self.sizes[operands[0]] = 2
        elif opcode == "OpTypeArray":
            self.sizes[result] = self.sizes.get(operands[0], 0) * self.constants.get(operands[1], 1)
        elif opcode == "OpTypeStruct":
            self.sizes[result] = sum(self.sizes.get(member, 0) for member in operands)
        elif opcode == "OpConstant" and words[1].isdigit():
            self.constants[result] = int(words[1])

    def words(self, values):
        return round(sum(self.sizes.get(self.types[value], 0) for value in values))

    def loads(self):
        """The words of each load from the memory of buffers."""
        return [
            self.words([instruction.result])
            for instructions in self.blocks.values()
            for instruction in instructions
            if instruction.opcode == "OpLoad" and self.types.get(instruction.operands[0]) in self.addresses
        ]

    def uses(self, instruction):
        """What an instruction reads where it stands; a phi reads at the end of the blocks before it."""
        if instruction.opcode == "OpPhi" or instruction.opcode in MERGES:
            return set()
        return self.kept.intersection(instruction.operands)

    def live_at_ends(self):
        """{label: values that are live at the end of the block}"""
        read_by_phis = collections.defaultdict(set)
        for instructions in self.blocks.values():
            for phi in (it for it in instructions if it.opcode == "OpPhi"):
                for value, label in zip(phi.operands[::2], phi.operands[1::2]):
                    read_by_phis[label].update(self.kept.intersection([value]))
        begins = {label: set() for label in self.blocks}
        ends = {}
        changed = True
        while changed:
            changed = False
            for label, instructions in reversed(self.blocks.items()):
                last = instructions[-1]
                successors = last.operands[TERMINATORS[last.opcode]:] if last.opcode in TERMINATORS else []
                live = read_by_phis[label].union(*(begins[successor] for successor in successors))
                ends[label] = set(live)
                for instruction in reversed(instructions):
                    live.discard(instruction.result)
                    live |= self.uses(instruction)
                changed = changed or live != begins[label]
                begins[label] = live
        return ends

    def points(self):
        """The values that are live behind each instruction."""
        for label, live in self.live_at_ends().items():
            for instruction in reversed(self.blocks[label]):
                yield instruction, frozenset(live)
                live.discard(instruction.result)
                live |= self.uses(instruction)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--values", action="store_true", help="list what is live")
    parser.add_argument("modules", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    for path in arguments.modules:
        module = Module(path)
        points = list(module.points())
        peak = max(points, key=lambda point: module.words(point[1]))
        traces = [point for point in points if point[0].opcode == "OpRayQueryProceedKHR"]
        over = ", ".join(str(module.words(live)) for _, live in traces) or "-"
        loads = module.loads()
        print(
            f"{path.name}: {module.words(peak[1])} at the peak, {over} while rays are traced; "
            f"{sum(words <= 1 for words in loads)} of {len(loads)} loads have one word"
        )
        if arguments.values:
            texts = {it.result: it.text for block in module.blocks.values() for it in block}
            for instruction, live in [peak, *traces]:
                print(f"  behind {instruction.text}")
                for value in sorted(live, key=lambda it: int(it[1:])):
                    print(f"    {module.words([value])}  {texts[value]}")


if __name__ == "__main__":
    main()
