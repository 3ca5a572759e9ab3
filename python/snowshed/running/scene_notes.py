"""Warnings about a scene, before it runs and after."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.formatting import plural
from snowshed.methods.registry import method_of, resolution_of
from snowshed.scene.accuracy_settings import MIN_CELLS_ACROSS
from snowshed.scene.components import Snow
from snowshed.snow.accuracy.stack_errors import error_sentence
from snowshed.snow.relations.strength import TENSILE_STRENGTH

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.scene.scene import ResolvedScene

NEARLY_ALL = 0.98  # share of the snow
#: The relation by which strength follows from density.
LAW = "sigrist-2006"
MAX_SEEDED_PARTICLES = 100_000  # particles; seeding so many takes two seconds
#: Parts of a scene, besides a panel, on which snow can land.
FLOORS = ("ground", "obstacles", "domain")


def notes_before(scene: Mapping[str, Any]) -> list[str]:
    """Return warnings about a scene before it runs, a sentence each.

    Parameters
    ----------
    scene
        Complete scene data.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> coarse = Scene.preset("lab-50").update({"numerics.dx": 0.1, "dimension": 2})
    >>> notes_before(coarse.resolve().data)
    ['the slab is 20 mm thick, less than two cells of 100 mm: its stack is coarse; try dx = 0.01 m']
    """
    method = method_of(scene)
    if "stack" not in method.results:
        return []
    notes = []
    if not any(scene.get(part) for part in FLOORS):
        notes.append(
            "the scene has no ground, no domain and no obstacles: snow falls for as long as "
            "events.max_time; add ground"
        )
    notes += _density_notes(scene.get("snow") or {})
    size = resolution_of(scene)
    thickness = _slab_thickness(scene)
    if thickness is not None and thickness < MIN_CELLS_ACROSS * size:
        notes.append(
            f"the slab is {1000 * thickness:.3g} mm thick, less than two "
            f"{method.settings.ELEMENTS} of {1000 * size:.3g} mm: its stack is coarse; try "
            f"{method.settings.RESOLUTION} = {thickness / MIN_CELLS_ACROSS:.2g} m"
        )
    return notes + _notes_on_coarse_bodies(scene, size, method.settings.ELEMENTS)


def _notes_on_coarse_bodies(scene: Mapping[str, Any], size: float, elements: str) -> list[str]:
    """Return a note if a box of snow is less than two cells thick.

    Examples
    --------
    >>> body = {"shape": {"type": "box", "size": [0.2, 0.01]}}
    >>> _notes_on_coarse_bodies({"bodies": [body]}, 0.02, "cells")
    ['/bodies/0: the box is 10 mm thick, less than two cells of 20 mm: its snow is coarse']
    """
    return [
        f"/bodies/{number}: the box is {1000 * thickness:.3g} mm thick, less than two {elements} "
        f"of {1000 * size:.3g} mm: its snow is coarse"
        for number, body in enumerate(scene.get("bodies", ()))
        if body["shape"]["type"] == "box"
        and (thickness := min(body["shape"]["size"])) < MIN_CELLS_ACROSS * size
    ]


def _density_notes(snow: Mapping[str, Any]) -> list[str]:
    """Return a note if the strength of snow follows from its density, or does not although it may.

    Examples
    --------
    >>> from snowshed.scene.components import Snow
    >>> from snowshed.scene.scene import Scene
    >>> light = Scene.preset("lab-50").set("snow", Snow(density=80)).resolve().data["snow"]
    >>> _density_notes(light)[0][:60]
    'stiffness and strength follow from the density of 80 kg/m3 ('
    """
    usual: Mapping[str, Any] = Snow.preset("calibrated").to_data()
    density = snow.get("density")
    if density in (None, usual["density"]) or snow.get("model") != usual["model"]:
        return []
    own = f"the density of {density:g} kg/m3"
    strength = float(snow["preconsolidation_pressure"])
    law = TENSILE_STRENGTH[LAW]
    try:
        expected = usual["preconsolidation_pressure"] * law(density) / law(usual["density"])
    except InputError:  # the core notes a density that snow cannot have
        return []
    if abs(strength / expected - 1.0) < 1e-6:
        return [
            f"stiffness and strength follow from {own} ({LAW}): Young's modulus "
            f"{snow['youngs_modulus'] / 1e6:.3g} MPa, preconsolidation pressure "
            f"{strength / 1e3:.3g} kPa"
        ]
    if strength == usual["preconsolidation_pressure"]:
        return [
            f"the strength is that of snow of {usual['density']:g} kg/m3; for {own}, {LAW} gives a "
            f"preconsolidation pressure of {expected / 1e3:.3g} kPa"
        ]
    return []


def notes_of_beginning(scene: ResolvedScene) -> list[str]:
    """Lay the snow of the first event, and return the notes that a run makes up to its first step.

    Parameters
    ----------
    scene
        The scene. No snow is laid if it needs more than `MAX_SEEDED_PARTICLES` particles.

    Raises
    ------
    InputError
        If a run would be refused.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> notes_of_beginning(Scene.preset("lab-50").set("dimension", 2).resolve())
    []
    """
    notes = notes_before(scene.data)
    simulation = _core.Simulation(scene.core, scene.base_dir)
    if simulation.expected_particles > MAX_SEEDED_PARTICLES:
        notes.append(
            f"the scene has more than {MAX_SEEDED_PARTICLES} particles: the run itself checks "
            "whether snow lies in obstacles or in other snow"
        )
    else:
        simulation.begin_event()
    notes += simulation.notes
    return notes


def _slab_thickness(scene: Mapping[str, Any]) -> Optional[float]:
    """Return the thickness of a slab that is the same in all events, m; None without one."""
    slab = scene.get("slab")
    layers = slab["layers"] if slab else []
    if not slab or any(layer["event"] for layer in layers):
        return None
    return float(slab["thickness"] or sum(layer["thickness"] for layer in layers))


def notes_after(table: pd.DataFrame, scene: Mapping[str, Any]) -> list[str]:
    """Return notes on the table of events, a sentence each.

    Parameters
    ----------
    table
        As in events.csv.
    scene
        Complete scene data.

    Examples
    --------
    >>> import pandas as pd
    >>> notes_after(pd.DataFrame({"mass_kg": [0.0], "on_panel_kg": [2.0]}), {"panel": {}})
    ['nothing slid: the snow stays on the panel; there is no stack to measure']
    """
    return [
        *_notes_on_ends(table),
        *_notes_on_records(table, scene),
        *_notes_on_snow_that_stays(table.iloc[-1], scene),
    ]


def notes_of_end(table: pd.DataFrame, scene: ResolvedScene) -> list[str]:
    """Return the notes on a finished run: those on its events, and the error of its last stack.

    Examples
    --------
    >>> import pandas as pd
    >>> from snowshed import Scene
    >>> table = pd.DataFrame({"mass_kg": [1.0], "on_panel_kg": [0.0], "height_m": [0.1]})
    >>> notes = notes_of_end(table, Scene.preset("lab-50").resolve())
    >>> [note[:18] for note in notes]
    ['error of the stack']
    """
    has_stack = table["height_m"].iloc[-1] > 0
    error = error_sentence(scene) if has_stack else ""
    return [*notes_after(table, scene.data), *([error] if error else [])]


def _notes_on_ends(table: pd.DataFrame) -> list[str]:
    """Return a note if snow still moved when its event ended.

    Examples
    --------
    >>> import pandas as pd
    >>> _notes_on_ends(pd.DataFrame({"ended": ["rest", "time_limit"]}))[0][:48]
    '1 of 2 events ended before the snow rested; allo'
    """
    moving = int((table["ended"] == "time_limit").sum()) if "ended" in table else 0
    if not moving:
        return []
    return [
        f"{moving} of {plural(len(table), 'event')} ended before the snow rested; allow a longer "
        "events.max_time"
    ]


def _notes_on_snow_that_stays(last: pd.Series[Any], scene: Mapping[str, Any]) -> list[str]:
    """Return a note if much of the snow lies on the panel or on structures after the last event."""
    held = last["on_panel_kg"] + last.get("on_structures_kg", 0.0)
    if held <= 0.0:
        return []
    holders = [("the panel", "panel" in scene), ("structures", bool(scene.get("obstacles")))]
    where = " or on ".join(name for name, given in holders if given)
    slides = "slid" if "panel" in scene else "fell"
    part = held / (held + last["mass_kg"])
    if last["mass_kg"] == 0.0:
        return [f"nothing {slides}: the snow stays on {where}; there is no stack to measure"]
    if part >= NEARLY_ALL:
        return [f"next to nothing {slides}: {100 * part:.1f} % of the snow stays on {where}"]
    if part >= 1.0 - NEARLY_ALL:
        return [f"{100 * part:.0f} % of the snow stays on {where}"]
    return []


def _notes_on_records(table: pd.DataFrame, scene: Mapping[str, Any]) -> list[str]:
    """Return notes on intervals of records that are longer than any event was.

    Examples
    --------
    >>> import pandas as pd
    >>> times = pd.DataFrame({"sim_time_s": [0.7, 0.9]})
    >>> _notes_on_records(times, {"output": {"snapshot_interval": 10.0, "film": False}})
    ['output.snapshot_interval: 10 s is longer than any event was, at most 0.9 s']
    """
    output = scene.get("output", {})
    if "sim_time_s" not in table or not output:
        return []
    longest = float(table["sim_time_s"].max())
    names = ["snapshot_interval"]
    names += ["film_interval"] * output["film"] + ["force_interval"] * output.get("forces", False)
    return [
        f"output.{name}: {output[name]:g} s is longer than any event was, at most {longest:.3g} s"
        for name in names
        if output[name] > longest
    ]
