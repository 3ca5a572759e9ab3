"""The reproduction of the paper on avalanches: its geometry, its rules, and its command."""

from dataclasses import replace

import numpy as np
import pytest
from plot.browser import check_page
from reproductions.common.hypothesis_tests import CONFIRMED, CONTRADICTED, UNDECIDED, judge
from reproductions.common.report import write_report
from reproductions.saito2012 import cases as made
from reproductions.saito2012 import sections
from reproductions.saito2012.cases import FULL, QUICK
from reproductions.saito2012.claims import CLAIMS, Courses
from reproductions.saito2012.measures import Course
from reproductions.saito2012.publication import REPRODUCTION
from reproductions.saito2012.runs import CaseStage, Snow
from reproductions.saito2012.stages import AvalancheComputation

from snowshed.cli.main import main
from snowshed.running.simulation import Simulation


@pytest.mark.parametrize("resolution", [QUICK, FULL], ids=["quick", "full"])
def test_every_scene_can_be_begun(resolution):
    for case in made.cases(resolution):
        simulation = Simulation(case.scene)
        simulation.begin_event()
        ways = case.path.along(simulation.positions())
        assert ways.max() < 31 and ways.min() > -61


def test_a_frame_stands_on_its_path():
    path = made.GroundProfile.of(made.SLOPES[2])
    for way in (-55.0, -31.0, -29.0, -1.0):
        point, down, normal, tilt = path.frame(way)
        assert path.along(point[None])[0] == pytest.approx(way)
        assert down @ normal == pytest.approx(0)
        assert np.degrees(np.arctan2(-down[2], down[0])) == pytest.approx(tilt)


def at_rest_at(case, ways, across=0.0, speed=0.0):
    """Snow whose particles have some distances along the path."""
    points = np.array([case.path.frame(way)[0] if way < 0 else [way, 0, 0] for way in ways])
    points[:, 1] = across
    velocities = np.zeros_like(points)
    velocities[:, 0] = speed
    return points, velocities


def course(case, ends, *, speed=0.0, width=1.0):
    """A course whose particles start above and end at `ends(fraction)`."""
    snow = []
    spread = width * np.linspace(-0.5, 0.5, 100)
    for time in case.times:
        points, velocities = at_rest_at(case, ends(time / case.end), spread, speed)
        snow.append(Snow(time, points, velocities, np.zeros(100, dtype=np.uint8)))
    return Course.of(case, snow)


def courses_as_claimed(**changed):
    """Courses of all cases in which the snow does what the paper says."""

    def falls(kept):
        """The given number of a hundred particles ends above the obstacle; from 3 s to 4 s two more
        pass."""

        def ends(fraction):
            ways = np.full(100, -5.0 + 6.0 * min(1, fraction / 0.6))
            late = np.abs(np.arange(100) - 49.5) > 48.6
            if fraction <= 0.75:
                ways[late] = min(ways[0], -0.5)
            ways[50 - kept // 2 : 50 + kept // 2] = min(-0.4, ways[50])
            return ways

        return ends

    wooden = dict(zip(made.OBSTACLE_NAMES, (falls(0), falls(40), falls(0), falls(30))))
    wooden.update(changed.get("wooden", {}))
    known = [
        course(made.wooden_case(name, QUICK), ends, width=0.22) for name, ends in wooden.items()
    ]
    for number in (1, 2):
        for model in (made.BINGHAM, made.COMBINED):
            bingham = model == made.BINGHAM
            known.append(
                course(
                    made.slope_case(number, model, QUICK),
                    lambda fraction: np.full(100, -20.0 + 20 * fraction),
                    speed=0.5 if bingham else 0.0,
                    width=12.0 if bingham else 10.0,
                )
            )
    return Courses({one.case.name: one for one in known})


def verdicts(courses):
    return [one.finding.verdict for one in judge(CLAIMS, courses)]


def test_what_the_paper_says_is_confirmed_where_the_snow_does_it():
    found = verdicts(courses_as_claimed())
    assert found == [CONFIRMED] * 6 + [UNDECIDED] + [CONFIRMED] * 3 + [UNDECIDED]


def test_stakes_that_let_all_through_contradict():
    free = courses_as_claimed(
        wooden={made.NARROW_STAKES: lambda fraction: np.full(100, -5 + 6 * fraction)}
    )
    assert verdicts(free)[1] == CONTRADICTED


def test_cases_that_are_not_there_leave_claims_open():
    assert set(verdicts(Courses({}))) == {UNDECIDED}


def test_a_case_goes_on_after_an_interruption(tmp_path):
    whole = made.slope_case(1, made.BINGHAM, QUICK)
    case = replace(whole, end=0.4, interval=0.2)
    stage = CaseStage(case, tmp_path / "one")
    stage.compute(None, lambda *_: None)
    assert stage.state().finished

    class StopError(Exception):
        pass

    def interrupt(fraction, _):
        if fraction > 0.75:
            raise StopError

    other = CaseStage(case, tmp_path / "two")
    with pytest.raises(StopError):
        other.compute(None, interrupt)
    assert other.state().done == 2
    other.compute(None, lambda *_: None)
    for one, two in zip(stage.snow(), other.snow()):
        np.testing.assert_allclose(one.positions, two.positions, atol=1e-4)


def test_the_command_writes_a_report(tmp_path, capsys):
    folder = tmp_path / "found"
    name = "slope-1-Bingham"
    assert main(["reproduce", "saito", "-o", str(folder), "--stage", name, "-q"]) == 0
    page = (folder / "saito.html").read_text(encoding="utf-8")
    assert "slope 1, Bingham" in page and "0 of 17 times done" in page
    check_page(folder / "saito.html")
    assert main(["reproduce", "saito", "-o", str(folder), "--full", "--report-only"]) == 2


def test_a_case_that_failed_says_why(tmp_path, capsys):
    folder = tmp_path / "found"
    case = folder / "cases" / "slope-1-Bingham"
    ask = ["reproduce", "saito2012", "-o", str(folder), "--report-only", "-q"]
    assert main(ask) == 0
    case.mkdir(parents=True)
    (case / "failed.txt").write_text("the pressure did not converge\n")
    assert main(ask) == 3
    said = "slope 1, Bingham: the pressure did not converge"
    assert capsys.readouterr().err == f"error: simulations failed: {said}\n"
    page = (folder / "saito.html").read_text(encoding="utf-8")
    assert "0 of 21 times done, 21 failed (the pressure did not converge)" in page


def test_the_page_of_all_cases_can_be_read_by_everyone(tmp_path, monkeypatch):
    monkeypatch.setattr(sections, "WOODEN_TIMES", (1.0, 4.0))
    monkeypatch.setattr(sections, "SLOPE_TIMES", (20.0,))
    found = AvalancheComputation(tmp_path, QUICK)
    found.courses = courses_as_claimed()
    write_report(REPRODUCTION, REPRODUCTION.size("quick"), tmp_path, found)
    text = (tmp_path / "saito.html").read_text(encoding="utf-8")
    assert text.count("<img") + text.count("<svg") >= 2 and "confirmed" in text
    check_page(tmp_path / "saito.html")
