"""Forms that newer versions of Python and of click accept, and the oldest ones do not."""

import ast

import numpy as np
import pytest
from helpers.paths import ROOT

from snowshed.io.voxels.open_voxels import open_voxels

SOURCES = sorted((ROOT / "python" / "snowshed").rglob("*.py"))


def test_class_variables_state_their_type():
    """Python 3.9 cannot resolve a bare ``ClassVar``."""
    bare = [
        f"{path.name}, line {node.lineno}"
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation) == "ClassVar"
    ]
    assert bare == []


def test_types_of_click_have_no_parameters():
    """The types of click 8.1, the last for Python 3.9, are not generic."""
    generic = [
        f"{path.name}, line {node.lineno}"
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
        for base in node.bases
        if isinstance(base, ast.Subscript) and ast.unparse(base.value).startswith("click.")
    ]
    assert generic == []


def test_tiff_files_are_read_where_tifffile_fixes_a_dialect(tmp_path, monkeypatch):
    """In tifffile 2024.8, the last for Python 3.9, ``is_sis`` cannot be set."""
    tifffile = pytest.importorskip("tifffile")
    monkeypatch.setattr(tifffile.TiffFile, "is_sis", property(lambda tiff: False))
    voxels = np.arange(210, dtype=np.uint8).reshape(5, 6, 7)
    tifffile.imwrite(tmp_path / "a.tif", voxels)
    assert np.array_equal(open_voxels(tmp_path / "a.tif").layers(0, 5), voxels)
