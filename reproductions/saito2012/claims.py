"""The paper's claims, and the rules by which they are judged.

A case is one simulation: nothing in it is random, so numbers have no noise. A claim is confirmed or
contradicted where the number is clearly on one side of its bounds, and undecided between them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Finding,
    all_of,
)
from reproductions.saito2012.cases import (
    BINGHAM,
    BOARD_GAP,
    COMBINED,
    NARROW_STAKES,
    NO_OBSTACLE,
    NOTCHED_BOARD,
    WIDE_STAKES,
)
from reproductions.saito2012.measures import REST_SPEED, CaseHistory

#: Share of all snow above which an obstacle holds snow back.
MIN_HELD_SHARE = 0.10
#: Share of all snow below which an obstacle holds hardly any.
MAX_UNHELD_SHARE = 0.03


@dataclass(frozen=True)
class CaseHistories:
    """All cases that are computed, by their names."""

    by_name: Mapping[str, CaseHistory]

    def of(self, name: str) -> CaseHistory:
        """Return a case; raises LookupError if it is not complete."""
        history = self.by_name.get(name)
        if history is None:
            raise LookupError(name)
        return history

    def wooden(self, obstacle: str) -> CaseHistory:
        """Return the wooden slope with an obstacle."""
        return self.of(f"wooden slope, {obstacle}")

    def slope(self, number: int, model: str) -> CaseHistory:
        """Return slope 1 or 2."""
        return self.of(f"slope {number}, {model}")


def judge_bounds(value: float, low: float, high: float, text: str) -> Finding:
    """Return "confirmed" above `high`, "contradicted" below `low`, and "undecided" between them.

    Examples
    --------
    >>> [judge_bounds(x, 1, 2, "").verdict for x in (0.5, 1.5, 2.5)]
    ['contradicted', 'undecided', 'confirmed']
    """
    verdict = CONFIRMED if value > high else CONTRADICTED if value < low else UNDECIDED
    return Finding(verdict, text)


def reaches_the_foot(data: CaseHistories) -> Finding:
    """Test whether the avalanche without obstacle lies at the foot of the slope at 4 s."""
    history = data.wooden(NO_OBSTACLE)
    fronts = ", ".join(f"{history.front(history.at(t)):.2f}" for t in (1, 2, 3, 4))
    share = history.passed(history.at(4))
    text = f"front at {fronts} m after 1, 2, 3, 4 s; {100 * share:.0f} % below 0.3 m at 4 s"
    return judge_bounds(share, 0.5, 0.8, text)


def held_share(obstacle: str, data: CaseHistories) -> tuple[float, str]:
    """Return the share of the snow that lies above the obstacle because of it, with a text."""
    history, without = data.wooden(obstacle), data.wooden(NO_OBSTACLE)
    held, free = history.held(history.at(4)), without.held(without.at(4))
    return (
        held - free,
        f"{100 * held:.1f} % above the obstacle at 4 s; without it {100 * free:.1f} %",
    )


def holds(obstacle: str, data: CaseHistories) -> Finding:
    """Test whether an obstacle holds snow back that would pass without it."""
    share, text = held_share(obstacle, data)
    return judge_bounds(share, MAX_UNHELD_SHARE, MIN_HELD_SHARE, text)


def leaks(obstacle: str, data: CaseHistories) -> Finding:
    """Test whether snow still passes an obstacle from 3 to 4 s."""
    history = data.wooden(obstacle)
    early, late = history.passed(history.at(3)), history.passed(history.at(4))
    text = f"{100 * early:.1f} % have passed at 3 s, {100 * late:.1f} % at 4 s"
    return judge_bounds(late - early, 0.001, 0.005, text)


def holds_hardly_any(obstacle: str, data: CaseHistories) -> Finding:
    """Test whether an obstacle holds back hardly any snow."""
    share, text = held_share(obstacle, data)
    return judge_bounds(-share, -MIN_HELD_SHARE, -MAX_UNHELD_SHARE, text)


def leaks_at_edges(data: CaseHistories) -> Finding:
    """Test whether most snow that passes the board from 3 to 4 s passes at its edges."""
    history = data.wooden(NOTCHED_BOARD)
    width = history.snow[0].positions[:, 1].max()  # half the slope's width minus half a spacing
    share = history.passed_at_edges(history.at(3), history.at(4), float(width) - 1.25 * BOARD_GAP)
    return judge_bounds(share, 0.3, 0.5, f"{100 * share:.0f} % of what passes from 3 to 4 s")


def never_stops(data: CaseHistories) -> Finding:
    """Test whether Bingham snow still moves at the end."""
    return all_of([_moves(data.slope(number, BINGHAM)) for number in (1, 2)])


def stops(data: CaseHistories) -> Finding:
    """Test whether the combined model's snow rests at the end."""
    findings = [_moves(data.slope(number, COMBINED)) for number in (1, 2)]
    opposite = {CONFIRMED: CONTRADICTED, CONTRADICTED: CONFIRMED, UNDECIDED: UNDECIDED}
    return all_of([Finding(opposite[finding.verdict], finding.sentence) for finding in findings])


