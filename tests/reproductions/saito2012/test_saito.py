"""The reproduction of the paper on avalanches: geometry, rules, and the command."""

from dataclasses import replace

import numpy as np
import pytest
from plot.browser import check_page
from reproductions.common.hypothesis_tests import CONFIRMED, CONTRADICTED, UNDECIDED, judge
from reproductions.common.report import write_report
from reproductions.saito2012 import cases as made
from reproductions.saito2012 import sections
from reproductions.saito2012.cases import FULL, QUICK
from reproductions.saito2012.claims import CLAIMS, CaseHistories
from reproductions.saito2012.measures import CaseHistory
from reproductions.saito2012.publication import REPRODUCTION
from reproductions.saito2012.runs import CaseStage, Snow
from reproductions.saito2012.stages import AvalancheComputation

from snowshed.cli.main import main
from snowshed.running.simulation import Simulation


@pytest.mark.parametrize("resolution", [QUICK, FULL], ids=["quick", "full"])
def test_an_event_begins_in_every_scene(resolution):
    for case in made.cases(resolution):
        simulation = Simulation(case.scene)
        simulation.begin_event()
        distances = case.profile.along(simulation.positions())
        assert distances.max() < 31 and distances.min() > -61


def test_frames_lie_on_the_ground_profile():
    profile = made.GroundProfile.of(made.SLOPES[2])
    for distance in (-55.0, -31.0, -29.0, -1.0):
        point, down, normal, tilt = profile.frame(distance)
        assert profile.along(point[None])[0] == pytest.approx(distance)
        assert down @ normal == pytest.approx(0)
        assert np.degrees(np.arctan2(-down[2], down[0])) == pytest.approx(tilt)


def snow_at(case, distances, across=0.0, speed=0.0):
    """Snow whose particles lie at given distances along the profile."""
    points = np.array(
        [
            case.profile.frame(distance)[0] if distance < 0 else [distance, 0, 0]
            for distance in distances
        ]
    )
    points[:, 1] = across
    velocities = np.zeros_like(points)
    velocities[:, 0] = speed
    return points, velocities


def history(case, ends, *, speed=0.0, width=1.0):
    """A history with particles at `ends(fraction)` of the time, m along the profile."""
    snow = []
    spread = width * np.linspace(-0.5, 0.5, 100)
    for time in case.times:
        points, velocities = snow_at(case, ends(time / case.end), spread, speed)
        snow.append(Snow(time, points, velocities, np.zeros(100, dtype=np.uint8)))
    return CaseHistory.of(case, snow)


def histories_as_claimed(**changed):
    """Histories of all cases in which the snow moves as the paper claims."""

    def falls(stopped):
        """The obstacle stops `stopped` of a hundred particles; from 3 s to 4 s two more pass."""

        def ends(fraction):
            distances = np.full(100, -5.0 + 6.0 * min(1, fraction / 0.6))
            late_particles = np.abs(np.arange(100) - 49.5) > 48.6
            if fraction <= 0.75:
                distances[late_particles] = min(distances[0], -0.5)
            distances[50 - stopped // 2 : 50 + stopped // 2] = min(-0.4, distances[50])
            return distances

        return ends

    wooden = dict(zip(made.OBSTACLE_NAMES, (falls(0), falls(40), falls(0), falls(30))))
    wooden.update(changed.get("wooden", {}))
    results = [
        history(made.wooden_case(name, QUICK), ends, width=0.22) for name, ends in wooden.items()
    ]
    for number in (1, 2):
        for model in (made.BINGHAM, made.COMBINED):
            bingham = model == made.BINGHAM
            results.append(
                history(
                    made.slope_case(number, model, QUICK),
                    lambda fraction: np.full(100, -20.0 + 20 * fraction),
                    speed=0.5 if bingham else 0.0,
                    width=12.0 if bingham else 10.0,
                )
            )
    return CaseHistories({result.case.name: result for result in results})


def verdicts(histories):
    return [claim.finding.verdict for claim in judge(CLAIMS, histories)]


def test_flows_as_claimed_confirm_the_claims():
    results = verdicts(histories_as_claimed())
    assert results == [CONFIRMED] * 6 + [UNDECIDED] + [CONFIRMED] * 3 + [UNDECIDED]


def test_stakes_that_stop_no_snow_contradict_the_claim():
    free = histories_as_claimed(
        wooden={made.NARROW_STAKES: lambda fraction: np.full(100, -5 + 6 * fraction)}
    )
    assert verdicts(free)[1] == CONTRADICTED


def test_missing_cases_leave_claims_open():
    assert set(verdicts(CaseHistories({}))) == {UNDECIDED}


def test_an_interrupted_case_resumes_to_the_same_positions(tmp_path):
    full_case = made.slope_case(1, made.BINGHAM, QUICK)
    case = replace(full_case, end=0.4, interval=0.2)
    stage = CaseStage(case, tmp_path / "one")
    stage.compute(None, lambda *_: None)
    assert stage.state().finished

    class StopError(Exception):
        pass

    def interrupt(fraction, _):
        if fraction > 0.75:
            raise StopError

    interrupted = CaseStage(case, tmp_path / "two")
    with pytest.raises(StopError):
        interrupted.compute(None, interrupt)
    assert interrupted.state().done == 2
    interrupted.compute(None, lambda *_: None)
    for uninterrupted, resumed in zip(stage.snow(), interrupted.snow()):
        np.testing.assert_allclose(uninterrupted.positions, resumed.positions, atol=1e-4)


def test_the_command_writes_a_report(tmp_path, capsys):
    folder = tmp_path / "found"
    name = "slope-1-Bingham"
    assert main(["reproduce", "saito", "-o", str(folder), "--stage", name, "-q"]) == 0
    page = (folder / "saito.html").read_text(encoding="utf-8")
    assert "slope 1, Bingham" in page and "0 of 17 times done" in page
    check_page(folder / "saito.html")
    assert main(["reproduce", "saito", "-o", str(folder), "--full", "--report-only"]) == 2


def test_a_failed_case_reports_its_error(tmp_path, capsys):
    folder = tmp_path / "found"
    case = folder / "cases" / "slope-1-Bingham"
    command = ["reproduce", "saito2012", "-o", str(folder), "--report-only", "-q"]
    assert main(command) == 0
    case.mkdir(parents=True)
    (case / "failed.txt").write_text("the pressure did not converge\n")
    assert main(command) == 3
    message = "slope 1, Bingham: the pressure did not converge"
    assert capsys.readouterr().err == f"error: simulations failed: {message}\n"
    page = (folder / "saito.html").read_text(encoding="utf-8")
    assert "0 of 21 times done, 21 failed (the pressure did not converge)" in page


def test_the_page_of_all_cases_is_accessible(tmp_path, monkeypatch):
    monkeypatch.setattr(sections, "WOODEN_TIMES", (1.0, 4.0))
    monkeypatch.setattr(sections, "SLOPE_TIMES", (20.0,))
    computation = AvalancheComputation(tmp_path, QUICK)
    computation.histories = histories_as_claimed()
    write_report(REPRODUCTION, REPRODUCTION.size("quick"), tmp_path, computation)
    text = (tmp_path / "saito.html").read_text(encoding="utf-8")
    assert text.count("<img") + text.count("<svg") >= 2 and "confirmed" in text
    check_page(tmp_path / "saito.html")
