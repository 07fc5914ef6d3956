"""Volumes by chunks, written from the formats' specifications with Python's own library alone."""
import gzip
import itertools
import json
import math
import os
import struct

SIZE = (26, 22, 20)  # along x, y, z
CHUNK = (8, 8, 8)
ISO = "100"


def sample(x, y, z):
    """A ball with a wave on it; no larger than a byte."""
    r = math.dist((x, y, z), (12.6, 10.4, 9.7))
    return max(0, min(255, round(180 - 14 * r + 9 * math.sin(0.7 * x) + 7 * math.cos(0.9 * y + 0.4 * z))))


def label(x, y, z):
    """Two labels, one of them beyond 32 bits, in a background of 0."""
    if sample(x, y, z) < 100:
        return 0
    return 7 if x < 13 else 0x1_0000_0005


def put(path, data):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


def put_json(path, value):
    put(path, json.dumps(value).encode())


def grid(size=SIZE, chunk=CHUNK):
    """The numbers of all chunks along x, y, z."""
    return itertools.product(*(range(-(-s // c)) for s, c in zip(size, chunk)))


def chunk_bytes(number, code, cut, value=sample, chunk=CHUNK):
    """The samples of a chunk, x fastest. Those behind the volume are 0, or left out where it is `cut`."""
    ranges = [range(n * c, min((n + 1) * c, s) if cut else (n + 1) * c) for n, c, s in zip(number, chunk, SIZE)]
    inside = lambda *at: all(a < s for a, s in zip(at, SIZE))
    values = [value(x, y, z) if inside(x, y, z) else 0 for z in ranges[2] for y in ranges[1] for x in ranges[0]]
    return struct.pack(f"{code[0]}{len(values)}{code[1]}", *values)


def put_zarr2(folder, chunk=CHUNK):
    put_json(f"{folder}/.zarray", {"zarr_format": 2, "shape": SIZE[::-1], "chunks": chunk[::-1], "dtype": "<u2",
                                   "order": "C", "fill_value": 0, "filters": None,
                                   "compressor": {"id": "gzip", "level": 5}})
    put_json(f"{folder}/.zattrs", {})
    for x, y, z in grid(chunk=chunk):
        put(f"{folder}/{z}.{y}.{x}", gzip.compress(chunk_bytes((x, y, z), "<H", False, chunk=chunk)))


def crc32c(data):
    table = []
    for n in range(256):
        for _ in range(8):
            n = n >> 1 ^ (0x82F63B78 if n & 1 else 0)
        table.append(n)
    crc = 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ table[(crc ^ byte) & 255]
    return crc ^ 0xFFFFFFFF


def put_zarr3(folder, shards=False):
    bytes_codec = {"name": "bytes", "configuration": {"endian": "little"}}
    codecs = [bytes_codec, {"name": "gzip", "configuration": {"level": 5}}]
    chunk = CHUNK
    if shards:
        chunk = tuple(2 * c for c in CHUNK)
        codecs = [{"name": "sharding_indexed",
                   "configuration": {"chunk_shape": CHUNK[::-1], "codecs": codecs, "index_location": "end",
                                     "index_codecs": [bytes_codec, {"name": "crc32c"}]}}]
    put_json(f"{folder}/zarr.json",
             {"zarr_format": 3, "node_type": "array", "shape": SIZE[::-1], "data_type": "uint16", "fill_value": 0,
              "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk[::-1]}},
              "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}}, "codecs": codecs})
    packed = lambda number: gzip.compress(chunk_bytes(number, "<H", False))
    if not shards:
        for x, y, z in grid():
            put(f"{folder}/c/{z}/{y}/{x}", packed((x, y, z)))
        return
    for sx, sy, sz in grid(chunk=chunk):
        data, index = b"", b""
        for z, y, x in itertools.product(range(2), repeat=3):
            number = (2 * sx + x, 2 * sy + y, 2 * sz + z)
            if any(n * c >= s for n, c, s in zip(number, CHUNK, SIZE)):
                index += struct.pack("<QQ", 2**64 - 1, 2**64 - 1)
                continue
            stored = packed(number)
            index += struct.pack("<QQ", len(data), len(stored))
            data += stored
        put(f"{folder}/c/{sz}/{sy}/{sx}", data + index + struct.pack("<I", crc32c(index)))


def put_n5(folder):
    put_json(f"{folder}/attributes.json", {"dimensions": SIZE, "blockSize": CHUNK, "dataType": "uint16",
                                           "compression": {"type": "gzip"}})
    for number in grid():
        cut = [min(c, s - n * c) for n, c, s in zip(number, CHUNK, SIZE)]
        head = struct.pack(">HHIII", 0, 3, *cut)
        put(f"{folder}/" + "/".join(map(str, number)), head + gzip.compress(chunk_bytes(number, ">H", True)))
