"""Image files: writes Radiance and PNG, reads the OpenEXR files that `glint render` writes."""
import struct
import zlib

import numpy as np


def write_hdr(path, radiance):
    """Writes radiance (height, width, 3) as a Radiance file without run lengths."""
    largest = np.maximum(radiance.max(axis=2), 1e-30)
    exponent = np.floor(np.log2(largest)).astype(int) + 1
    mantissa = np.floor(radiance / np.exp2(exponent)[..., None] * 256).clip(0, 255)
    pixels = np.concatenate([mantissa, exponent[..., None] + 128], axis=2).astype(np.uint8)
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {radiance.shape[0]} +X {radiance.shape[1]}\n"
    path.write_bytes(header.encode() + pixels.tobytes())


def png_bytes(pixels):
    """8-bit RGB pixels (height, width, 3) as a PNG file."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    height, width = pixels.shape[:2]
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.astype(np.uint8).reshape(height, -1)], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) +
            chunk(b"IEND", b""))


def read_exr(path):
    """Reads red, green and blue of an OpenEXR file of 32-bit floats with ZIP compression, as (height, width, 3)."""
    data = path.read_bytes()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path}: is no OpenEXR file")
    attributes, position = {}, 8
    while data[position]:
        name, kind, rest = data[position:position + 600].split(b"\0", 2)
        position += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, position)[0]
        attributes[name.decode()] = data[position + 4:position + 4 + size]
        position += 4 + size
    channels, text = [], attributes["channels"]
    while text[0]:
        name, text = text.split(b"\0", 1)
        if struct.unpack_from("<i", text)[0] != 2:
            raise ValueError(f"{path}: channel {name.decode()} has no 32-bit floats")
        channels.append(name.decode())
        text = text[16:]
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    rows_of_block = {0: 1, 2: 1, 3: 16}.get(attributes["compression"][0])
    if rows_of_block is None:
        raise ValueError(f"{path}: has a compression other than ZIP")
    image = np.empty((height, len(channels), width), "<f4")
    offsets = struct.unpack_from(f"<{-(-height // rows_of_block)}Q", data, position + 1)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        rows = image[y - top:y - top + rows_of_block]
        block = data[offset + 8:offset + 8 + size]
        if size < rows.nbytes:
            block = unpack_zip(block)
        rows[:] = np.frombuffer(block, "<f4").reshape(rows.shape)
    return np.stack([image[:, channels.index(name)] for name in "RGB"], axis=2)


def unpack_zip(block):
    """Inflates a block and undoes the differences and the order of its bytes (OpenEXR, "ZIP compression")."""
    differences = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    differences[1:] -= 128
    values = (np.cumsum(differences) & 255).astype(np.uint8)
    half = (len(values) + 1) // 2
    result = np.empty(len(values), np.uint8)
    result[0::2] = values[:half]
    result[1::2] = values[half:]
    return result.tobytes()
