"""The laboratory experiment in 2D, against what the thesis and an independent program give."""

import numpy as np
import pandas as pd
import pytest

from snowshed import read_events
from snowshed.cli.main import main
from snowshed.run.results import EVENT_COLUMNS


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """The results folder of five events: about ten seconds."""
    folder = tmp_path_factory.mktemp("lab") / "out"
    options = ["--preset", "lab-50", "--dim", "2", "--friction", "0.3", "--threads", "1"]
    assert main(["panel", *options, "-q", "-o", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module")
def table(lab) -> pd.DataFrame:
    return read_events(lab)


def test_five_events_come_to_rest_off_the_panel(table):
    assert list(table.columns) == list(EVENT_COLUMNS)
    assert list(table.event) == [1, 2, 3, 4, 5]
    assert set(table.ended) == {"rest"}
    assert (table.on_panel_kg == 0).all()
    assert table.sim_time_s.between(0.4, 3).all()


def test_stack_has_the_size_it_should(table):
    """Heights within 0.03 to 0.25 m, lengths within 0.15 to 0.6 m (0.045-0.147, 0.22-0.41 m)."""
    assert table.height_m.between(0.03, 0.25).all()
    assert table.length_m.between(0.15, 0.6).all()
    assert table.height_m.iloc[-1] > 1.5 * table.height_m.iloc[0]
    assert table.length_m.iloc[-1] > 1.2 * table.length_m.iloc[0]
    assert (table.detached_kg < 0.05 * table.mass_kg).all()
    assert (table.body_length_m <= table.length_m * 1.05).all()


def test_mass_is_exact_and_snow_loosens_a_little(table):
    slabs = 0.245 * 0.02 * table.event
    assert table.mass_kg.to_numpy() == pytest.approx(210 * slabs.to_numpy(), rel=1e-6)
    assert (table.volume_m3 / slabs).between(0.8, 1.5).all()


def test_the_head_walks_toward_the_panel(table):
    """From 0.14 to 0.10 m in the independent program."""
    assert table.head_m.between(0.0, 0.25).all()
    assert table.head_m.iloc[-1] < table.head_m.iloc[0] - 0.01
    assert np.polyfit(table.event, table.head_m, 1)[0] < 0


def test_outlines_are_those_of_the_stacks(lab, table):
    outlines = pd.read_csv(lab / "outline.csv").groupby("event")
    assert outlines.z.max().to_numpy() == pytest.approx(table.height_m.to_numpy())
    assert outlines.x.min().to_numpy() == pytest.approx(table.head_m.to_numpy())
    assert outlines.x.max().to_numpy() == pytest.approx(table.tail_m.to_numpy())
    assert (outlines.size() <= 30).all() and (outlines.size() > 20).all()
