"""Files without end, wherever a command or another file names them."""

import subprocess
import sys

import pytest

ENDLESS = "/dev/zero"


@pytest.mark.parametrize(
    ("arguments", "limit"),
    [
        (["run", ENDLESS], 64),
        (["study", "run", ENDLESS], 64),
        (["study", "run", "study.toml"], 64),
        (["regress", ENDLESS], 1024),
        (["season", ENDLESS, "--dim", "2", "--height", "1", "--length", "1", "--tilt", "40"], 64),
    ],
)
def test_files_without_end_are_refused(arguments, limit, tmp_path):
    (tmp_path / "study.toml").write_text(f'name = "a"\n[scene]\nfile = "{ENDLESS}"\n')
    code = [sys.executable, "-m", "snowshed", *arguments, "-o", "out"]
    done = subprocess.run(code, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2, done.stderr
    assert f"{ENDLESS}: longer than {limit} MB" in done.stderr
    assert not (tmp_path / "out").exists()
