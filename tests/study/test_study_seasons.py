"""Studies whose runs are seasons."""

from datetime import datetime, timedelta

import pandas as pd
import pytest
from study_helpers import SEQUENTIAL, tiny_scene

from snowshed import InputError, read_events
from snowshed.cli.main import main
from snowshed.season import SeasonSettings, Weather, run_season
from snowshed.study import SeasonPart, Study, read_table, resume

FIRST = datetime(2024, 12, 1)
WINTER = [
    Weather(2 + day, FIRST + timedelta(days=day), snow, 100.0, -4.0)
    for day, snow in enumerate([0.06, 0.0, 0.08, 0.0])
]
SETTINGS = SeasonSettings(friction=0.5)


def file_of(folder):
    lines = [f"{row.date:%Y-%m-%d},{row.snowfall},{row.temperature}" for row in WINTER]
    file = folder / "winter.csv"
    file.write_text("\n".join(["date,snowfall_m,temperature_c", *lines]) + "\n")
    return file


def tilts(season, values=(40, 50)):
    scene = tiny_scene(max_time=0.3).set("panel.width", 1.0)
    return Study.product(scene, {"panel.tilt": list(values)}, name="tilts", season=season)


def test_a_run_equals_the_season_of_its_panel(tmp_path):
    study = tilts(SeasonPart(WINTER, SETTINGS), (50,))
    table = study.run(tmp_path / "store", **SEQUENTIAL)
    single = tmp_path / "season"
    scene = tiny_scene(max_time=0.3).update({"panel.width": 1.0, "panel.tilt": 50})
    result = run_season(WINTER, scene, single, settings=SETTINGS, pictures=False)
    assert result.simulated == len(table) == 2
    events = read_events(single / "run")
    for name in ("height_m", "length_m", "mass_kg", "sim_time_s", "steps"):
        assert table[name].to_numpy() == pytest.approx(events[name].to_numpy(), rel=1e-8), name
    assert table["panel.tilt"].unique().tolist() == [50]
    resume(tmp_path / "store", **SEQUENTIAL)  # computes nothing; the store records the season
    pd.testing.assert_frame_equal(read_table(tmp_path / "store"), table)


def test_a_study_file_names_the_winter(tmp_path, capsys):
    file_of(tmp_path)
    file = tmp_path / "study.toml"
    file.write_text(
        'name = "tilts"\n[scene]\npreset = "lab-50"\ndimension = 2\nevents.max_time = 0.3\n'
        "[accuracy]\ndx = 0.02\n"
        '[season]\nweather = "winter.csv"\nfriction = 0.5\nsettling = "none"\ncover = 0.1\n'
        "[axes]\npanel.tilt = [40, 50]\n"
    )
    study = Study.load(file)
    assert study.season.settings == SeasonSettings(friction=0.5, settling=None, cover=0.1)
    study.save(tmp_path / "again.toml")
    reloaded = Study.load(tmp_path / "again.toml")
    assert [run.hash for run in reloaded.runs()] == [run.hash for run in study.runs()]
    assert len({run.hash for run in study.runs()}) == 2
    assert main(["study", "plan", str(file)]) == 0
    assert "2 runs" in capsys.readouterr().out
    other_density = tmp_path / "other.toml"
    other_density.write_text(file.read_text().replace("cover = 0.1", 'density = "jordan-1999"'))
    hashes = {run.hash for run in Study.load(other_density).runs()}
    assert len(hashes) == 2 and hashes.isdisjoint(run.hash for run in study.runs())


@pytest.mark.parametrize(
    ("season", "message"),
    [
        ("friction = 0.5", r"season.weather: missing; give the name of a season file"),
        ('weather = "none.csv"', "none.csv"),
        (
            'weather = "winter.csv"\nfricton = 1',
            r"season.fricton: unknown key; allowed: weather",
        ),
        ('weather = "winter.csv"\nfriction = "x"', r"season.friction: 'x' is not a number"),
        ('weather = "winter.csv"\nfriction = 11', r"season: friction: 11 is outside"),
        ('weather = "winter.csv"\nsettling = 3', r"season.settling: 3 is not a name"),
        ('weather = "winter.csv"\nfriction = 5', r"panel.tilt = 40: no snow slides off"),
    ],
)
def test_bad_seasons_are_refused(tmp_path, season, message):
    file_of(tmp_path)
    file = tmp_path / "study.toml"
    scene = '[scene]\npreset = "lab-50"\ndimension = 2\n'
    file.write_text(f"{scene}[season]\n{season}\n[axes]\npanel.tilt = [40]\n")
    with pytest.raises((InputError, OSError), match=message):
        Study.load(file)


def test_parameters_set_by_the_winter_cannot_vary(tmp_path):
    part = SeasonPart(WINTER, SETTINGS)
    for path, value in (("slab.thickness", 0.1), ("events.count", 2)):
        with pytest.raises(InputError, match="cannot be varied; the weather of the season sets it"):
            Study.product(tiny_scene(), {path: [value]}, season=part)
    with pytest.raises(InputError, match="its weather is not in a file"):
        tilts(part).to_toml()
