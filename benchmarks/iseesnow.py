"""Compare snow slides without bonds with the avalanche models of ISeeSnow.

Usage: python -m benchmarks.iseesnow FOLDER [CASE ...]

ISeeSnow is an intercomparison of avalanche models (doi:10.5194/egusphere-2025-6053), whose data are
under EUPL-1.2 and not part of snowshed. FOLDER has one folder per case with the elevations
(``DEM_*.asc``), the release (``*.shp``) and the peak rasters of a model (``*_pft.asc``, thickness
in m, and ``*_pfv.asc``, speed in m/s); rasters may be packed (``.xz``). The release is 1.5 m thick
and mu is 0.4. xi is 2000 m/s2, except in cases with Coulomb in their name, which have no xi. There
are no bonds, and all other settings are the defaults.

The program prints for both models, with their relative difference:

- peak speed and peak thickness: the largest values of the rasters;
- area: the number of cells whose peak thickness exceeds 0.1 m, times the area of a cell;
- farthest x: the largest coordinate among these cells;

It also compares the cells in which either thickness exceeds 0.1 m: it prints the mean absolute
difference, relative to the mean of the model's values, and the share of these cells in which both
exceed it.
"""

from __future__ import annotations

import argparse
import lzma
import shutil
import tempfile
import time
from pathlib import Path

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.io.raster.raster import Raster, read_raster
from snowshed.methods.slide.settings import SlideSettings
from snowshed.running.run import run
from snowshed.scene.builders.slides import slide_scene

THICKNESS, FRICTION, TURBULENCE = 1.5, 0.4, 2000.0  # m, 1, m/s2
MIN_THICKNESS = 0.1  # m


def unpacked(folder: Path, pattern: str, to: Path) -> Path:
    """Return the file that matches a pattern in a folder, or an unpacked copy of it."""
    files = sorted([*folder.glob(pattern), *folder.glob(pattern + ".xz")])
    if not files:
        raise SystemExit(f"{folder}: there is no {pattern}")
    if files[0].suffix != ".xz":
        return files[0]
    copy = to / files[0].stem
    with lzma.open(files[0]) as packed, copy.open("wb") as plain:
        shutil.copyfileobj(packed, plain)
    return copy


def our_peaks(case: Path, folder: Path, changes: dict[str, object]) -> tuple[Raster, Raster]:
    """Return the peak thickness and speed of a case by snowshed."""
    law = "coulomb" if "coulomb" in case.name.lower() else "voellmy"
    settings = {
        "bonds": False,
        "friction": FRICTION,
        "turbulence": TURBULENCE,
        "friction_law": law,
        **changes,
    }
    scene = slide_scene(
        unpacked(case, "DEM_*.asc", folder),
        next(case.glob("*.shp")),
        thickness=THICKNESS,
        settings=SlideSettings.from_data(settings),
    )
    run(scene, folder / "run", pictures=False)
    peaks = folder / "run" / "peaks"
    return read_raster(peaks / "pft.asc"), read_raster(peaks / "pfv.asc")


def readings(thickness: Raster, speed: Raster) -> dict[str, float]:
    """Return peak speed, peak thickness, area and farthest x of two peak rasters."""
    reached = thickness.heights > MIN_THICKNESS
    columns = np.flatnonzero(reached.any(axis=0))
    return {
        "peak speed, m/s": float(np.nanmax(speed.heights)),
        "peak thickness, m": float(np.nanmax(thickness.heights)),
        "area, km2": float(reached.sum() * thickness.cell**2 / 1e6),
        "farthest x, m": float(thickness.east + columns[-1] * thickness.cell),
    }


def difference(ours: Floats, theirs: Floats, where: np.ndarray) -> float:
    """Return the mean absolute difference, relative to the mean of the model's values."""
    return float(np.abs(ours - theirs)[where].sum() / theirs[where].sum())


def compare(case: Path, changes: dict[str, object]) -> None:
    """Run a case and print the comparison."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        begin = time.perf_counter()
        ours = our_peaks(case, folder, changes)
        spent = time.perf_counter() - begin
        model = [read_raster(unpacked(case, f"*_{n}.asc", folder)) for n in ("pft", "pfv")]
    print(f"{case.name}: {spent:.0f} s")
    print(f"  {'':20} {'snowshed':>10} {'model':>10} {'change':>8}")
    a, b = readings(*ours), readings(model[0], model[1])
    for key in a:
        change = f"{100 * (a[key] / b[key] - 1):+.1f} %" if "x" not in key.split()[1] else ""
        print(f"  {key:20} {a[key]:>10.4g} {b[key]:>10.4g} {change:>8}")
    reached = [raster[0].heights > MIN_THICKNESS for raster in (ours, model)]
    either, both = reached[0] | reached[1], reached[0] & reached[1]
    thickness, speed = (difference(o.heights, m.heights, either) for o, m in zip(ours, model))
    print(
        f"  cell by cell: thickness differs by {100 * thickness:.0f} %, speed by "
        f"{100 * speed:.0f} %; {100 * both.sum() / either.sum():.0f} % of the cells in common"
    )


def main() -> None:
    """Compare the cases of a folder."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path, help="folder of the cases")
    parser.add_argument("cases", nargs="*", help="names of the cases; without them all")
    parser.add_argument(
        "--set", nargs=2, action="append", default=[], metavar=("SETTING", "NUMBER"),
        help="change a setting of the slide",
    )  # fmt: skip
    options = parser.parse_args()
    names = options.cases or sorted(p.name for p in options.folder.iterdir() if p.is_dir())
    for name in names:
        compare(options.folder / name, {key: float(value) for key, value in options.set})


if __name__ == "__main__":
    main()
