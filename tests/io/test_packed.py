"""Packed files, pipes, and lines that need too much memory or time."""

import gzip
import lzma
import os
import re
import resource
import subprocess
import sys
import threading

import pytest

from snowshed import InputError
from snowshed.base.limits import MAX_LINE_BYTES, MAX_MEMBERS, MAX_TEXT_BYTES, MB
from snowshed.io import read_station
from snowshed.io.csv_table import read_csv, read_text_table
from snowshed.io.input_file import read_input
from snowshed.io.packed import unpacked

TABLE = b"date,snowfall_m,temperature_c\n2024-01-01,0.1,-3\n"


def xz(content, **options):
    return lzma.compress(content, **options)


@pytest.mark.parametrize("pack", [gzip.compress, xz])
def test_members_of_packed_files_are_joined(pack, tmp_path):
    half = len(TABLE) // 2
    for packed in (
        pack(TABLE),
        pack(TABLE[:half]) + pack(TABLE[half:]),
        pack(TABLE) + b"\0" * 512,
        pack(b"") * 3 + pack(TABLE),
        b"".join(pack(TABLE[n : n + 1]) for n in range(len(TABLE))),
    ):
        assert unpacked(packed, tmp_path / "a") == TABLE


def test_packed_files_larger_than_the_buffer_are_read(tmp_path):
    noise = os.urandom(300_000)
    for pack in (gzip.compress, xz):
        assert unpacked(pack(noise), tmp_path / "a") == noise
        assert unpacked(pack(noise) + pack(b"0" * 5 * MB), tmp_path / "a") == noise + b"0" * 5 * MB


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            gzip.compress(b"") * (MAX_MEMBERS + 1),
            f"more than {MAX_MEMBERS} gzip members; unpack it first",
        ),
        (xz(b"") * (MAX_MEMBERS + 1), f"more than {MAX_MEMBERS} xz members"),
        (gzip.compress(b"0" * (MAX_TEXT_BYTES + 1), 1), "longer than 64 MB when unpacked"),
        (xz(b"0" * (MAX_TEXT_BYTES + 1), preset=0), "longer than 64 MB when unpacked"),
        (gzip.compress(TABLE)[:-9], "damaged: gzip: it ends too early"),
        (xz(TABLE)[:-9], "damaged: xz: it ends too early"),
        (gzip.compress(TABLE) + b"more", "damaged: gzip"),
        (xz(TABLE)[:30] + b"\xff" * 40, "damaged: xz"),
        (b"BZh91AY", "packed with bzip2; unpack it"),
        (b"7z\xbc\xaf\x27\x1c...", "a 7z archive; unpack it"),
        (b"\x28\xb5\x2f\xfd...", "packed with zstd; unpack it"),
        (b"PK\x03\x04...", "a zip archive; unpack it"),
        (b"\0" * (1 << 20), "line 1: not text: it contains NUL bytes"),
        ("date,snowfall_m\n".encode("utf-16"), "text in UTF-16; save it in UTF-8"),
        (b"date,snowfall_m,temperature_c" + b",x" * 500_000, "line 1: longer than 64 KB"),
        (b"\n" * 1_000_002, "more than 1000000 lines"),
        (b"\r" * 1_000_002, "more than 1000000 lines"),
        (b"SMET 1.1 ASCII\n[HEADER]\nfields = timestamp TA\n[DATA]\n" + b"1 " * 500_000,
         "line 5: longer than 64 KB"),
    ],
    ids=lambda value: value[:24] if isinstance(value, str) else "",
)  # fmt: skip
def test_excessive_weather_files_are_refused(content, message, tmp_path):
    (tmp_path / "a").write_bytes(content)
    with pytest.raises(InputError, match=re.escape(message)):
        read_station(tmp_path / "a")


