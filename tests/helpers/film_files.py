"""Films written after docs/reference/film.md, without code of snowshed."""

import json
import struct
import zlib

import numpy as np

FRAM, ENDS = 0x4D415246, 0x53444E45
SPEED = {"name": "speed", "unit": "m/s", "meaning": "Speed", "step": 0.01}


def varints(numbers):
    """Return the LEB128 bytes of unsigned integers."""
    values = np.asarray(numbers, dtype=np.int64) & 0xFFFFFFFF
    columns = [(values >> (7 * k)) & 127 for k in range(5)]
    length = np.ones(len(values), dtype=int)
    for k in range(1, 5):
        length[values >> (7 * k) > 0] = k + 1
    table = np.stack(columns, axis=1).astype(np.uint8)
    at = np.arange(5)
    table |= np.where(at < length[:, None] - 1, 128, 0).astype(np.uint8)
    return table[at < length[:, None]].tobytes()


def zigzag(numbers):
    """Return the zigzag encoding: small magnitudes become small unsigned numbers."""
    wide = np.asarray(numbers, dtype=np.int64)
    return (wide << 1) ^ (wide >> 63)


def differences(numbers):
    """Return the bytes of numbers, each stored as its difference from the previous number."""
    return varints(zigzag(np.diff(numbers, prepend=0)))


def record(raw, *, time, event, lists, particles, previous=None):
    """Return a frame's bytes; `previous` is the checksum of what precedes it (None: version 1)."""
    packed = zlib.compress(raw, 1)
    facts = (time, event, lists, particles, len(raw), len(packed))
    if previous is None:
        head = struct.pack("<dIIIIII", *facts, 0)
        return struct.pack("<II", FRAM, zlib.crc32(head + packed)) + head + packed
    head = struct.pack("<dIIIIII", *facts, zlib.crc32(packed))
    return struct.pack("<II", FRAM, zlib.crc32(head, previous)) + head + packed


def close(time, event, frames, previous):
    """Return the bytes that end a film."""
    head = struct.pack("<dIIIIII", time, event, 0, frames, 0, 0, 0)
    return struct.pack("<II", ENDS, zlib.crc32(head, previous)) + head


def checksum(head):
    """Return the checksum at the beginning of a frame."""
    return struct.unpack_from("<I", head, 4)[0]


def header(
    axes="xyz", quantum=2.0**-10, interval=0.02, share=1.0, quantities=(SPEED,), version=2, **others
):
    """Return the bytes before the first frame."""
    facts = {"axes": axes, "quantum_m": quantum, "interval_s": interval, "share": share}
    facts = {**facts, "radius": False, "quantities": list(quantities), **others}
    text = json.dumps(facts).encode()
    fixed = b"SNOWFILM" + struct.pack("<II", version, len(text))
    return fixed + struct.pack("<II", zlib.crc32(text, header_sum(version, fixed)), 0) + text


def header_sum(version, fixed):
    """Return the checksum of the bytes before the text; version 1 has none."""
    return 0 if version == 1 else zlib.crc32(fixed)


def film_bytes(frames, *, closed=False, **facts):
    """Return a film of frames (time, event, ids, events, positions (n, axes), codes (n, q))."""
    out = [header(**facts)]
    version = facts.get("version", 2)
    summed = None if version == 1 else struct.unpack_from("<I", out[0], 16)[0]
    old_ids, old_positions, old_step, old_codes = np.zeros(0, dtype=int), None, None, None
    for time, event, ids, events, positions, codes in frames:
        raw = b""
        lists = not np.array_equal(ids, old_ids)
        if lists:
            raw += varints(np.diff(ids, prepend=0))
            raw += differences(events) + differences(np.zeros(len(ids), dtype=int))
        at = {number: k for k, number in enumerate(old_ids)} if lists else None
        old_index = (
            np.array([at.get(number, -1) for number in ids]) if lists else np.arange(len(ids))
        )
        new_step = np.zeros_like(positions)
        for axis in range(positions.shape[1]):
            expected = np.concatenate([[0], positions[:-1, axis]])
            old = old_index >= 0
            if old_positions is not None:
                expected[old] = (old_positions + old_step)[old_index[old], axis]
                new_step[old, axis] = positions[old, axis] - old_positions[old_index[old], axis]
            raw += varints(zigzag(positions[:, axis] - expected))
        for quantity in range(codes.shape[1]):
            expected = np.concatenate([[0], codes[:-1, quantity]])
            if old_codes is not None:
                expected[old_index >= 0] = old_codes[old_index[old_index >= 0], quantity]
            raw += varints(zigzag(codes[:, quantity] - expected))
        fields = {"time": time, "event": event, "lists": lists, "particles": len(ids)}
        out.append(record(raw, previous=summed, **fields))
        summed = None if version == 1 else checksum(out[-1])
        old_ids, old_positions, old_step, old_codes = ids, positions, new_step, codes
    if closed:
        out.append(close(frames[-1][0], frames[-1][1], len(frames), summed))
    return b"".join(out)


def as_version_1(content):
    """Return a film of version 2 in version 1."""
    (length,) = struct.unpack_from("<I", content, 12)
    text = content[24 : 24 + length]
    out = [b"SNOWFILM" + struct.pack("<IIII", 1, length, zlib.crc32(text), 0) + text]
    at = 24 + length
    while at < len(content) and struct.unpack_from("<I", content, at)[0] == FRAM:
        end = at + 40 + struct.unpack_from("<I", content, at + 32)[0]
        frame = content[at + 8 : at + 36] + bytes(4) + content[at + 40 : end]
        out.append(struct.pack("<II", FRAM, zlib.crc32(frame)) + frame)
        at = end
    return b"".join(out)


def falling_film(particles=200, frames=12, axes="xyz", seed=1, **facts):
    """Return the frames of two events, in which snow falls and the ground stops it."""
    random = np.random.default_rng(seed)
    quantum = facts.get("quantum", 2.0**-10)
    half = particles // 2
    start = random.uniform([-0.5, -0.3, 1.0], [0.5, 0.3, 1.6], (particles, 3))
    film = []
    for number in range(frames):
        event = 1 + (number >= frames // 2)
        count = half if event == 1 else particles
        born = np.where(np.arange(count) < half, 0, frames // 2)
        age = 0.05 * (number - born)
        x = start[:count].copy()
        x[:, 0] += 0.4 * age
        x[:, 2] = np.maximum(x[:, 2] - 4.9 * age**2, 0.02 * random.random(count))
        positions = np.round(x / quantum).astype(int)[:, [0, 2] if axes == "xz" else [0, 1, 2]]
        speed = np.where(x[:, 2] > 0.02, 9.81 * age, 0.0)
        codes = np.round(64 * np.arcsinh(speed / 0.64)).astype(int)[:, None]
        events = np.where(born > 0, 2, 1)
        film.append(
            (0.05 * (number - (event == 2)), event, np.arange(count), events, positions, codes)
        )
    return film
