"""AvaFrame projects with a release from a raster, and AvaFrame's own results for them.

``python tests/helpers/raster_releases.py AVAFRAME_PYTHON`` records the results again.
AVAFRAME_PYTHON is the interpreter of an environment with AvaFrame 2.1 (``pip install
avaframe==2.1``). The results are the thickness at the nodes after some steps, as AvaFrame computes
it from the very files that `write_raster_project` writes.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from snowshed.io.raster.raster import Raster, write_ascii_grid

RECORD = Path(__file__).parents[1] / "scene/builders/avaframe/raster_releases.json"
STEPS = (1, 150)
SETTINGS = "snowSlide = 0\ntEnd = 1.5\n"
PLANE, VALLEY, OTHER_CELLS = "plane", "valley with later snow", "raster on other cells"
CASES = (PLANE, VALLEY, OTHER_CELLS)
COLUMNS, ROWS, CELL = 30, 20, 2.0

# Program for AvaFrame's environment: runs a project and writes the thickness after some steps.
AVAFRAME = """
import configparser, json, logging, sys
import matplotlib; matplotlib.use("Agg")
import numpy as np
logging.disable(logging.WARNING)
from avaframe.com1DFA import com1DFA
from avaframe.com5SnowSlide import com5SnowSlide
from avaframe.in3Utils import cfgUtils
project, ini, output, steps = sys.argv[1], sys.argv[2], sys.argv[3], json.loads(sys.argv[4])
done, thickness, entrained = 0, {}, 0.0
original = com1DFA.computeEulerTimeStep
def recorded(*args, **options):
    global done, entrained
    result = original(*args, **options)
    done += 1
    entrained += result[0]["massEntrained"]
    if done in steps:
        thickness[done] = result[1]["FT"].tolist()
        json.dump({"thickness": thickness, "particles": int(result[0]["nPart"]),
                   "entrained_kg": float(entrained)}, open(output, "w"))
    return result
com1DFA.computeEulerTimeStep = recorded
main = cfgUtils.getGeneralConfig()
main["MAIN"]["avalancheDir"] = project
main["MAIN"]["nCPU"] = "1"
settings = cfgUtils.getModuleConfig(com5SnowSlide)
own = configparser.ConfigParser(); own.optionxform = str; own.read(ini)
for key, value in own["com1DFA_com1DFA_override"].items():
    settings["com1DFA_com1DFA_override"][key] = value
com5SnowSlide.com5SnowSlideMain(main, settings)
"""


def write_raster_project(folder, case):
    """Write a project whose release is a raster."""
    x, y = np.meshgrid(np.arange(COLUMNS) * CELL, np.arange(ROWS) * CELL)
    if case == VALLEY:
        heights = 300 - 60 * np.sin(x / 70) + 0.006 * (y - 20) ** 2 + np.sin(x / 9) * np.cos(y / 7)
    else:
        heights = 300 - math.tan(math.radians(33)) * x + 0.13 * y
    inputs = folder / "Inputs"
    for name in ("REL", "CFGs"):
        (inputs / name).mkdir(parents=True)
    write_ascii_grid(inputs / "dem.asc", Raster(heights, 0.0, 0.0, CELL), exact=True)
    depth = Raster(_depth(x, y), 0.0, 0.0, CELL)
    settings = SETTINGS + "simTypeList = null\n"
    if case == OTHER_CELLS:
        cell, west, south = 3.0, -4.5, -3.7
        u, v = np.meshgrid(west + cell * np.arange(23), south + cell * np.arange(16))
        depth = Raster(np.where(_depth(u, v) > 0, 0.9, 0.0), west, south, cell)
        settings += "deltaTh = 0.01\n"
    if case == VALLEY:
        settings = SETTINGS + "simTypeList = ent\nexplicitFriction = 1\n"
        _write_rectangle(inputs / "ENT/ent.shp", (10, 8, 50, 32), 0.3)
        _write_rectangle(inputs / "SECREL/later.shp", (22, 14, 40, 28), 0.6)
    write_ascii_grid(inputs / "REL/rel.asc", depth, exact=True)
    text = f"[GENERAL]\n[com1DFA_com1DFA_override]\n{settings}"
    (inputs / "CFGs/com5SnowSlideCfg.ini").write_text(text)
    return folder


def _depth(x, y):
    """Thickness of the released snow, m: 0.42 m at its edge, and thicker inside."""
    depth = 0.9 - 0.5 * ((x - 18) / 9) ** 2 - 0.5 * ((y - 19) / 11) ** 2
    depth += 0.15 * np.sin(x / 3) * np.cos(y / 4)
    return np.where(depth > 0.42, depth, 0.0)


def _write_rectangle(path, bounds, thickness):
    import pyogrio
    import shapely

    path.parent.mkdir(parents=True, exist_ok=True)
    pyogrio.raw.write(
        path,
        geometry=shapely.to_wkb([shapely.box(*bounds)]),
        field_data=[np.array(["area"], dtype=object), np.array([thickness])],
        fields=["name", "thickness"],
        geometry_type="Polygon",
        crs=None,
    )


def _record(interpreter):
    results = {}
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            project = write_raster_project(Path(folder) / "project", case)
            output = Path(folder) / "result.json"
            ini = project / "Inputs/CFGs/com5SnowSlideCfg.ini"
            command = [interpreter, "-c", AVAFRAME, *map(str, (project, ini, output))]
            subprocess.run(
                [*command, json.dumps(STEPS)], check=True, stdout=subprocess.DEVNULL, cwd=folder
            )
            result = json.loads(output.read_text())
        for step, values in result["thickness"].items():
            flat = np.ravel(values)
            nodes = np.flatnonzero(flat)
            result["thickness"][step] = {
                "nodes": nodes.tolist(),
                "metres": flat[nodes].tolist(),
            }
        results[case] = result
    RECORD.write_text(json.dumps(results, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    _record(sys.argv[1])
