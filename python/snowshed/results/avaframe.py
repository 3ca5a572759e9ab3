"""Results of a slide in the layout of AvaFrame 2.1, so that its tools and QGIS read them.

AvaFrame's module com5SnowSlide runs com1DFA, whose results are in ``Outputs/com1DFA``. The same
files are in ``Outputs/com5SnowSlide``, where AvaFrame's tools look for results of that module:

============================================= ================================================
peakFiles/NAME_{ppr,pft,pfv}.asc or .tif      peak maps at the end, in the terrain's format
peakFiles/timeSteps/NAME_TYPE_tTIME.asc       maps at the times of tSteps, and at the end
configurationFiles/NAME.ini                   settings of the simulation
configurationFiles/allConfigurations.csv      settings of all simulations, a row each
mass_NAME.txt                                 mass at the start and at the end
============================================= ================================================

NAME is RELEASE_HASH_com5_C_L_TYPE_ssl, with _AF after a release whose name has an underscore.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, product
from pathlib import Path
from typing import TYPE_CHECKING

import snowshed._core as _core
from snowshed.base.arrays import Floats, Numbers
from snowshed.base.messages import csv_cell, printable
from snowshed.io.atomic import write_text
from snowshed.io.raster.output import write_raster
from snowshed.io.raster.raster import GEOTIFF, Raster, read_raster
from snowshed.methods.slide.maps import SlideMaps, map_file, rasters_of, slide_maps
from snowshed.methods.slide.summary import SlideSummary
from snowshed.scene.builders.avaframe.keys import GROUND_SWITCHES
from snowshed.scene.builders.avaframe.project import AvaFrameSimulation
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    import pandas as pd

MODULES = ("com1DFA", "com5SnowSlide")
STEPS_AT_ONCE = 20
#: Settings under AvaFrame's names.
NUMERICS: Mapping[str, str] = {
    "dt": "time_step",
    "rho": "density",
    "meshCellSize": "cell",
    "deltaTh": "layer_thickness",
    "cohesionMaxStrain": "max_strain",
    "cohesiveSurfaceTension": "bond_modulus",
    "minDistCohesion": "min_bond_length",
    "cResH": "resistance",
    "detK": "detrainment",
    "forestVMin": "forest_min_speed",
    "forestThMin": "forest_min_thickness",
    "forestVMax": "forest_max_speed",
    "forestThMax": "forest_max_thickness",
    "subgridMixingFactor": "artificial_viscosity",
    "rhoEnt": "entrained_density",
    "entEroEnergy": "erosion_energy",
    "entShearResistance": "entrainment_shear",
    "entDefResistance": "entrainment_work",
    "thresholdMassSplit": "split_ratio",
    "stopCrit": "stop_ratio",
    "thresholdAdaptSfc": "ground_min_change",
}
#: Columns of times that AvaFrame's tools need; they stay empty.
TIMINGS = (
    "timeLoop", "timeForce", "timeForceSPH", "timePos", "timeNeigh", "timeField", "nSave",
)  # fmt: skip


def simulation_name(simulation: AvaFrameSimulation) -> str:
    """Return the name of a simulation, in the form that AvaFrame's ``parseSimName`` reads."""
    return _name(simulation, simulation.scene.resolve())


def write_avaframe_outputs(folder: Path, simulation: AvaFrameSimulation, results: Path) -> str:
    """Write the maps and settings of a simulation that has ended, and return its name.

    Parameters
    ----------
    folder
        The folder that holds ``Outputs``.
    simulation
        The scene of the simulation, with AvaFrame's settings.
    results
        The simulation's results folder. For maps at earlier times, the steps are run again.

    Raises
    ------
    InputError
        If the output is a GeoTIFF and rasterio is missing.
    OSError
        If a file cannot be read or written.
    """
    resolved = simulation.scene.resolve()
    name = _name(simulation, resolved)
    summary = SlideSummary.read(results)
    time_step = float(resolved.data["numerics"]["time_step"])
    last = round(summary.sim_time_s / time_step)
    ending = ".tif" if simulation.terrain.suffix.lower() in GEOTIFF else ".asc"
    peaks = [folder / "Outputs" / module / "peakFiles" for module in MODULES]
    for each in peaks:
        (each / "timeSteps").mkdir(parents=True, exist_ok=True)
    final = _final_maps(results, resolved)
    kinds = simulation.project.result_types
    # AvaFrame names the end by the step after it.
    at_end = [((last + 1) * time_step, final)]
    for time, fields in chain(_earlier_maps(simulation, resolved, last), at_end):
        for each, kind in product(peaks, kinds):
            write_raster(each / "timeSteps" / f"{name}_{kind}_t{time:.2f}{ending}", fields[kind])
    configuration = _configuration(simulation, resolved)
    for each in peaks:
        for kind in kinds:
            write_raster(each / f"{name}_{kind}{ending}", final[kind])
        write_text(each.parent / f"mass_{name}.txt", _mass_table(summary))
        _write_configuration(each.parent / "configurationFiles", name, configuration, summary, last)
    return name


