"""Writes the styles of maps for QGIS with the colours of the project's pictures.

``python -m tools.qgis_styles`` writes them into the plugin.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.colors import to_hex

from snowshed.plot.slide_figure import PEAKS

FOLDER = Path(__file__).parents[1] / "qgis" / "snowshed_qgis" / "styles"
#: Upper ends of the classes of each map; values up to the first one are not drawn.
CLASSES = {
    "peak_thickness": ("thickness", "m", (0.01, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0)),
    "peak_speed": ("speed", "m/s", (0.1, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0)),
    "peak_pressure": ("pressure", "kPa", (0.01, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)),
}
LIGHTEST = 0.15  # of a colour map; paler colours vanish on the terrain


def colours(quantity: str) -> list[str]:
    """Return the colour of each drawn class, from the colour map of the project's pictures."""
    _, name = PEAKS[quantity]
    count = len(CLASSES[quantity][2])  # one more class is open
    shades = [LIGHTEST + (1.0 - LIGHTEST) * k / (count - 1) for k in range(count)]
    return [to_hex(mpl.colormaps[name](shade)) for shade in shades]


def style(quantity: str) -> str:
    """Return the style of a map as QML."""
    _, unit, ends = CLASSES[quantity]
    labels = [f"{low:g} to {high:g} {unit}" for low, high in zip(ends, ends[1:])]
    labels.append(f"above {ends[-1]:g} {unit}")
    rows = [f'          <item value="{ends[0]:g}" color="#ffffff" alpha="0" label=""/>']
    for value, colour, label in zip((*map(str, ends[1:]), "inf"), colours(quantity), labels):
        rows.append(
            f'          <item value="{value}" color="{colour}" alpha="255" label="{label}"/>'
        )
    return "\n".join(
        (
            "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>",
            '<qgis version="3.22" styleCategories="Symbology">',
            "  <pipe>",
            f'    <rasterrenderer type="singlebandpseudocolor" band="1" opacity="0.85"'
            f' classificationMin="0" classificationMax="{ends[-1]:g}" alphaBand="-1">',
            "      <rastershader>",
            '        <colorrampshader colorRampType="DISCRETE" classificationMode="1" clip="0"'
            f' minimumValue="0" maximumValue="{ends[-1]:g}">',
            *rows,
            "        </colorrampshader>",
            "      </rastershader>",
            "    </rasterrenderer>",
            "  </pipe>",
            "  <blendMode>0</blendMode>",
            "</qgis>\n",
        )
    )


def main() -> None:
    """Write all styles."""
    FOLDER.mkdir(exist_ok=True)
    for quantity, (name, _, _) in CLASSES.items():
        (FOLDER / f"{name}.qml").write_text(style(quantity), encoding="utf-8")


if __name__ == "__main__":
    main()
