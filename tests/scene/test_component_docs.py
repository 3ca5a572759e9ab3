"""The components of a scene are the output of `make components` from the core's description."""

import subprocess
import sys
import typing

import pytest
from helpers.paths import ROOT
from tools.components import components, with_described_fields, with_settings_exports

from snowshed.base.field_type import alternatives_of
from snowshed.methods.registry import METHODS, NAME_KEY
from snowshed.scene.schema import properties, resolve, scene_schema

NODES = components()


def test_the_sources_are_up_to_date():
    command = [sys.executable, "-m", "tools.components", "--check"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


SOURCE = """@dataclass
class Panel(Record):
    \"\"\"A panel.

    Attributes
    ----------
    height : float
        Something else.

    Notes
    -----
    By hand.
    \"\"\"

    height: Optional[float] = None
    removed: Optional[int] = None

    lower_edge_height = Alias("height")

    def area(self):
        return 1
"""


def test_fields_are_updated_and_other_code_stays():
    panel = next(record for record in NODES if record.__name__ == "Panel")
    new = with_described_fields(SOURCE, {"Panel": (panel, NODES[panel])})
    assert "removed" not in new
    assert "    tilt: Optional[float] = default(40.0)\n" in new
    assert "        Tilt from the horizontal [degrees]. 0 <= value <= 90; default 40" in new
    assert "    By hand.\n" in new
    assert new.endswith(SOURCE[SOURCE.index("    lower_edge_height") :])
    assert with_described_fields(new, {"Panel": (panel, NODES[panel])}) == new


def test_the_package_exports_the_settings_of_registered_methods_only():
    stub = "from ._core import X as X\nfrom .methods.old.settings import O as O\nfrom .pv import P"
    first, *settings, last = with_settings_exports(stub).split("\n")
    assert [line.rpartition(" ")[2] for line in settings] == sorted(
        method.settings.__name__ for method in METHODS.values()
    )
    assert [first, last] == ["from ._core import X as X", "from .pv import P"]


@pytest.mark.parametrize("record", NODES, ids=lambda record: record.__name__)
def test_enumerations_and_aliases_agree_with_the_schema(record):
    hints = typing.get_type_hints(record)
    aliases = {}
    for key, child in properties(scene_schema(), NODES[record]).items():
        full = resolve(scene_schema(), child)
        field = record.keys()[key]
        if "enum" in full:
            ((kind,), choices) = alternatives_of(hints[field]), tuple(full["enum"])
            named = tuple(METHODS) if key == NAME_KEY else typing.get_args(kind)
            assert named == choices
        aliases.update(dict.fromkeys(full.get("x-aliases", ()), field))
    assert record.aliases() == aliases
