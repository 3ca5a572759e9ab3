"""The domain of a model: the inputs inside the data from which it was made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import optimize, spatial

from snowshed.analysis.regression.rows import INPUTS
from snowshed.analysis.regression.scaling import Scaling
from snowshed.base.arrays import Floats
from snowshed.scene.labels import label, settings_text

#: Digits of values in messages; a value just beyond a range must differ from its end.
DIGITS = 7
TOLERANCE = 1e-6  # of standardised inputs
#: The spacing of the data is this quantile of the distances from panel to nearest panel, so that a
#: few lonely panels do not increase it.
SPACING_QUANTILE = 0.9


@dataclass(frozen=True)
class DataDomain:
    """The applicability domain: ranges of the inputs, convex hull and spacing of the panels.

    Attributes
    ----------
    inputs
        All rows, shape (n, k), the columns of `names`.
    names
        Names of the inputs; the event is the first.
    """

    inputs: Floats
    names: Sequence[str] = INPUTS

    def objections(self, questions: Floats) -> list[str]:
        """Return the reasons why questions lie outside the data; empty if all lie inside.

        Parameters
        ----------
        questions
            Shape (k,) or (m, k): the event, and the other inputs in SI units, angles in degrees.

        Examples
        --------
        >>> corners = np.array([[1, h, l, 40] for h in (1, 2) for l in (1, 2)], float)
        >>> DataDomain(corners).objections(np.array([1, 1.5, 1.5, 40]))
        []
        >>> DataDomain(corners).objections(np.array([1, 3, 1.5, 40]))
        ['panel height 3 m is outside the data, which reach from 1 to 2 m']
        """
        questions = np.atleast_2d(questions)
        objections = self._range_objections(questions)
        if not objections:
            # Most events have the same panels, which are checked once.
            cases: dict[tuple[bytes, bytes], tuple[Floats, Floats]] = {}
            for question in questions:
                panels = self._by_event.get(question[0], self.inputs[:0, 1:])
                cases.setdefault((question[1:].tobytes(), panels.tobytes()), (question, panels))
            objections = [
                text for group in cases.values() for text in self._hull_objections(*group)
            ]
        return list(dict.fromkeys(objections))

    def _range_objections(self, questions: Floats) -> list[str]:
        """Return an objection to each input that is outside its range in some question."""
        objections = []
        low, high = self.inputs.min(axis=0), self.inputs.max(axis=0)
        for name, values, least, most in zip(self.names, questions.T, low, high):
            margin = TOLERANCE * max(1.0, abs(most))
            outside = np.unique(values[~((least - margin <= values) & (values <= most + margin))])
            if len(outside):
                parameter = label(name)
                given, end = (parameter.quantity(n, DIGITS) for n in (outside[-1], most))
                if len(outside) > 1:
                    given = f"{parameter.value(outside[0], DIGITS)} to {given}"
                reach = f"reach from {parameter.value(least, DIGITS)} to {end}"
                reach = f"have {end} only" if least == most else reach
                objections.append(f"{parameter.name} {given} is outside the data, which {reach}")
        return objections

    def _hull_objections(self, question: Floats, panels: Floats) -> list[str]:
        """Return the objections to a question within all ranges, among the panels of its event.

        It may lie outside their convex hull, or in a gap between them.
        """
        event, panel = question[0], question[1:]
        if not len(panels):
            return [f"event {event:g} is not in the data"]
        scaling = Scaling.of(panels)
        points, query = scaling.scaled(panels), scaling.scaled(panel)
        distances = np.linalg.norm(points - query, axis=1)
        where = f"the nearest panel in the data has {self._panel_text(panels[distances.argmin()])}"
        if len(panels) < self._panel_count:
            where = (
                f"only {len(panels)} of {self._panel_count} panels have event {event:g}; {where}"
            )
        if not _in_hull(points, query):
            return [
                f"each input is within its range, but not together: {self._panel_text(panel)} is "
                f"outside the convex hull of the data; {where}"
            ]
        if distances.min() > _widest_gap(points) + TOLERANCE:
            return [f"{self._panel_text(panel)} is in a gap of the data; {where}"]
        return []

    def _panel_text(self, panel: Floats) -> str:
        """Return the inputs of a panel as text."""
        return settings_text(dict(zip(self.names[1:], panel)))

    @cached_property
    def _by_event(self) -> dict[float, Floats]:
        """The panels of each event, shape (m, k - 1)."""
        events = self.inputs[:, 0]
        return {
            float(event): np.unique(self.inputs[events == event, 1:], axis=0)
            for event in np.unique(events)
        }

    @cached_property
    def _panel_count(self) -> int:
        """Number of panels with any event."""
        return len(np.unique(self.inputs[:, 1:], axis=0))


def _in_hull(points: Floats, query: Floats) -> bool:
    """Return whether a query is a weighted mean of points, with weights from 0 that sum to 1."""
    system = np.vstack([points.T, np.ones(len(points))])
    _, residual = optimize.nnls(system, np.append(query, 1.0))
    return bool(residual <= TOLERANCE)


def _widest_gap(points: Floats) -> float:
    """Return the distance to the nearest point beyond which a query counts as lying in a gap.

    The middle of a cube is less than sqrt(dimension) of its edges away from the corners.
    """
    if len(points) < 2:
        return 0.0
    to_nearest = spatial.cKDTree(points).query(points, k=2)[0][:, 1]
    spacing = float(np.quantile(to_nearest, SPACING_QUANTILE, method="lower"))
    dimension = int((np.ptp(points, axis=0) > 0).sum())
    return spacing * float(np.sqrt(dimension))
