#!/usr/bin/env python3
"""Puts other SPIR-V in the place of a package's module, so that `glint render --package` runs it. Needs python3-xxhash.

This is for measurements alone. A package states the length and the hash of each module, and the loader refuses any
other. The new module must have the bindings and push constants of the old one. The manifest is not changed.

    benchmarks/replace_module.py PACKAGE MODULE.spv OTHER.spv     MODULE.spv: a file of the package

The layout of tables.bin is that of runtime/include/glint/internal/package_format.h.
"""
import pathlib
import struct
import sys

import xxhash

VERSION = 15  # of package_format.h; with another one, look whether the numbers below still hold
HEADER_BYTES = 152
CONTENT_HASH = slice(24, 32)
SECTION = struct.Struct("<IIQQ")  # kind, bytes of an element, offset, number of elements
MODULE = struct.Struct("<IIIIIIQQ")  # role, index, tracer, pad, offset and length of the file's name, bytes, hash
KIND_MODULES, KIND_STRINGS = 1, 6


def replace(package, name, other):
    tables = bytearray((package / "tables.bin").read_bytes())
    magic, version, count = struct.unpack_from("<8sII", tables)
    sections = {}
    for i in range(count):
        kind, size, offset, elements = SECTION.unpack_from(tables, HEADER_BYTES + i * SECTION.size)
        sections[kind] = (size, offset, elements)
    size, offset, elements = sections[KIND_MODULES]
    if not magic.startswith(b"GLINT") or version != VERSION or size != MODULE.size:
        sys.exit(f"replace_module.py: {package} has another format than this script knows")
    code, found = other.read_bytes(), 0
    for i in range(elements):
        place = offset + i * size
        entry = list(MODULE.unpack_from(tables, place))
        start = sections[KIND_STRINGS][1] + entry[4]
        if tables[start : start + entry[5]].decode() == name:
            entry[6:8] = len(code), xxhash.xxh3_64_intdigest(code)
            MODULE.pack_into(tables, place, *entry)
            found += 1
    if not found:
        sys.exit(f"replace_module.py: {package} has no module {name}")
    tables[CONTENT_HASH] = bytes(8)
    seed = xxhash.xxh3_64_intdigest(bytes(tables[:HEADER_BYTES]))
    digest = xxhash.xxh3_64_intdigest(bytes(tables[HEADER_BYTES:]), seed=seed)
    tables[CONTENT_HASH] = struct.pack("<Q", digest)
    (package / "tables.bin").write_bytes(tables)
    (package / name).write_bytes(code)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: benchmarks/replace_module.py PACKAGE MODULE.spv OTHER.spv")
    replace(pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3]))