def particle_table(quantities: Mapping[str, Numbers]) -> pd.DataFrame:
    """Return particles of a slide as a table with AvaFrame's names.

    Parameters
    ----------
    quantities
        As in `snowshed.methods.slide.states.SlideState`.

    Returns
    -------
    pandas.DataFrame
        Columns ID, x, y, z [m], ux, uy, uz [m/s], m [kg], h [m].
    """
    import pandas as pd

    position, velocity = quantities["position"], quantities["velocity"]
    return pd.DataFrame(
        {
            "ID": quantities["id"],
            **{axis: position[:, k] for k, axis in enumerate("xyz")},
            **{f"u{axis}": velocity[:, k] for k, axis in enumerate("xyz")},
            "m": quantities["mass"],
            "h": quantities["thickness"],
        }
    )


def _final_maps(results: Path, resolved: ResolvedScene) -> dict[str, Raster]:
    """Return the maps at the end by type, from a results folder."""
    numerics = resolved.data["numerics"]
    changes_ground = any(numerics[name] for name in GROUND_SWITCHES.values())
    maps = {
        stem.rpartition("/")[2]: read_raster(map_file(results, name))
        for name, stem in rasters_of(changes_ground=changes_ground).items()
    }
    maps["P"] = replace(maps["FV"], heights=_pressure(resolved, maps["FV"].heights))
    crs = _crs(resolved)
    return {kind: replace(raster, crs=crs) for kind, raster in maps.items()}


def _earlier_maps(
    simulation: AvaFrameSimulation, resolved: ResolvedScene, last: int
) -> Iterator[tuple[float, dict[str, Raster]]]:
    """Yield the maps by type at the requested times except the end, time after time.

    They are made one by one, because a terrain's maps at thousands of times do not fit into memory.
    """
    time_step = float(resolved.data["numerics"]["time_step"])
    steps = {_step_at(time, time_step): time for time in simulation.project.saved_times}
    crs = _crs(resolved)
    for step, maps in maps_at(resolved, [step for step in steps if step <= last]):
        fields = _fields(resolved, maps)
        yield steps[step], {kind: maps.raster(values, crs) for kind, values in fields.items()}


def maps_at(resolved: ResolvedScene, steps: Sequence[int]) -> Iterator[tuple[int, SlideMaps]]:
    """Yield the maps of a slide after given numbers of steps, one after another."""
    if not steps:
        return
    simulation = _core.Simulation(resolved.core, resolved.base_dir)
    simulation.begin_event()
    done = 0
    for step in sorted(steps):
        while done < step:  # Ctrl-C takes effect between the parts
            part = min(step - done, STEPS_AT_ONCE)
            simulation.step(part)
            done += part
        yield step, slide_maps(simulation)


def _name(simulation: AvaFrameSimulation, resolved: ResolvedScene) -> str:
    terrain = {**resolved.data["terrain"], "file": "", "thickness_file": ""}
    content = {**resolved.data, "title": "", "terrain": terrain}
    text = json.dumps(content, sort_keys=True) + simulation.release
    identity = hashlib.shake_256(text.encode()).hexdigest(5)
    release = simulation.release + ("_AF" if "_" in simulation.release else "")
    return f"{release}_{identity}_com5_C_L_{simulation.sim_type}_ssl"


def _step_at(time: float, time_step: float) -> int:
    """Return the first step that ends at a time or after it."""
    return math.ceil((time - 1e-8) / time_step)


def _crs(resolved: ResolvedScene) -> str:
    return str(resolved.data["terrain"].get("crs", ""))


def _fields(resolved: ResolvedScene, maps: SlideMaps) -> dict[str, Floats]:
    return {
        "ppr": maps.peak_pressure,
        "pft": maps.peak_thickness,
        "pfv": maps.peak_speed,
        "FT": maps.thickness,
        "FV": maps.speed,
        "P": _pressure(resolved, maps.speed),
    }


def _pressure(resolved: ResolvedScene, speed: Floats) -> Floats:
    """Return the dynamic pressure, Pa; only its peak is in kPa, as in AvaFrame."""
    pressure: Floats = float(resolved.data["numerics"]["density"]) * speed**2
    return pressure


