"""The public interface of studies, and the examples of its guide."""

import re

import pytest
from helpers.paths import ROOT

import snowshed.study
from snowshed.study import Study
from snowshed.study.database import TABLES

DOCS = (ROOT / "docs" / "guides" / "studies.md").read_text()
TABLES_PAGE = (ROOT / "docs" / "reference" / "study-table.md").read_text()


def test_every_public_name_is_documented():
    for name in snowshed.study.__all__:
        assert getattr(snowshed.study, name).__doc__


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", DOCS, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize(("block", "runs"), list(zip(blocks("toml"), (18, 64, 122))))
def test_study_files_in_the_docs(tmp_path, block, runs):
    (tmp_path / "study.toml").write_text(block)
    assert len(Study.load(tmp_path / "study.toml").runs()) == runs


@pytest.mark.parametrize("block", [b for b in blocks("python") if "SLURM" not in b])
def test_scripts_in_the_docs(tmp_path, monkeypatch, capsys, block):
    monkeypatch.chdir(tmp_path)
    exec(block.replace('.run("results")', '.run("results", jobs=1)'), {})
    output = capsys.readouterr().out
    assert "panel.tilt" in output


def test_the_docs_describe_the_tables_of_the_store():
    for table in TABLES:
        if name := re.match(r"CREATE TABLE (?:IF NOT EXISTS )?(\w+)", table):
            assert f"| `{name[1]}` |" in TABLES_PAGE
