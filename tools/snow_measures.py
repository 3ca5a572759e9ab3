"""Measure the snow in the results of `snowshed-run`, on a machine without any package."""

from __future__ import annotations

import array
import json
import math
import re
import struct
from pathlib import Path
from typing import Any

TYPES = {"Float32": "f", "Float64": "d", "UInt8": "B", "UInt16": "H", "Int32": "i", "UInt32": "I"}
ARRAY = re.compile(
    r'<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents="(\d+)" format="appended" '
    r'offset="(\d+)"/>'
)


def read_points(file: Path) -> dict[str, array.array[Any]]:
    """Return the arrays of a VTK file of particles that snowshed wrote, by name."""
    data = file.read_bytes()
    begin = data.index(b"_", data.index(b"<AppendedData")) + 1
    arrays = {}
    for kind, name, _, offset in ARRAY.findall(data[:begin].decode("utf-8")):
        at = begin + int(offset)
        (length,) = struct.unpack_from("<Q", data, at)
        values = array.array(TYPES[kind])
        values.frombytes(data[at + 8 : at + 8 + length])
        arrays[name] = values
    return arrays


def quantile(ordered: list[float], share: float) -> float:
    """Return the value below which this share of the ordered values lies."""
    return ordered[min(int(share * len(ordered)), len(ordered) - 1)]


def measures(results: Path) -> dict[str, float]:
    """Return the measures of the snow after the last event of a run.

    Heights and lengths are in m, the density is in kg/m3, and the energies, if the run kept their
    balance, are in J.
    """
    points = read_points(max((results / "particles").glob("*.vtp")))
    mass = points["mass"]
    total = math.fsum(mass)
    x, z = points["position"][0::3], points["position"][2::3]
    along, up = sorted(x), sorted(z)

    def mean(values: array.array[Any]) -> float:
        return math.fsum(m * v for m, v in zip(mass, values)) / total

    record = json.loads((results / "run.json").read_text(encoding="utf-8"))
    return {
        "height_m": quantile(up, 0.99),
        "mean_z_m": mean(z),
        "mean_x_m": mean(x),
        "length_m": quantile(along, 0.95) - quantile(along, 0.05),
        "density": mean(points["density"]),
        **record["finished_events"][-1].get("energy", {}),
    }
