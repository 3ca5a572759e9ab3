"""Sets of cells: split by sectors, small parts joined to their neighbours."""

import numpy as np
import pytest

from snowshed.analysis.hazard.candidate_cells import split_by_sectors

FACING = {"N": 0.0, "E": 90.0, "S": 180.0, "W": 270.0, " ": np.nan}


def split(text, count):
    """Split cells that face the named directions; return labels as letters, by rows."""
    rows = text.split("|")
    aspect = np.array([[FACING[letter] for letter in row] for row in rows])
    labels = split_by_sectors(np.isfinite(aspect), aspect, 4, count)
    names = dict(zip(dict.fromkeys(labels[labels > 0].tolist()), "abcdef"))
    return "|".join("".join(names.get(label, " ") for label in row) for row in labels.tolist())


@pytest.mark.parametrize(
    ("text", "count", "expected"),
    [
        ("NNEE", 2, "aabb"),
        ("NNEENN", 2, "aabbcc"),
        ("NE|EN", 1, "ab|cd"),
        ("NNNEWWW", 2, "aaaabbb"),
        ("E NNN", 3, "a bbb"),  # it has no neighbour
        ("EE|EE", 9, "aa|aa"),
    ],
)
def test_parts_are_connected_and_face_the_same_sector(text, count, expected):
    assert split(text, count) == expected


def test_a_small_part_joins_the_neighbour_with_most_edges():
    assert split("NNNN|NEEN|SSSS|SSSS|SSSS", 3) == "aaaa|aaaa|bbbb|bbbb|bbbb"


def test_joined_parts_are_large_enough_together():
    """North and east join and are then large enough; south joins the larger west."""
    assert split("NESWWWW", 2) == "aabbbbb"


def test_edges_of_joined_parts_add_up():
    """South has three edges with west, two with north, and four once it holds east."""
    rows = ["NNNN ", "NNNN ", "NNNN ", "SEES ", "SSSS ", " WWW ", " WWW ", " WWW "]
    labels = split("|".join(rows), 9).split("|")
    assert labels[3] == labels[4] == "aaaa "
    assert labels[5] == " bbb "


@pytest.mark.parametrize(
    ("degrees", "sector"), [(44.0, "N"), (46.0, "E"), (316.0, "N"), (314.0, "W")]
)
def test_sectors_are_centred_on_north(degrees, sector):
    aspect = np.array([[degrees, FACING[sector]]])
    assert split_by_sectors(aspect >= 0.0, aspect, 4, 1).max() == 1
