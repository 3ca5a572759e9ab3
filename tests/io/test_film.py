"""Reading films that follow docs/reference/film.md."""

import json
import struct
import zlib

import numpy as np
import pytest
from helpers import film_files

from snowshed import InputError
from snowshed.io.film import Film


@pytest.fixture
def file(tmp_path):
    return tmp_path / "film.bin"


@pytest.mark.parametrize("axes", ["xz", "xyz"])
def test_a_film_is_read_as_documented(file, axes):
    frames = film_files.falling_film(axes=axes)
    file.write_bytes(film_files.film_bytes(frames, axes=axes))
    film = Film(file)
    assert film.dimension == len(axes) and film.whole and film.interval == 0.02
    assert [entry.particles for entry in film.frames] == [len(frame[2]) for frame in frames]
    for result, (time, event, ids, events, positions, codes) in zip(film, frames):
        assert (result.time, result.event) == (time, event)
        assert np.array_equal(result.ids, ids) and np.array_equal(result.events, events)
        expected = np.zeros((len(ids), 3))
        expected[:, [0, 2] if axes == "xz" else [0, 1, 2]] = positions * film.quantum
        assert np.array_equal(result.positions, expected)
        assert np.array_equal(result.codes, codes)


def test_particles_that_appear_and_vanish_keep_their_positions(file):
    """The list of particles changes in every frame, as it may in a slide."""
    random = np.random.default_rng(4)
    frames = []
    for number in range(12):
        ids = np.flatnonzero(random.random(60) < 0.7)
        positions = (ids[:, None] * [5, -7, 11] + np.multiply(number, [3, 1, -2])).astype(int)
        frames.append((0.1 * number, 1, ids, 1 + ids % 3, positions, ids[:, None] - number))
    file.write_bytes(film_files.film_bytes(frames))
    for result, frame in zip(Film(file), frames):
        assert np.array_equal(result.positions, frame[4] * 2.0**-10)
        assert np.array_equal(result.codes, frame[5]) and np.array_equal(result.events, frame[3])


def test_values_are_exact_to_a_step_or_to_one_percent(file):
    file.write_bytes(film_files.film_bytes(film_files.falling_film(20, 4)))
    quantity = Film(file).quantities[0]
    for value in (0.0, 0.004, 0.3, 25.0, -140.0):
        code = round(64 * np.arcsinh(value / (64 * quantity.step)))
        assert quantity.values(np.array([code]))[0] == pytest.approx(value, abs=0.006, rel=0.009)


@pytest.mark.parametrize("version", [1, 2])
def test_a_truncated_film_keeps_its_complete_frames_with_a_note(file, version):
    frames = film_files.falling_film(20, 4)
    content = film_files.film_bytes(frames, version=version)
    ends = [len(film_files.film_bytes(frames[:count], version=version)) for count in range(5)]
    for length in range(ends[0], len(content)):
        file.write_bytes(content[:length])
        film = Film(file)
        assert len(film.frames) == sum(end <= length for end in ends[1:])
        assert film.whole == (length in ends) and not film.closed and film.notes
    assert len(list(film)) == 3


def test_a_complete_film_is_closed_and_has_no_notes(file):
    frames = film_files.falling_film(20, 4)
    file.write_bytes(film_files.film_bytes(frames, closed=True))
    film = Film(file)
    assert film.whole and film.closed and film.notes == [] and len(list(film)) == 4
    file.write_bytes(film_files.film_bytes(frames, closed=True) + b"F")
    with pytest.raises(InputError, match="something follows its end"):
        Film(file)


