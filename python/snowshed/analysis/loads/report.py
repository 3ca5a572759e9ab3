"""The page of loads, loads.html, and the table of the largest loads beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, cast

import numpy as np

from snowshed.analysis.loads.free_flight import landing
from snowshed.analysis.loads.peak_errors import peak_error_sentence
from snowshed.analysis.loads.reach import SHARES, distance_passed_by
from snowshed.analysis.loads.slope import SnowSlope
from snowshed.analysis.loads.standards import Rule, RuleInputs, rules
from snowshed.analysis.loads.structures import WINDOWS, kilo, structure_loads
from snowshed.base.arguments import checked
from snowshed.base.formatting import percent
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv
from snowshed.io.run_files import unfinished_note
from snowshed.plot.html_page import HtmlTable, Picture, template
from snowshed.scene.panel_edge import ground_tilt, panel_edge

if TYPE_CHECKING:
    import pandas as pd
    import xarray

    from snowshed.results.reader import Results

PAGE, TABLE = "loads.html", "largest_loads.csv"
#: Obstacles that carry the snow in any scene; a sentence prefers the others.
CARRIERS = ("ground", "panel", "domain")
#: The balance of momentum may leave this share of the largest impulse without a word.
MAX_UNBALANCED = 0.02
#: Snow loads that differ by less are those of the same snow.
SAME_SNOW = 0.1


@checked
def write_loads(
    results: Sequence[Results], folder: Path, inputs: Optional[RuleInputs] = None
) -> Path:
    """Write loads.html and largest_loads.csv for one run, or for several designs.

    Parameters
    ----------
    results
        Results of runs with ``output.forces``.
    folder
        Folder of the page.
    inputs
        Inputs of the rules. [default: none]

    Returns
    -------
    Path
        The page.

    Raises
    ------
    MissingResultError
        If a run did not record forces.
    """
    import pandas as pd

    designs = [Design(run, name) for run, name in zip(results, _names(results))]
    several = len(designs) > 1
    table = pd.concat(
        [
            design.largest.assign(design=design.name) if several else design.largest
            for design in designs
        ],
        ignore_index=True,
    )
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(table, folder / TABLE, float_format="%.6g")
    page = template("snowshed.plot", "loads.html.j2").render(
        title="Loads of the snow",
        sentence=" ".join(design.sentence(named=several) for design in designs),
        warnings=list(dict.fromkeys(text for design in designs for text in design.warnings)),
        comparison=_comparison(designs) if several else None,
        designs=[design.section(inputs or RuleInputs(), named=several) for design in designs],
        assumptions=[
            text for text in ASSUMPTIONS if text != IN_2D or any(design.per for design in designs)
        ],
        table=TABLE,
    )
    write_text(folder / PAGE, page)
    return folder / PAGE


IN_2D = (
    "In 2D every part is as wide as the scene: a post is a wall. Give the panel a width for posts."
)
ASSUMPTIONS = (
    "Forces act from the snow on the obstacle. x points in the slide direction, z upwards.",
    "A load is that of the snow that touches a part. A post also carries the panel above it: add "
    "the load on the panel.",
    "At rest means after the event. The snow that lies on a slope before it slides is not in the "
    "table; its weight stands above the rules.",
    "Snow lies without stress when an event begins. In the first hundredths of a second, the part "
    "on which it lies has a peak of up to twice its weight, which is no load of sliding snow.",
    "A peak is the largest mean over the named time. A structure answers to it by its own period: "
    "a beam of 20 Hz hardly notices 1 ms.",
    "The snow is the snow of the scene. Wet or icy snow, and blocks of ice, hit harder.",
    "Obstacles are rigid and stand still. A beam that yields receives a smaller peak.",
    IN_2D,
    "Creep and settling over weeks are not simulated. Settling snow pulls down a lower edge that "
    "it buries; no rule for this was found that could be read in its source, so none is given.",
)


class Design:
    """The loads of one run."""

    def __init__(self, results: Results, name: str) -> None:
        self.results, self.scene, self.name = results, results.scene.data, name
        self.loads: pd.DataFrame = results.loads
        self.largest = structure_loads(self.loads)
        self.per = "/m" if self.scene["dimension"] == 2 else ""
        self.slope = SnowSlope.of(results.scene) if self.scene.get("panel") else None

    @cached_property
    def forces(self) -> xarray.Dataset:
        """The forces over time."""
        return cast("xarray.Dataset", self.results.forces)

    def sentence(self, *, named: bool) -> str:
        """Return the largest loads on the most loaded structure in a sentence."""
        structures = self.largest[~self.largest["obstacle"].isin(CARRIERS)]
        row = (structures if len(structures) else self.largest).sort_values("peak_10ms_n").iloc[-1]
        start = f"{self.name}: the" if named else "The"
        return (
            f"{start} snow loads {row['obstacle']} with {self._kn(row['peak_10ms_n'])} for "
            f"10 ms, and with {self._kn(row['rest_n'])} at rest."
        )

    @property
    def warnings(self) -> list[str]:
        """Limits of the loads, a sentence each."""
        sentences = [peak_error_sentence(self.scene)]
        if note := unfinished_note(self.results.folder):
            sentences.insert(0, f"{note}.")
        if (self.loads["at_rest"] == 0).any():
            sentences.append(
                "An event ended at its time limit: its loads at rest are those of snow that moves."
            )
        share = self._unbalanced_share()
        if share > MAX_UNBALANCED:
            sentences.append(
                f"The impulses of obstacles and gravity leave {percent(share)} of the largest "
                "impulse unexplained: the method itself changes the momentum by that much."
            )
        return sentences

    def _unbalanced_share(self) -> float:
        from snowshed.results.obstacle_forces import UNBALANCED, on_obstacles

        impulses = (self.forces.force * self.forces.duration).sum("time")
        sizes = (impulses**2).sum("component") ** 0.5
        largest = float(on_obstacles(sizes).max())
        return float(sizes.sel(obstacle=UNBALANCED)) / largest if largest > 0.0 else 0.0

    def section(self, inputs: RuleInputs, *, named: bool) -> dict[str, Any]:
        """Return the section of the page."""
        return {
            "title": self.name if named else None,
            "loads": self._load_grid(),
            "forces": self._forces_picture(),
            "pressures": self._pressures_picture(),
            "landing": self._landing_grid(),
            "reach": self._reach_grid(),
            "rules": self._rules(inputs),
        }

    def _kn(self, newtons: float) -> str:
        return f"{kilo(newtons)} kN{self.per}"

    def _load_grid(self) -> HtmlTable:
        rows = []
        for row in self.largest.to_dict("records"):
            peaks = [kilo(row[f"peak_{window}ms_n"]) for window in WINDOWS]
            rows.append(
                (
                    row["obstacle"],
                    *(kilo(row[f"rest_{name}"]) for name in ("n", "fx_n")),
                    kilo(-row["rest_fz_n"]),
                    *peaks,
                    kilo(row["peak_10ms_fx_n"]),
                    kilo(-row["peak_10ms_fz_n"]),
                    f"{row['peak_10ms_time_s']:.2f}",
                    kilo(row["rest_pressure_pa"]),
                    kilo(row["peak_pressure_pa"]),
                )
            )
        head = (
            "on", "in all", "along x", "down", *(f"{window} ms" for window in WINDOWS),
            "along x", "down", "at, s", "at rest", "10 ms",
        )  # fmt: skip
        kn = f"kN{self.per}"
        groups = (("", 1), (f"at rest, {kn}", 3), (f"peaks, {kn}", 3),
                  (f"the peak of 10 ms, {kn}", 3), ("pressure, kPa", 2))  # fmt: skip
        return HtmlTable(head, rows, "l" + "r" * (len(head) - 1), groups)

    def _forces_picture(self) -> Picture:
        from snowshed.plot.forces_figure import forces_figure
        from snowshed.results.obstacle_forces import on_obstacles

        return Picture.drawn(
            forces_figure(on_obstacles(self.forces), self.scene), f"forces-{self.name}",
            "Forces over time", "All rows are in forces.csv.",
        )  # fmt: skip

    def _pressures_picture(self) -> Optional[Picture]:
        from snowshed.plot.forces_figure import pressures_figure

        if self.scene["dimension"] != 2:
            return None  # the faces are in pressures/, for ParaView
        edge = float(self.loads["patch_m"].iloc[0])
        return Picture.drawn(
            pressures_figure(self.results.pressures, self.scene), f"pressures-{self.name}",
            "Pressures on faces", f"Means over patches of {100 * edge:.3g} cm, last event.",
        )  # fmt: skip

    def _landing_grid(self) -> Optional[HtmlTable]:
        """Return the free flight of the first, the middle and the last snow of the slab."""
        panel = self.scene.get("panel")
        if not panel or self.slope is None:
            return None
        rows = []
        for part, label in ((0.0, "at the edge"), (0.5, "halfway up"), (1.0, "at the upper end")):
            flight = landing(
                part * self.slope.length, panel["tilt"], panel["friction"],
                panel["height"], self.scene["gravity"], ground_tilt(self.scene),
            )  # fmt: skip
            rows.append(
                (
                    label,
                    f"{flight.edge_speed:.1f}",
                    f"{flight.distance:.2f}",
                    f"{flight.speed:.1f}",
                    f"{flight.angle:.0f}",
                )
            )
        head = (
            "snow that lay", "speed at the edge, m/s", "lands from the edge, m",
            "speed of landing, m/s", "degrees down",
        )  # fmt: skip
        return HtmlTable(head, rows, "lrrrr")

    def _reach_grid(self) -> Optional[HtmlTable]:
        """Return the distances from the edge beyond which shares of each event's snow rest."""
        if self.slope is None:
            return None
        edge, rows = panel_edge(self.scene), []
        tilt = np.radians(self.scene["panel"]["tilt"])
        particles = self.results.particles()
        behind = particles.position.to_numpy()[:, 0] < edge.x - self.slope.length * np.cos(tilt)
        for event in np.unique(particles.event.to_numpy()):
            of_event = (particles.event.to_numpy() == event) & ~behind
            if not of_event.any():
                continue
            distances = particles.position.to_numpy()[of_event, 0] - edge.x
            masses = particles.mass.to_numpy()[of_event]
            far = [distance_passed_by(share, distances, masses) for share in SHARES]
            rows.append((f"{event}", *(f"{x:.2f}" for x in far), f"{distances.max():.2f}"))
        head = ("event", *(f"{percent(share)} beyond, m" for share in SHARES), "farthest, m")
        return HtmlTable(head, rows, "r" * len(head))

    def _rules(self, inputs: RuleInputs) -> Optional[dict[str, Any]]:
        """Return the table of rules, and where each of them ends."""
        panel = self.scene.get("panel")
        if not panel or self.slope is None:
            return None
        evaluated = rules(self.slope.length, panel["tilt"], inputs)
        rows = [
            (rule.name, _value(rule), rule.clause, rule.formula, rule.inputs) for rule in evaluated
        ]
        head = ("load", "value", "clause", "formula", "inputs")
        limits = [f"{rule.clause}: {rule.limits} Read in {rule.source}." for rule in evaluated]
        return {
            "table": HtmlTable(head, rows, "lllll"),
            "limits": limits,
            "snow": self._snow_sentence(self.slope, inputs.snow_load),
        }

    def _snow_sentence(self, slope: SnowSlope, snow_load: Optional[float]) -> str:
        """Compare the simulated snow on the slope with that of the rules."""
        text = (
            f"The simulated snow of the first event lies on a slope of {slope.length:.2f} m and "
            f"weighs {slope.load / 1000:.2f} kN/m² on plan."
        )
        if snow_load is None:
            return text
        same = abs(slope.load / (1000.0 * snow_load) - 1.0) < SAME_SNOW
        return f"{text} The rules use {snow_load:g} kN/m²" + (
            "." if same else ": this is other snow, so do not compare their loads with the table."
        )


