"""Films written by hand, as docs/view.md describes them: no code of snowshed."""

import json
import struct
import zlib

import numpy as np

SPEED = {"name": "speed", "unit": "m/s", "meaning": "Speed", "step": 0.01}


def varints(numbers):
    """Return numbers of seven bits a byte, the lowest first."""
    left = np.asarray(numbers, dtype=np.int64) & 0xFFFFFFFF
    columns = [(left >> (7 * k)) & 127 for k in range(5)]
    length = np.ones(len(left), dtype=int)
    for k in range(1, 5):
        length[left >> (7 * k) > 0] = k + 1
    table = np.stack(columns, axis=1).astype(np.uint8)
    at = np.arange(5)
    table |= np.where(at < length[:, None] - 1, 128, 0).astype(np.uint8)
    return table[at < length[:, None]].tobytes()


def zigzag(numbers):
    """Return signed numbers as unsigned ones, small ones small."""
    wide = np.asarray(numbers, dtype=np.int64)
    return (wide << 1) ^ (wide >> 63)


def differences(numbers):
    """Return the bytes of numbers, each as its difference to the one before."""
    return varints(zigzag(np.diff(numbers, prepend=0)))


def record(raw, *, time, event, lists, particles):
    """Return the bytes of a frame."""
    packed = zlib.compress(raw, 1)
    head = struct.pack("<dIIIIII", time, event, lists, particles, len(raw), len(packed), 0)
    return struct.pack("<II", 0x4D415246, zlib.crc32(head + packed)) + head + packed


def header(axes="xyz", quantum=2.0**-10, interval=0.02, share=1.0, quantities=(SPEED,), **others):
    """Return the bytes before the first frame."""
    facts = {"axes": axes, "quantum_m": quantum, "interval_s": interval, "share": share}
    facts = {**facts, "radius": False, "quantities": list(quantities), **others}
    text = json.dumps(facts).encode()
    return b"SNOWFILM" + struct.pack("<IIII", 1, len(text), zlib.crc32(text), 0) + text


def film_bytes(frames, **facts):
    """Return a film of frames (time, event, ids, events, places (n, axes), codes (n, q))."""
    out = [header(**facts)]
    known, place, step, code = np.zeros(0, dtype=int), None, None, None
    for time, event, ids, events, places, codes in frames:
        raw = b""
        lists = not np.array_equal(ids, known)
        if lists:
            raw += varints(np.diff(ids, prepend=0))
            raw += differences(events) + differences(np.zeros(len(ids), dtype=int))
        at = {one: k for k, one in enumerate(known)} if lists else None
        before = np.array([at.get(one, -1) for one in ids]) if lists else np.arange(len(ids))
        new_step = np.zeros_like(places)
        for axis in range(places.shape[1]):
            expected = np.concatenate([[0], places[:-1, axis]])
            old = before >= 0
            if place is not None:
                expected[old] = (place + step)[before[old], axis]
                new_step[old, axis] = places[old, axis] - place[before[old], axis]
            raw += varints(zigzag(places[:, axis] - expected))
        for which in range(codes.shape[1]):
            expected = np.concatenate([[0], codes[:-1, which]])
            if code is not None:
                expected[before >= 0] = code[before[before >= 0], which]
            raw += varints(zigzag(codes[:, which] - expected))
        out.append(record(raw, time=time, event=event, lists=lists, particles=len(ids)))
        known, place, step, code = ids, places, new_step, codes
    return b"".join(out)


def falling_film(particles=200, frames=12, axes="xyz", seed=1, **facts):
    """Return the frames of snow that falls and is stopped by the ground, two events of it."""
    random = np.random.default_rng(seed)
    quantum = facts.get("quantum", 2.0**-10)
    half = particles // 2
    start = random.uniform([-0.5, -0.3, 1.0], [0.5, 0.3, 1.6], (particles, 3))
    made = []
    for number in range(frames):
        event = 1 + (number >= frames // 2)
        count = half if event == 1 else particles
        born = np.where(np.arange(count) < half, 0, frames // 2)
        age = 0.05 * (number - born)
        x = start[:count].copy()
        x[:, 0] += 0.4 * age
        x[:, 2] = np.maximum(x[:, 2] - 4.9 * age**2, 0.02 * random.random(count))
        places = np.round(x / quantum).astype(int)[:, [0, 2] if axes == "xz" else [0, 1, 2]]
        speed = np.where(x[:, 2] > 0.02, 9.81 * age, 0.0)
        codes = np.round(64 * np.arcsinh(speed / 0.64)).astype(int)[:, None]
        events = np.where(born > 0, 2, 1)
        made.append(
            (0.05 * (number - (event == 2)), event, np.arange(count), events, places, codes)
        )
    return made
