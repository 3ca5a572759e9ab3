"""The interface is whole, and starting stays quick."""

import re
import subprocess
import sys

import pytest
from made_up_rows import few_inputs, made_up_rows, write_table
from paths import ROOT

import snowshed.analysis.regression

DOCS = (ROOT / "docs" / "regression.md").read_text()


def test_every_public_name_is_there():
    for name in snowshed.analysis.regression.__all__:
        assert getattr(snowshed.analysis.regression, name).__doc__
    with pytest.raises(AttributeError, match="no attribute 'x'"):
        _ = snowshed.analysis.regression.x


def test_the_command_line_starts_without_what_regression_needs():
    script = "import sys, snowshed.cli.main; print({'sklearn', 'scipy'} & set(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "set()"


def test_every_option_is_in_the_docs():
    from snowshed.cli.commands.regression import geometry, predict, regress

    for command in (geometry, regress, predict):
        for option in command.params:
            if option.opts[0].startswith("--"):
                assert re.search(rf"`{option.opts[0]}[ `]", DOCS), option.opts[0]


def test_the_script_in_the_docs(tmp_path, monkeypatch, capsys):
    (script,) = re.findall(r"^```python\n(.*?)^```", DOCS, re.MULTILINE | re.DOTALL)
    write_table(made_up_rows(few_inputs()), tmp_path / "rows.csv")
    monkeypatch.chdir(tmp_path)
    exec(script.replace('models=["rbf"]', 'models=["linear"], targets=["ratio"]'), {})
    shown = capsys.readouterr().out
    assert "held_out_error" in shown and "spread" in shown