def _names(results: Sequence[Results]) -> list[str]:
    """Return the names of designs: the titles of their scenes, or their folders, if they differ."""
    titles = [str(run.scene.data.get("title") or "") for run in results]
    folders = [run.folder.parent if run.folder.name == "run" else run.folder for run in results]
    for names in (
        titles,
        [folder.name for folder in folders],
        [str(run.folder) for run in results],
    ):
        if all(names) and len(set(names)) == len(names):
            return names
    return [f"design {number}" for number in range(1, len(results) + 1)]


def _value(rule: Rule) -> str:
    if rule.value is None:
        return f"needs {', '.join(rule.missing)}"
    return f"{rule.value:.2f} {rule.unit}"


def _comparison(designs: Sequence[Design]) -> HtmlTable:
    """Return the largest loads of several designs beside each other."""
    names = list(dict.fromkeys(name for design in designs for name in design.largest["obstacle"]))
    rows = []
    for name in names:
        cells = []
        for design in designs:
            of_name = design.largest[design.largest["obstacle"] == name]
            cells.append(_both(of_name.iloc[0]) if len(of_name) else "")
        rows.append((name, *cells))
    head = ("on", *(design.name for design in designs))
    return HtmlTable(head, rows, "l" + "r" * len(designs))


def _both(row: Mapping[str, Any]) -> str:
    return f"{kilo(row['peak_10ms_n'])} (10 ms), {kilo(row['rest_n'])} (rest)"
