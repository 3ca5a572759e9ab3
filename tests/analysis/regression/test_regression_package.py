"""The script in the docs."""

import re

from helpers.paths import ROOT
from synthetic_rows import few_inputs, synthetic_rows, write_table

DOCS = (ROOT / "docs" / "guides" / "prediction.md").read_text(encoding="utf-8")


def test_the_script_in_the_docs(tmp_path, monkeypatch, capsys):
    (script,) = re.findall(r"^```python\n(.*?)^```", DOCS, re.MULTILINE | re.DOTALL)
    write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    monkeypatch.chdir(tmp_path)
    exec(script.replace('models=["rbf"]', 'models=["linear"], targets=["ratio"]'), {})
    shown = capsys.readouterr().out
    assert "held_out_error" in shown and "spread" in shown
