"""The interface is whole, and the docs name every option."""

import re
import subprocess
import sys

import pytest
from paths import ROOT

import snowshed.analysis.sensitivity

DOCS = ROOT / "docs" / "sensitivity.md"


def test_every_public_name_is_there():
    for name in snowshed.analysis.sensitivity.__all__:
        assert getattr(snowshed.analysis.sensitivity, name).__doc__
    with pytest.raises(AttributeError, match="no attribute 'x'"):
        _ = snowshed.analysis.sensitivity.x


def test_the_command_line_starts_without_what_sensitivity_needs():
    script = (
        "import sys, snowshed.cli.main; print([m for m in ('SALib', 'scipy') if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"


def test_every_option_is_in_the_docs():
    from snowshed.cli.commands.sensitivity import sensitivity

    text = DOCS.read_text(encoding="utf-8")
    for option in sensitivity.params:
        if option.param_type_name == "argument":
            continue
        assert re.search(rf"`{option.opts[-1]}[ `]", text), option.opts
