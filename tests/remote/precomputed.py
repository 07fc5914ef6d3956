"""neuroglancer's precomputed volumes, written from their specification with Python's own library alone."""
import gzip
import itertools
import struct

from volumes import CHUNK, SIZE, chunk_bytes, grid, put, put_json, sample

OFFSET = (-3, 100, 7)
BLOCK = (4, 4, 2)


def murmur3_x86_128(data, seed=0):
    """The general algorithm, for data of any length."""
    mask = 0xFFFFFFFF
    rotl = lambda x, r: (x << r | x >> 32 - r) & mask
    c = [0x239B961B, 0xAB0E9789, 0x38B34AE5, 0xA1E38B93]
    shift = [15, 16, 17, 18]
    h = [seed] * 4
    whole = len(data) // 16 * 16
    for at in range(0, whole, 16):
        k = struct.unpack_from("<4I", data, at)
        for n, (turn, add) in enumerate(((19, 0x561CCD1B), (17, 0x0BCAA747), (15, 0x96CD1C35), (13, 0x32AC3B17))):
            h[n] ^= rotl(k[n] * c[n] & mask, shift[n]) * c[(n + 1) % 4] & mask
            h[n] = (rotl(h[n], turn) + h[(n + 1) % 4]) * 5 + add & mask
    tail = data[whole:].ljust(16, b"\0")
    for n, word in enumerate(struct.unpack("<4I", tail)):
        h[n] ^= rotl(word * c[n] & mask, shift[n]) * c[(n + 1) % 4] & mask
    h = [x ^ len(data) for x in h]
    h[0] = sum(h) & mask
    h[1:] = [x + h[0] & mask for x in h[1:]]
    for n, x in enumerate(h):
        x = (x ^ x >> 16) * 0x85EBCA6B & mask
        x = (x ^ x >> 13) * 0xC2B2AE35 & mask
        h[n] = x ^ x >> 16
    h[0] = sum(h) & mask
    h[1:] = [x + h[0] & mask for x in h[1:]]
    return struct.pack("<4I", *h)


def compressed_segmentation(values, shape, kind):
    """One channel. Tables are shared by no blocks; kind: "I" or "Q" of struct."""
    words = 1 if kind == "I" else 2
    heads, body = [], b""
    numbers = [range(-(-s // b)) for s, b in zip(shape, BLOCK)]
    count = len(numbers[0]) * len(numbers[1]) * len(numbers[2])
    for bz, by, bx in itertools.product(*reversed(numbers)):
        at = lambda x, y, z: values[x + shape[0] * (y + shape[1] * z)]
        cells = [at(*(min(s - 1, n * b + i) for s, n, b, i in zip(shape, (bx, by, bz), BLOCK, (x, y, z))))
                 for z in range(BLOCK[2]) for y in range(BLOCK[1]) for x in range(BLOCK[0])]
        table = sorted(set(cells))
        bits = next(b for b in (0, 1, 2, 4, 8, 16, 32) if len(table) <= 1 << b)
        packed = [0] * (-(-len(cells) * bits // 32))
        for n, value in enumerate(cells):
            if bits:
                packed[n * bits // 32] |= table.index(value) << n * bits % 32
        begin = 2 * count + len(body) // 4
        heads += [begin + len(packed) | bits << 24, begin]
        body += struct.pack(f"<{len(packed)}I", *packed) + struct.pack(f"<{len(table)}{kind}", *table)
        assert len(body) % 4 == 0 and words
    return struct.pack("<I", 1) + struct.pack(f"<{len(heads)}I", *heads) + body


def encoded(number, encoding, kind, value):
    data = chunk_bytes(number, "<" + kind, True, value)
    if encoding == "raw":
        return data
    shape = [min(c, s - n * c) for n, c, s in zip(number, CHUNK, SIZE)]
    return compressed_segmentation(struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data), shape, kind)


def morton(number):
    code, place = 0, 0
    counts = [-(-s // c) for s, c in zip(SIZE, CHUNK)]
    for bit in range(21):
        for n, count in zip(number, counts):
            if 1 << bit < count:
                code |= (n >> bit & 1) << place
                place += 1
    return code


def put_shards(folder, chunks, sharding):
    """chunks: data by their numbers."""
    shards = {}
    for code, data in sorted(chunks.items()):
        wanted = code >> sharding["preshift_bits"]
        if sharding["hash"] != "identity":
            wanted = struct.unpack("<Q", murmur3_x86_128(struct.pack("<Q", wanted))[:8])[0]
        minishard = wanted & (1 << sharding["minishard_bits"]) - 1
        shard = wanted >> sharding["minishard_bits"] & (1 << sharding["shard_bits"]) - 1
        packed = gzip.compress(data) if sharding["data_encoding"] == "gzip" else data
        shards.setdefault(shard, {}).setdefault(minishard, []).append((code, packed))
    for shard, minishards in shards.items():
        body, index = b"", b""
        for minishard in range(1 << sharding["minishard_bits"]):
            codes, gaps, sizes, last_code, last_end = [], [], [], 0, 0
            for code, data in minishards.get(minishard, []):
                body += b"gap"  # between chunks
                codes.append(code - last_code)
                gaps.append(len(body) - last_end)
                sizes.append(len(data))
                body += data
                last_code, last_end = code, len(body)
            listed = struct.pack(f"<{3 * len(codes)}Q", *codes, *gaps, *sizes)
            if codes and sharding["minishard_index_encoding"] == "gzip":
                listed = gzip.compress(listed)
            index += struct.pack("<QQ", len(body), len(body) + len(listed))
            body += listed
        digits = -(-sharding["shard_bits"] // 4)
        put(f"{folder}/{shard:0{digits}x}.shard", index + body)


def put_precomputed(folder, encoding="raw", kind="H", packed=False, sharding=None, value=sample):
    """packed: files in gzip, with names that say so."""
    scale = {"key": "8_8_40", "size": SIZE, "resolution": [8, 8, 40], "voxel_offset": OFFSET, "chunk_sizes": [CHUNK],
             "encoding": encoding}
    if encoding != "raw":
        scale["compressed_segmentation_block_size"] = BLOCK
    if sharding:
        scale["sharding"] = {"@type": "neuroglancer_uint64_sharded_v1", **sharding}
    types = {"B": "uint8", "H": "uint16", "I": "uint32", "Q": "uint64"}
    put_json(f"{folder}/info", {"@type": "neuroglancer_multiscale_volume", "type": "image", "data_type": types[kind],
                                "num_channels": 1, "scales": [scale]})
    if sharding:
        chunks = {morton(number): encoded(number, encoding, kind, value) for number in grid()}
        return put_shards(f"{folder}/8_8_40", chunks, sharding)
    for number in grid():
        box = [(o + n * c, o + min(s, (n + 1) * c)) for o, n, c, s in zip(OFFSET, number, CHUNK, SIZE)]
        name = f"{folder}/8_8_40/" + "_".join(f"{a}-{b}" for a, b in box)
        data = encoded(number, encoding, kind, value)
        put(name + (".gz" if packed else ""), gzip.compress(data) if packed else data)
    return None
