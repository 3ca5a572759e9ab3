"""Random changes to files, by a seed: bits, bytes, pieces, numbers and words."""

from __future__ import annotations

import random
import re

NUMBER = re.compile(rb"[0-9]+(?:\.[0-9]*)?")
NUMBERS = (
    *(b"-1", b"0", b"nan", b"inf", b"1e999", b"1_000", b"9" * 400, b"0x10", b"1e-400", b"1.5"),
    *(b"4294967297", b"18446744073709551616", "\u0661".encode(), b"", b"true", b"[]"),
)
WORDS = (
    *(b"\x00", b"\xff\xfe", b"\x1b[31m", b"\xc2\x9b", b"'", b'"', b"\n", b"\r", b",", b"{", b"]"),
    *(b"../", b"/dev/zero", b"[" * 2000, b"=1+1", b"#", b".a" * 200, b" " * 5000, b"%s", b"null"),
)


def mutated(content: bytes, seed: int) -> bytes:
    """Return the content with one to four changes."""
    chance = random.Random(seed)
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        content = chance.choice(CHANGES)(content, chance)
    return content


def _flip(content: bytes, chance: random.Random) -> bytes:
    if not content:
        return b"x"
    at = chance.randrange(len(content))
    return content[:at] + bytes([content[at] ^ (1 << chance.randrange(8))]) + content[at + 1 :]


def _overwrite(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    size = chance.choice((1, 2, 4, 8))
    filler = chance.choice((b"\x00" * size, b"\xff" * size, chance.randbytes(size)))
    return content[:at] + filler + content[at + size :]


def _cut(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    return content[:at] if chance.random() < 0.5 else content[:at] + content[at + _some(chance) :]


def _repeat(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    piece = content[at : at + _some(chance)]
    return content[:at] + piece * chance.choice((2, 3, 20)) + content[at + len(piece) :]


def _insert(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    return content[:at] + chance.choice(WORDS) + content[at:]


def _digit(content: bytes, chance: random.Random) -> bytes:
    """Change a digit; the result is often a valid file with another content."""
    digits = [at for at, byte in enumerate(content[:100_000]) if 0x30 <= byte <= 0x39]
    if not digits:
        return _flip(content, chance)
    at = chance.choice(digits)
    return content[:at] + b"%d" % chance.randrange(10) + content[at + 1 :]


def _number(content: bytes, chance: random.Random) -> bytes:
    numbers = list(NUMBER.finditer(content))
    if not numbers:
        return _flip(content, chance)
    number = chance.choice(numbers)
    return content[: number.start()] + chance.choice(NUMBERS) + content[number.end() :]


def _some(chance: random.Random) -> int:
    return chance.choice((1, 3, 10, 40, 200))


CHANGES = (_flip, _overwrite, _cut, _repeat, _insert, _number, _digit, _digit)