def test_a_dictionary_larger_than_the_limit_is_refused(tmp_path):
    filters = [{"id": lzma.FILTER_LZMA2, "preset": 0, "dict_size": 1 << 28}]
    packed = lzma.compress(TABLE, format=lzma.FORMAT_XZ, filters=filters)
    with pytest.raises(InputError, match="damaged: xz: Memory usage limit"):
        unpacked(packed, tmp_path / "a")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"a,b\n" + b"1," * MAX_LINE_BYTES, "line 2: not a table: a row longer than 1 MB"),
        (b"a" + b",a" * MAX_LINE_BYTES, "line 1: not a table: a row longer than 1 MB"),
        (b'a,b\n"' + b"\n" * 2 * MAX_LINE_BYTES, "not a table"),
        (b'a,b\n"' + (b"x" * 9999 + b"\n") * 200, "not a table"),
        (b"a,b\n" + b'"\n",' * MAX_LINE_BYTES, "not a table: a row longer than 1 MB"),
        (b"a,b\n1,\0\n", "line 2: not a table: it contains NUL bytes"),
        (b"a" + b",a" * 2000, "2001 columns; at most 1000"),
        (b"a,b\n" + b"1,2\n" * 300_002, "not a table: more than 300000 rows"),
    ],
)
def test_excessive_tables_are_refused(content, message, tmp_path):
    (tmp_path / "a").write_bytes(content)
    with pytest.raises(InputError, match=re.escape(message)):
        list(read_text_table(tmp_path / "a", "", lambda *_: None).rows)


def test_a_packed_table_is_read(tmp_path):
    (tmp_path / "a").write_bytes(gzip.compress(TABLE))
    assert read_text_table(tmp_path / "a", "", lambda *_: None).rows[0].cells["snowfall_m"] == "0.1"
    assert read_csv(tmp_path / "a")["snowfall_m"].tolist() == [0.1]


LINES = 'a,b\r\n"x\r\ny",1\r"",2\n3,4'


def test_line_ends_of_other_systems_are_read(tmp_path):
    (tmp_path / "a").write_bytes(LINES.encode())
    table = read_text_table(tmp_path / "a", "", lambda *_: None)
    assert [tuple(row.cells.values()) for row in table.rows] == [("x\r\ny", "1"), ("", "2"),
                                                                  ("3", "4")]  # fmt: skip
    assert [row.number for row in table.rows] == [2, 4, 5]


def test_a_pipe_without_a_writer_ends(tmp_path, monkeypatch):
    monkeypatch.setattr("snowshed.io.input_file.MAX_PIPE_SILENCE_S", 0.05)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match=r"pipe: a pipe or a device without a writer"):
        read_input(tmp_path / "pipe")
    with pytest.raises(InputError, match="without a writer"):
        read_station(tmp_path / "pipe")


def test_a_pipe_with_a_writer_is_read(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    content = os.urandom(3 * MB)
    writer = threading.Thread(target=(tmp_path / "pipe").write_bytes, args=(content,))
    writer.start()
    assert read_input(tmp_path / "pipe") == content
    writer.join()


def test_files_beyond_the_limit_are_not_read(tmp_path):
    with (tmp_path / "sparse").open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(InputError, match="sparse: longer than 64 MB"):
        read_input(tmp_path / "sparse")


@pytest.mark.parametrize(
    "arguments",
    [
        ["season", "pipe", "--dim", "2", "--height", "1", "--length", "1", "--tilt", "40"],
        ["clearance", "pipe", "--slope-length", "2", "--tilt", "60"],
        ["study", "run", "pipe"],
    ],
)
def test_commands_refuse_a_silent_pipe(arguments, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    code = [sys.executable, "-m", "snowshed", *arguments, "-o", "out"]
    done = subprocess.run(code, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2 and "without a writer" in done.stderr
    assert not (tmp_path / "out").exists()


def test_ten_million_columns_fit_into_little_memory(tmp_path):
    (tmp_path / "wide.csv").write_bytes(b"date,snowfall_m,temperature_c" + b",x" * 10_000_000)
    code = "import sys; from snowshed.season import read_season; read_season(sys.argv[1])"

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

    command = [sys.executable, "-c", code, "wide.csv"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=120, preexec_fn=limit
    )
    assert "InputError: wide.csv, line 1: longer than 64 KB" in done.stderr
