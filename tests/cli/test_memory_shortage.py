"""Messages of the command line after a shortage of memory."""

import pytest

from snowshed.cli.main import main
from snowshed.io import csv_table
from snowshed.io.csv_table import read_csv


def test_a_file_that_needs_too_much_memory_is_named(tmp_path, monkeypatch, capsys):
    file = tmp_path / "table.csv"
    file.write_text("hash,event\n")

    def exhausted(*_):
        raise MemoryError

    monkeypatch.setattr(csv_table, "_records", exhausted)
    with pytest.raises(MemoryError):
        read_csv(file)
    assert main(["regress", str(file), "-o", str(tmp_path / "out")]) == 3
    message = capsys.readouterr().err
    assert message.startswith(f"error: out of memory while {file} was read")
    assert "particles" not in message


def test_a_run_that_needs_too_much_memory_gets_advice(tmp_path, monkeypatch, capsys):
    from snowshed.running import run as running

    def exhausted(*_, **__):
        raise MemoryError

    monkeypatch.setattr(running, "open_sequence", exhausted)
    out = str(tmp_path / "out")
    assert main(["panel", "--preset", "lab-50", "--dim", "2", "-q", "-o", out]) == 3
    assert "fewer particles or a larger dx" in capsys.readouterr().err
