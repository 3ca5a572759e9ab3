"""The output of images of snow."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.table import Table

from snowshed.analysis.tomography.sample import SampleNumbers
from snowshed.analysis.tomography.threshold import ReadImage
from snowshed.base.formatting import number, percent

FEW_GRAINS = 1000


def print_image(read: ReadImage) -> None:
    """Print how ice was found in an image."""
    console = Console(highlight=False, soft_wrap=True)
    console.print(f"ice from a value of {number(read.threshold)} ({read.chosen})")
    if read.lost:
        console.print(f"left out: {percent(read.lost)} of the ice, which hangs in the air")


def print_sample(numbers: SampleNumbers, folder: Path) -> None:
    """Print the numbers of an image of snow."""
    ice, grains = numbers.ice, numbers.grains
    shown = Table(title="Sample", show_header=False, box=None, title_justify="left")
    shown.add_column(style="bold")
    rows = {
        "source": ice.source,
        "voxels": f"{' x '.join(map(str, ice.voxels))} of {_length(ice.voxel_size_m)}",
        "ice fraction": f"{ice.ice_fraction:.4f}",
        "density": f"{ice.density_kg_m3:.1f} kg/m3",
        "specific surface": f"{ice.specific_surface_m2_kg:.2f} m2/kg (Crofton, 13 directions)",
        "optical diameter": _length(ice.optical_diameter_m),
        "correlation length": _along(
            ice.correlation_length_x_m, ice.correlation_length_y_m, ice.correlation_length_z_m
        ),
        "mean chord of ice": _along(ice.ice_chord_x_m, ice.ice_chord_y_m, ice.ice_chord_z_m),
        "mean chord of pores": _along(ice.pore_chord_x_m, ice.pore_chord_y_m, ice.pore_chord_z_m),
    }
    if grains is not None:
        rows |= {
            "grains": f"{grains.grains:,}, median diameter {_length(grains.median_diameter_m)}",
            "contacts": f"{grains.contacts:,}, mean area "
            f"{number(1e6 * grains.mean_contact_area_m2)} mm2",
            "coordination": f"{grains.mean_coordination:.2f}",
            "bonded surface": percent(grains.bonded_surface),
        }
    for name, value in rows.items():
        shown.add_row(name, value)
    console = Console(highlight=False, soft_wrap=True)
    console.print(shown)
    if grains is not None and grains.grains < FEW_GRAINS:
        console.print(
            f"[bold yellow]note:[/] {grains.grains:,} grains; {FEW_GRAINS:,} or more stand for "
            "a snow as a whole"
        )
    console.print(f"sample and slices.png in {folder}")


def _length(metres: float) -> str:
    return f"{number(1e3 * metres)} mm"


def _along(x: float, y: float, z: float) -> str:
    x_text, y_text, z_text = (number(1e3 * value) for value in (x, y, z))
    return f"{x_text}, {y_text}, {z_text} mm along x, y, z"
