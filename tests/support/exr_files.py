"""Reads the EXR files that lightgrid writes, without any library."""
import pathlib
import struct
import zlib


def read_exr(path):
    """(width, height, {channel: rows}) of a scanline EXR with float channels, uncompressed or with ZIP."""
    data = pathlib.Path(path).read_bytes()
    at, header = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        header[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names, channels = [], header["channels"]
    while channels[0]:
        name, channels = channels.split(b"\0", 1)
        assert struct.unpack_from("<i", channels)[0] == 2, "not a float channel"
        names.append(name.decode())
        channels = channels[16:]
    compression = header["compression"][0]
    rows_in_block = {0: 1, 2: 1, 3: 16}[compression]
    planes = {name: [None] * height for name in names}
    for block in range((height + rows_in_block - 1) // rows_in_block):
        offset = struct.unpack_from("<Q", data, at + 8 * block)[0]
        y, size = struct.unpack_from("<2i", data, offset)
        rows = min(rows_in_block, height - (y - y0))
        raw, bytes_ = data[offset + 8:offset + 8 + size], 4 * width * len(names) * rows
        if compression and size < bytes_:
            raw = unpredicted(zlib.decompress(raw))
        for row in range(rows):
            for c, name in enumerate(names):
                planes[name][y - y0 + row] = struct.unpack_from(f"<{width}f", raw, 4 * width * (row * len(names) + c))
    return width, height, planes


def unpredicted(deltas):
    """OpenEXR stores differences of bytes, and even and odd bytes apart."""
    out = bytearray(deltas)
    for i in range(1, len(out)):
        out[i] = (out[i - 1] + out[i] - 128) & 255
    half = (len(out) + 1) // 2
    joined = bytearray(len(out))
    joined[0::2], joined[1::2] = out[:half], out[half:]
    return bytes(joined)