def _moves(history: CaseHistory) -> Finding:
    end = history.snow[-1]
    speed, front = history.speed(end), history.front(end) - history.front(history.snow[-6])
    text = (
        f"{history.case.name}: {speed:.3g} m/s on average after {end.time:.0f} s, its front "
        f"{front:+.2f} m in the last five"
    )
    return judge_bounds(speed, REST_SPEED, 5 * REST_SPEED, text)


def spreads_wider(data: CaseHistories) -> Finding:
    """Test whether Bingham snow spreads wider than that of the combined model."""
    widths = []
    for model in (BINGHAM, COMBINED):
        history = data.slope(1, model)
        widths.append(history.width(history.snow[-1]))
    if widths[0] == 0:
        raise LookupError("slope 1 in space: here it is a section")
    text = f"{widths[0]:.1f} m, combined model {widths[1]:.1f} m"
    return judge_bounds(widths[0] / widths[1], 1.0, 1.05, text)


def undecided_without(what: str) -> Finding:
    """Return an undecided finding: the reference data are unavailable."""
    return Finding(UNDECIDED, f"{what} are not available")


WOODEN_CLAIMS: list[Claim[CaseHistories]] = [
    Claim(
        "experiments, fig. 14",
        "Without an obstacle the snow is deposited at the foot of the slope.",
        "more than 80 % is there at 4 s; contradicted below 50 %",
        reaches_the_foot,
    ),
    Claim(
        "experiments, fig. 15",
        "Stakes 0.02 m apart hold snow back.",
        f"at 4 s at least {MIN_HELD_SHARE:.0%} more lie above them than without; contradicted "
        f"below {MAX_UNHELD_SHARE:.0%}",
        lambda data: holds(NARROW_STAKES, data),
    ),
    Claim(
        "experiments, fig. 15",
        "In the simulation snow flows through the gaps gradually.",
        "more than 0.5 % of the snow passes from 3 to 4 s; contradicted below 0.1 %",
        lambda data: leaks(NARROW_STAKES, data),
    ),
    Claim(
        "experiments, fig. 16",
        "Stakes 0.04 m apart keep almost no snow.",
        f"at 4 s less than {MAX_UNHELD_SHARE:.0%} more lie above them than without; contradicted "
        f"above {MIN_HELD_SHARE:.0%}",
        lambda data: holds_hardly_any(WIDE_STAKES, data),
    ),
    Claim(
        "experiments, fig. 17",
        "The notched board holds snow back.",
        f"at 4 s at least {MIN_HELD_SHARE:.0%} more lie above it than without; contradicted "
        f"below {MAX_UNHELD_SHARE:.0%}",
        lambda data: holds(NOTCHED_BOARD, data),
    ),
    Claim(
        "experiments, fig. 17",
        "It leaks at its edges.",
        "more than half of what passes from 3 to 4 s passes there; contradicted below 30 %",
        leaks_at_edges,
    ),
    Claim(
        "experiments, fig. 13",
        "After 1 s simulation and experiment differ, after 2 s they agree.",
        "needs the photographs",
        lambda data: undecided_without("the photographs"),
    ),
]
SLOPE_CLAIMS: list[Claim[CaseHistories]] = [
    Claim(
        "slope 1, fig. 10",
        "With the Bingham model alone the snow never stops.",
        f"on both slopes its mean speed is above {5 * REST_SPEED:g} m/s at the end; contradicted "
        f"below {REST_SPEED:g} m/s",
        never_stops,
    ),
    Claim(
        "slope 1, fig. 10",
        "With the combined model and deposition it stops.",
        f"on both slopes its mean speed is below {REST_SPEED:g} m/s at the end; contradicted "
        f"above {5 * REST_SPEED:g} m/s",
        stops,
    ),
    Claim(
        "slope 1, fig. 9",
        "With the Bingham model alone the snow spreads too wide.",
        "at the end 98 % of it lie more than 5 % wider than with the combined model; contradicted "
        "if not wider",
        spreads_wider,
    ),
    Claim(
        "slope 2, fig. 11",
        "Speed and path agree with the photographs.",
        "needs the photographs",
        lambda data: undecided_without("the photographs and the slope's shape"),
    ),
]
CLAIMS = (*WOODEN_CLAIMS, *SLOPE_CLAIMS)