def _configuration(
    simulation: AvaFrameSimulation, resolved: ResolvedScene
) -> dict[str, dict[str, str]]:
    """Return the settings by section and key, as AvaFrame writes them."""
    data = resolved.data
    numerics, terrain = data["numerics"], data["terrain"]
    project = simulation.project
    voellmy = numerics["friction_law"] == "voellmy"
    general = {
        "simTypeList": "|".join(project.sim_types),
        "simTypeActual": simulation.sim_type,
        "modelType": "ssl",
        "resType": "|".join(project.result_types),
        "tSteps": "|".join(f"{time:g}" for time in project.saved_times),
        "initPartDistType": "triangular",
        "tEnd": repr(data["events"]["max_time"]),
        "frictModel": "Voellmy" if voellmy else "Coulomb",
        "muvoellmy" if voellmy else "mucoulomb": repr(numerics["friction"]),
        "xsivoellmy": repr(numerics["turbulence"]),
        "explicitFriction": str(int(numerics["explicit_friction"])),
        "snowSlide": str(int(numerics["bonds"])),
        "secRelArea": str(bool(terrain.get("secondary_release"))),
        "adaptSfcStopped": str(int(numerics["ground_gains_stopped"])),
        "adaptSfcDetrainment": str(int(numerics["ground_gains_detrained"])),
        "adaptSfcEntrainment": str(int(numerics["ground_loses_entrained"])),
        "dam": str(bool(terrain.get("dams"))),
        "detrainment": str(numerics["detrainment"] > 0.0),
        "timeDependentRelease": str(bool(simulation.hydrograph)),
        "timeDependentReleaseScenarios": simulation.hydrograph,
        "relThFromFile": str(project.release_thickness is None),
        "relTh": "" if project.release_thickness is None else repr(project.release_thickness),
        "entThFromFile": str(project.entrained_thickness is None),
        "entTh": "" if project.entrained_thickness is None else repr(project.entrained_thickness),
        "avalancheDir": str(simulation.folder),
    }
    general.update({key: repr(numerics[name]) for key, name in NUMERICS.items()})
    for prefix, areas in (("relTh", "release"), ("entTh", "entrainment")):
        for number, area in enumerate(terrain.get(areas) or ()):
            general[f"{prefix}{number}"] = repr(area["thickness"])
    released = terrain["release"]
    inputs = {
        "releaseScenario": simulation.release,
        "relThFile": "",
        "relThId": "|".join(str(number) for number in range(len(released))),
        "relThThickness": "|".join(repr(area["thickness"]) for area in released),
        "DEM": Path(terrain["file"]).name,
    }
    return {
        "GENERAL": general,
        "INPUT": inputs,
        "EXPORTS": {"exportData": "True", "useCompression": "True"},
        "VISUALISATION": {"scenario": ""},
    }


def _write_configuration(
    folder: Path, name: str, sections: Mapping[str, Mapping[str, str]], summary: SlideSummary,
    steps: int,
) -> None:  # fmt: skip
    for place in ("", "configurationFilesDone", "configurationFilesLatest"):
        (folder / place).mkdir(parents=True, exist_ok=True)
    text = "".join(
        f"[{section}]\n"
        + "".join(f"{key} = {_on_one_line(value)}\n" for key, value in keys.items())
        + "\n"
        for section, keys in sections.items()
    )
    write_text(folder / f"{name}.ini", text)
    for place in ("configurationFilesDone", "configurationFilesLatest"):
        write_text(folder / place / f"{name}.ini", "see directory configurationFiles\n")
    row = {"": name.split("_com5", maxsplit=1)[0].rsplit("_", 1)[1]}
    for keys in sections.values():
        row.update(keys)
    row.update({"simName": name, "nPart": str(summary.final_particles), "nIter": str(steps)})
    row.update(dict.fromkeys(TIMINGS, ""))
    for table in ("allConfigurations.csv", "latestSims.csv"):
        _add_row(folder / table, row)


def _on_one_line(value: str) -> str:
    return printable(" ".join(value.split("\n")))


def _add_row(file: Path, row: Mapping[str, str]) -> None:
    """Add a row to a table; it replaces a row of the same simulation."""
    rows: list[Mapping[str, str]] = []
    if file.is_file():
        with file.open(newline="", encoding="utf-8") as text:
            rows = [old for old in csv.DictReader(text) if old.get("simName") != row["simName"]]
    rows.append(row)
    columns = list(dict.fromkeys(key for each in rows for key in each))
    target = io.StringIO()
    writer = csv.DictWriter(target, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: csv_cell(cell) for key, cell in each.items()} for each in rows)
    write_text(file, target.getvalue())


def _mass_table(summary: SlideSummary) -> str:
    lines = ["time, current, entrained, detrained, detrainedTotal, stopped, initialized"]
    late = summary.secondary_kg + summary.inflow_kg
    for time, now, entrained, detrained, stopped, released in (
        (0.0, summary.released_kg, 0.0, 0.0, 0.0, summary.released_kg),
        (
            summary.sim_time_s,
            summary.on_terrain_kg,
            summary.entrained_kg,
            summary.detrained_kg,
            summary.stopped_kg,
            late,
        ),
    ):
        lines.append(
            f"{time:.2f},    {now:.6f},    {entrained:.6f},   {0.0 - detrained:.6f},    "
            f"{0.0 - detrained:.6f},    {0.0 - stopped:.6f},    {released:.6f}"
        )
    return "\n".join(lines) + "\n"
