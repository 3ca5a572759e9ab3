"""Where a model may be asked: inside the data it was made from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.arrays import Floats
from snowshed.extras import require
from snowshed.regression.rows import INPUT_UNITS, INPUT_WORDS
from snowshed.regression.scaling import Scaling

TOLERANCE = 1e-6  # of standardised inputs


@dataclass(frozen=True)
class Domain:
    """The applicability domain: ranges of the inputs, convex hull and spacing of the panels.

    Attributes
    ----------
    inputs
        All rows, shape (n, 4), the columns of `INPUTS`.
    """

    inputs: Floats

    def objections(self, question: Floats) -> list[str]:
        """Say in words why a question lies outside the data; an empty list: it lies inside.

        Parameters
        ----------
        question
            Shape (4,): event, panel height in m, panel length in m, panel tilt in degrees.

        Examples
        --------
        >>> corners = np.array([[1, h, l, 40] for h in (1, 2) for l in (1, 2)], float)
        >>> Domain(corners).objections(np.array([1, 1.5, 1.5, 40]))
        []
        >>> Domain(corners).objections(np.array([1, 3, 1.5, 40]))
        ['panel height 3 m is outside the data, which reach from 1 to 2 m']
        """
        found = self._ranges(question)
        panel = question[1:]
        if not found and not self._in_hull(panel):
            found = [
                f"each input is within its range, but not together: {panel_in_words(panel)} is "
                f"outside the convex hull of the data; {self._nearest(panel)}"
            ]
        if not found and self._in_gap(panel):
            found = [f"{panel_in_words(panel)} is in a gap of the data; {self._nearest(panel)}"]
        return found

    def _ranges(self, question: Floats) -> list[str]:
        found = []
        low, high = self.inputs.min(axis=0), self.inputs.max(axis=0)
        for value, least, most, word, unit in zip(question, low, high, INPUT_WORDS, INPUT_UNITS):
            margin = TOLERANCE * max(1.0, abs(most))
            if not least - margin <= value <= most + margin:
                reach = f"which reach from {least:g} to {most:g} {unit}"
                reach = f"which have {least:g} {unit} only" if least == most else reach
                text = f"{word} {value:g} {unit}".strip() + f" is outside the data, {reach}"
                found.append(text.strip())
        return found

    def _in_hull(self, panel: Floats) -> bool:
        """Whether the panel is a weighted mean of the data's, which a linear program finds out."""
        optimize = require("scipy.optimize", "regression", "the domain of a model")
        points, place = self._scaled(panel)
        count, dimension = points.shape
        # Weights of the panels, and how far their mean misses the question in either direction.
        either_way = np.hstack([np.eye(dimension), -np.eye(dimension)])
        misses = np.vstack([either_way, np.zeros((1, 2 * dimension))])
        equal = np.hstack([np.vstack([points.T, np.ones(count)]), misses])
        cost = np.concatenate([np.zeros(count), np.ones(2 * dimension)])
        found = optimize.linprog(cost, A_eq=equal, b_eq=np.append(place, 1.0), method="highs")
        return bool(found.status == 0 and found.fun <= TOLERANCE * dimension)

    def _in_gap(self, panel: Floats) -> bool:
        """Whether the nearest panel is farther than the widest spacing of panels explains.

        In the middle of a cube of that edge the nearest corner is less than sqrt(dimension) of it
        away.
        """
        points, place = self._scaled(panel)
        between = np.linalg.norm(points[:, None] - points[None], axis=-1)
        np.einsum("ii->i", between)[...] = np.inf
        widest = float(between.min(axis=1).max()) if len(points) > 1 else 0.0
        dimension = int((np.ptp(points, axis=0) > 0).sum())
        distance = np.linalg.norm(points - place, axis=1).min()
        return bool(distance > widest * np.sqrt(dimension) + TOLERANCE)

    def _nearest(self, panel: Floats) -> str:
        points, place = self._scaled(panel)
        nearest = self._panels[int(np.argmin(np.linalg.norm(points - place, axis=1)))]
        return f"the nearest panel in the data has {panel_in_words(nearest)}"

    @property
    def _panels(self) -> Floats:
        return np.asarray(np.unique(self.inputs[:, 1:], axis=0))

    def _scaled(self, panel: Floats) -> tuple[Floats, Floats]:
        """Return the data's panels and the one in question, standardised."""
        scaling = Scaling.of(self._panels)
        return scaling.scaled(self._panels), scaling.scaled(panel)


def panel_in_words(panel: Floats) -> str:
    """Return height, length and tilt as text.

    Examples
    --------
    >>> panel_in_words(np.array([2, 4, 60]))
    'panel height 2 m, panel length 4 m, panel tilt 60 degrees'
    """
    return ", ".join(
        f"{word} {value:g} {unit}"
        for word, value, unit in zip(INPUT_WORDS[1:], panel, INPUT_UNITS[1:])
    )
