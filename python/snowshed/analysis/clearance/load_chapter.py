"""The chapter of loads in the answer: how far the snow comes, how fast it lands, what it loads."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed.analysis.clearance.answer import ClearanceResult
from snowshed.analysis.loads.free_flight import landing
from snowshed.analysis.loads.peak_errors import peak_error_sentence
from snowshed.analysis.loads.structures import WINDOWS, kilo, structure_loads
from snowshed.base.formatting import percent
from snowshed.plot.html_page import HtmlTable
from snowshed.results.season_folder import SeasonFolder
from snowshed.scene.panel_edge import ground_tilt
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    import pandas as pd

#: Shares of the simulated winters whose snow stays within a distance.
SHARES = (0.5, 0.9, 1.0)


def scene_with_forces(answer: ClearanceResult, index: int, height: float) -> ResolvedScene:
    """Return the scene of a case at a height, whose run records the forces."""
    case = answer.cases[index]
    return replace(case, base={**case.base, "output.forces": True}).panel_scene(height)


def reach_table(answer: ClearanceResult) -> HtmlTable:
    """Return the distances from the lower edge within which the stack of a winter stays."""
    rows = [
        ("the farthest" if share == 1.0 else percent(share), f"{distance:.2f}")
        for share, distance in zip(SHARES, reach_quantiles(answer))
    ]
    return HtmlTable(("of the simulated winters", "stay within, m"), rows, "lr")


def reach_quantiles(answer: ClearanceResult) -> list[float]:
    """Return the distances from the lower edge within which these shares of winters stay, m."""
    nearest = [
        min(outcomes, key=lambda outcome: abs(outcome.height - required)).reach
        for outcomes, required in zip(answer.outcomes, answer.required)
    ]
    return [float(np.quantile(nearest, share)) for share in SHARES]


def landing_text(answer: ClearanceResult) -> str:
    """Return a sentence on where and how fast the last snow of a slab lands, by hand."""
    from snowshed.analysis.clearance.answer_text import headline_height

    height = headline_height(answer)
    case = answer.cases[answer.worst_case_index]
    data = case.panel_scene(answer.heights[0]).data
    frictions = [case.values.get("sliding_friction") for case in answer.cases]
    least = min((value for value in frictions if value is not None),
                default=data["panel"]["friction"])  # fmt: skip
    flight = landing(answer.design.slope_length, answer.design.tilt, least, height,
                     data["gravity"], ground_tilt(data))  # fmt: skip
    return (
        f"Snow from the upper end lands {flight.distance:.1f} m from an edge {height:.1f} m above "
        f"bare ground, at {flight.speed:.1f} m/s (free flight, with the smallest drawn sliding "
        f"friction, {least:.2f})."
    )


@dataclass(frozen=True)
class WorstLoads:
    """The loads of the worst winter, from its season's folder."""

    loads: pd.DataFrame
    note: str

    @classmethod
    def read(cls, folder: Path) -> Optional[WorstLoads]:
        """Read them; None if nothing slid."""
        from snowshed.results.reader import Results

        run = SeasonFolder(folder).run.folder
        if not (run / "loads.csv").is_file():
            return None
        results = Results(run)
        return cls(results.loads, peak_error_sentence(results.scene.data))

    @property
    def table(self) -> HtmlTable:
        """The largest loads on each structure, kN per metre of width."""
        rows = [
            (
                str(row["obstacle"]),
                kilo(row["rest_n"]),
                *(kilo(row[f"peak_{window}ms_n"]) for window in WINDOWS),
            )
            for row in structure_loads(self.loads).to_dict("records")
        ]
        head = ("on", "at rest", *(f"peak of {window} ms" for window in WINDOWS))
        return HtmlTable(head, rows, "l" + "r" * (len(head) - 1))
