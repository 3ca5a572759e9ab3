"""What is odd about a scene, told before it runs and after."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from snowshed.methods.registry import resolution_of

if TYPE_CHECKING:
    import pandas as pd

FEW = 2.0  # cells; a thinner slab is coarse
ALL_STAYS = 0.98  # of the snow


def notes_before(scene: Mapping[str, Any]) -> list[str]:
    """Return what a run of a scene should be warned of, a sentence each.

    Parameters
    ----------
    scene
        Complete scene data.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> coarse = Scene.preset("lab-50").update({"numerics.dx": 0.1, "dimension": 2})
    >>> notes_before(coarse.resolve().data)
    ['the slab is 20 mm thick, less than two cells of 100 mm: its stack is coarse; try --dx 0.01']
    """
    found = []
    dx = resolution_of(scene)
    slab = scene.get("slab")
    if not scene.get("ground") and not scene.get("obstacles") and not scene.get("domain"):
        found.append(
            "the scene has no ground, no domain and no obstacles: snow falls for as long as "
            "events.max_time; add ground"
        )
    if slab and not slab.get("layers") and slab["thickness"] < FEW * dx:
        found.append(
            f"the slab is {1000 * slab['thickness']:.3g} mm thick, less than two cells of "
            f"{1000 * dx:.3g} mm: its stack is coarse; try --dx {slab['thickness'] / FEW:.2g}"
        )
    return found


def notes_after(table: pd.DataFrame) -> list[str]:
    """Return what the table of events should be read with, a sentence each.

    Parameters
    ----------
    table
        As in events.csv.

    Examples
    --------
    >>> import pandas as pd
    >>> notes_after(pd.DataFrame({"mass_kg": [0.0], "on_panel_kg": [2.0]}))
    ['nothing slid: the snow stays on the panel; there is no stack to measure']
    """
    last = table.iloc[-1]
    held = last["on_panel_kg"] + last.get("on_structures_kg", 0.0)
    if held <= 0.0:
        return []
    part = held / (held + last["mass_kg"])
    if last["mass_kg"] == 0.0:
        return ["nothing slid: the snow stays on the panel; there is no stack to measure"]
    if part >= ALL_STAYS:
        return [f"next to nothing slid: {100 * part:.1f} % of the snow stays on the panel"]
    if part >= 1.0 - ALL_STAYS:
        return [f"{100 * part:.0f} % of the snow stays on the panel or on structures"]
    return []
