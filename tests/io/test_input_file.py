"""Endless files as arguments of commands and in other files."""

import subprocess
import sys

import pytest

from snowshed import InputError
from snowshed.analysis.regression import load_model
from snowshed.io.film import Film
from snowshed.io.vtk.vtp import read_particles
from snowshed.study import Study

ENDLESS = "/dev/zero"


@pytest.mark.parametrize(
    ("arguments", "limit"),
    [
        (["run", ENDLESS], 64),
        (["study", "run", ENDLESS], 64),
        (["study", "run", "study.toml"], 64),
        (["regress", ENDLESS], 256),
        (["season", ENDLESS, "--dim", "2", "--height", "1", "--length", "1", "--tilt", "40"], 64),
    ],
)
def test_endless_files_are_refused(arguments, limit, tmp_path):
    (tmp_path / "study.toml").write_text(f'name = "a"\n[scene]\nfile = "{ENDLESS}"\n')
    code = [sys.executable, "-m", "snowshed", *arguments, "-o", "out"]
    done = subprocess.run(code, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2, done.stderr
    assert f"{ENDLESS}: longer than {limit} MB" in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("read", [load_model, read_particles, Study.load, Film])
def test_the_error_of_an_endless_file_names_it_once(tmp_path, read):
    (tmp_path / "zero").symlink_to("/dev/zero")
    with pytest.raises(InputError) as refused:
        read(tmp_path / "zero")
    assert str(refused.value).count(str(tmp_path)) == 1