def test_missing_repeated_and_moved_frames_are_refused(file):
    frames = film_files.falling_film(20, 5)
    ends = [len(film_files.film_bytes(frames[:count])) for count in range(6)]
    content = film_files.film_bytes(frames, closed=True)
    head, *pieces = [content[a:b] for a, b in zip([0, *ends], [*ends, len(content)])]
    for order in ([0, 2, 3, 4, 5], [0, 1, 1, 2, 3, 4, 5], [0, 2, 1, 3, 4, 5], [0, 1, 2, 3, 5]):
        file.write_bytes(head + b"".join(pieces[k] for k in order))
        with pytest.raises(InputError, match=r"film\.bin, byte \d+: damaged"):
            Film(file)


@pytest.mark.parametrize("version", [1, 2])
def test_a_film_with_a_changed_bit_is_refused_or_noted_as_truncated(file, version):
    frames = film_files.falling_film(10, 3, axes="xz")
    content = film_files.film_bytes(frames, axes="xz", version=version, closed=version == 2)
    start = len(film_files.film_bytes([], axes="xz", version=version))
    for at in range(len(content)):
        damaged = bytearray(content)
        damaged[at] ^= 1 << at % 8
        file.write_bytes(damaged)
        try:
            film = Film(file)
        except InputError as error:
            assert str(file) in str(error)
            continue
        # In version 1, the length of the last frame may show that the frame is incomplete.
        assert version == 1 and at > start and not film.whole and film.notes


def test_no_damaged_film_is_shown(file):
    """Every damage is an error."""
    frames = film_files.falling_film(40, 6)
    content = film_files.film_bytes(frames, closed=True)
    random = np.random.default_rng(7)
    for _ in range(400):
        damaged = bytearray(content)
        for at in random.integers(0, len(content), random.integers(1, 4)):
            damaged[at] = random.integers(0, 256)
        file.write_bytes(damaged)
        if damaged == content:
            continue
        with pytest.raises(InputError, match=r"film\.bin"):
            list(Film(file))


def forged(raw=b"\0" * 40, **fields):
    """Return a film of a single frame with any content and a correct checksum."""
    valid = {"time": 0.0, "event": 1, "lists": 1, "particles": 5}
    head = film_files.header()
    header_sum = struct.unpack_from("<I", head, 16)[0]
    return head + film_files.record(raw, previous=header_sum, **{**valid, **fields})


@pytest.mark.parametrize(
    "content",
    [
        forged(particles=4_000_000_000),
        forged(raw=b""),
        forged(lists=0),
        forged(time=float("nan")),
        forged(raw=b"\xff" * 60),
        forged(raw=b"\1" + b"\0" * 40),
        film_files.header(axes="yx"),
        film_files.header(quantum=0.0),
        film_files.header(share=7.0),
        film_files.header(quantities=[{"name": "speed"}]),
        film_files.header(quantities=[{**film_files.SPEED, "step": -1.0}]),
        b"SNOWFILM" + struct.pack("<IIII", 1, 4_000_000_000, 0, 0),
        b"SNOWFILM" + struct.pack("<IIII", 9, 0, 0, 0),
        b"SNOWFILM" + struct.pack("<IIII", 1, 2, zlib.crc32(b"[]"), 0) + b"[]",
        b"no film at all, but long enough to be one",
        b"",
    ],
)
def test_forged_films_are_refused(file, content):
    file.write_bytes(content)
    with pytest.raises(InputError, match=r"film\.bin"):
        list(Film(file))


def test_impossible_sizes_are_refused_before_memory_is_allocated(file):
    packed = zlib.compress(b"\0" * 100)
    head = struct.pack("<dIIIIII", 0.0, 1, 1, 10, 1 << 30, len(packed), 0)
    record = struct.pack("<II", 0x4D415246, zlib.crc32(head + packed)) + head + packed
    file.write_bytes(film_files.header(version=1) + record)
    with pytest.raises(InputError, match="sizes of a frame"):
        Film(file)


def test_the_header_is_json(file):
    text = film_files.header(share=0.25)[24:]
    assert json.loads(text)["share"] == 0.25
    file.write_bytes(film_files.header(share=0.25))
    assert Film(file).share == 0.25 and Film(file).frames == ()
