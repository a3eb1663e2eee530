#!/usr/bin/env python3
"""Makes the KTX2 files of this folder with basisu (Debian's package gpu-basis-universal, 2.0.2-4): make.py [BASISU]

areas: 16 x 8 pixels, four areas of one colour each. steps: 16 x 16 pixels, each mip of another colour, so that it shows
whether a reader takes the mips of the file.
"""
import struct
import subprocess
import sys
import zlib

AREAS = [[(200, 24, 24), (24, 160, 40)], [(32, 48, 208), (240, 232, 224)]]
STEPS = [(224, 0, 0), (0, 224, 0), (0, 0, 224), (224, 224, 0), (0, 224, 224)]


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def write_png(path, width, height, pixel_at):
    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in pixel_at(x, y)) for y in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_dds(path, size, colors):
    """RGBA of 8 bits, a colour a mip; the only input of basisu that brings its own mips."""
    header = struct.pack("<IIIIIII44x", 124, 0x2100F, size, size, 4 * size, 0, len(colors))
    header += struct.pack("<IIIIIIII", 32, 0x41, 0, 32, 0xFF, 0xFF00, 0xFF0000, 0xFF000000)
    header += struct.pack("<IIIII", 0x401008, 0, 0, 0, 0)
    pixels = b"".join(bytes((*color, 255)) * max(size >> mip, 1) ** 2 for mip, color in enumerate(colors))
    with open(path, "wb") as file:
        file.write(b"DDS " + header + pixels)


def main():
    basisu = sys.argv[1] if len(sys.argv) > 1 else "basisu"
    write_png("areas.png", 16, 8, lambda x, y: (*AREAS[y // 4][x // 8], 255))
    write_png("areas_alpha.png", 16, 8, lambda x, y: (*AREAS[y // 4][x // 8], 255 if x < 8 else 96))
    write_dds("steps.dds", 16, STEPS)
    for name, source, options in [
            ("etc1s", "areas.png", ["-etc1s"]),
            ("etc1s_alpha_mips", "areas_alpha.png", ["-etc1s", "-mipmap"]),
            ("etc1s_steps", "steps.dds", ["-etc1s"]),
            ("uastc_linear", "areas.png", ["-uastc", "-linear", "-ktx2_no_zstandard"]),
            ("uastc_zstd_steps", "steps.dds", ["-uastc"]),
            ("uastc_alpha_zstd", "areas_alpha.png", ["-uastc"]),
            ("uastc_hdr", "areas.png", ["-hdr"]),
    ]:
        subprocess.run([basisu, *options, source, "-output_file", name + ".ktx2"], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
