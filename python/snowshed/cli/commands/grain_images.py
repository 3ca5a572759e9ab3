"""Images of snow: ``snowshed grains synthetic|segment``."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import click

from snowshed._core import InputError, available_cores
from snowshed.analysis.tomography.segmentation import SegmentationSettings
from snowshed.base.formatting import number, percent
from snowshed.base.messages import quoted
from snowshed.cli.options.common import PATH, given_values, quiet_option
from snowshed.cli.options.no_effect import refuse_without_effect
from snowshed.cli.output.results import print_rows
from snowshed.cli.output.terminal import PlainConsole

if TYPE_CHECKING:
    from snowshed.analysis.tomography.sample import SampleNumbers
    from snowshed.analysis.tomography.threshold import Crop, ReadImage

Command = TypeVar("Command", bound=Callable[..., Any])

#: Options of one method, and of one format.
OF_WATERSHED, OF_CURVATURE = ("depth",), ("smoothing", "neck_curvature")
OF_RAW_FILES = ("raw_shape", "raw_type")
FEW_GRAINS = 1000  # fewer grains do not represent the snow
VOXEL = "Edge of a voxel [m]."
HELP = {
    "depth": "Least difference between the distances from the air in a grain's middle and in its "
    "neck [voxels] (watershed).",
    "smoothing": "Standard deviation of the Gaussian that smooths the surface [voxels] "
    "(curvature).",
    "neck_curvature": "Smaller principal curvature below which the surface is a neck [1/voxel] "
    "(curvature).",
    "contiguity": "Largest share of a grain's surface that a contact takes; beyond, grains merge.",
    "smallest": "Size of the smallest grain [voxels].",
}


split_labels_option = click.option(
    "--split-labels", is_flag=True, help="Turn each piece of a disconnected label into a grain."
)


def output_options(command: Command) -> Command:
    """Add the options of commands that write a folder of grains."""
    for option in (
        quiet_option,
        click.option(
            "-o", "--output", "folder", type=PATH, required=True, help="Folder, new or empty."
        ),
    ):
        command = option(command)
    return command


def segmentation_options(command: Command) -> Command:
    """Add the options that separate grains."""
    for field in reversed(fields(SegmentationSettings)):
        if field.name in HELP:
            name = "--" + field.name.replace("_", "-")
            command = click.option(
                name,
                type=type(field.default),
                default=field.default,
                show_default=True,
                help=HELP[field.name],
            )(command)
    return click.option(
        "--method",
        type=click.Choice(["watershed", "curvature"]),
        default="watershed",
        show_default=True,
        help="Method that cuts the ice into grains.",
    )(command)


@click.command()
@click.option(
    "--shape",
    type=int,
    nargs=3,
    default=(48, 48, 48),
    show_default=True,
    metavar="NX NY NZ",
    help="Size of the image along x, y and z [voxels].",
)
@click.option("--voxel", type=float, default=5e-5, show_default=True, help=VOXEL)
@click.option("--density", type=float, help="Density of the snow [kg/m3], or give --ice-fraction.")
@click.option("--ice-fraction", type=float, help="Ratio of the volumes of ice and snow.")
@click.option(
    "--specific-surface",
    type=float,
    help="Specific surface of the ice [m2/kg], or give --correlation-length.",
)
@click.option("--correlation-length", type=float, help="Wavelength of the field [m].")
@click.option(
    "--anisotropy",
    type=float,
    default=1.0,
    show_default=True,
    help="Ratio of the ice's correlation lengths along z and along x and y.",
)
@click.option(
    "--spheres",
    type=float,
    metavar="DIAMETER",
    help="Mean diameter of sintered spheres [m]; makes a pack of these instead.",
)
@click.option("--neck", type=float, help="Ratio of the radii of necks and spheres.  [default: 0.4]")
@click.option(
    "--spread",
    type=float,
    help="Half-width of the distribution of diameters, relative to the mean.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="Random seed.")
@output_options
def synthetic(
    folder: Path, quiet: bool, shape: tuple[int, int, int], voxel: float,
    spheres: Optional[float], **options: Any,
) -> None:  # fmt: skip
    """Make synthetic snow: a Gaussian random field, cut at a level, or sintered spheres.

    \b
    Examples:
      snowshed grains synthetic --density 300 --specific-surface 15 -o snow
      snowshed grains synthetic --density 300 --spheres 5e-4 --neck 0.4 -o spheres
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.tomography.gaussian_field import gaussian_snow
    from snowshed.analysis.tomography.sample import check_new, write_grains, write_ice
    from snowshed.analysis.tomography.segmentation import known_grains
    from snowshed.analysis.tomography.sphere_packing import sphere_snow

    check_new(folder)
    nx, ny, nz = shape
    given = given_values(options)
    wrong = [
        f"--{name.replace('_', '-')}"
        for name in ("neck", "spread", "specific_surface", "correlation_length")
        if name in given and (name in ("neck", "spread")) == (spheres is None)
    ]
    if wrong:
        kind = "a Gaussian random field" if spheres is None else "a pack of spheres"
        raise InputError(f"{', '.join(wrong)}: not an option of {kind}")
    facts = {"voxel": voxel, "seed": given["seed"]}
    if spheres is None:
        image = gaussian_snow((nz, ny, nx), voxel, **given)
        numbers = write_ice(folder, image, facts)
    else:
        if given.pop("anisotropy") != 1.0:
            raise InputError("--anisotropy: not an option of a pack of spheres")
        if "neck" in given:
            given["neck_ratio"] = given.pop("neck")
        image = sphere_snow((nz, ny, nx), voxel, diameter=spheres, **given)
        numbers = write_grains(folder, known_grains(image), facts)
    if not quiet:
        print_sample(numbers, folder)


@click.command("segment")
@click.argument("image", type=PATH)
@click.option("--voxel", type=float, help=f"{VOXEL[:-1]}; files with a header contain it.")
@click.option(
    "--threshold",
    type=float,
    help="Value above which a voxel is ice.  [default: midway between two values, or Otsu's]",
)
@click.option("--dark-ice", is_flag=True, help="Ice is below the threshold.")
@click.option(
    "--crop",
    metavar="X0:X1,Y0:Y1,Z0:Z1",
    help="Voxels to keep: the first, and the one after the last.",
)
@click.option(
    "--downscale",
    type=int,
    default=1,
    show_default=True,
    help="Merge this many voxels per edge into one; keeps the ice fraction.",
)
@click.option("--all-parts", is_flag=True, help="Keep disconnected ice, too.")
@click.option(
    "--raw-shape", type=int, nargs=3, metavar="NX NY NZ", help="Size of a .raw file [voxels]."
)
@click.option(
    "--raw-type",
    metavar="TYPE",
    help="Number type of a .raw file, such as uint16, or uint16-be if big-endian.",
)
@segmentation_options
@click.option("--threads", type=int, default=0, help="Number of threads; 0: all.")
@click.option("--surface", is_flag=True, help="Write the surface for ParaView, too.")
@output_options
def segment_command(
    image: Path, folder: Path, quiet: bool, surface: bool, threads: int, **options: Any
) -> None:
    """Find the grains in an image of snow.

    IMAGE is a TIFF stack, a folder of numbered TIFF, PNG or BMP slices, a .mhd, .mha, .raw or .npy
    file, or a folder from ``grains synthetic``.

    \b
    Examples:
      snowshed grains segment slices --voxel 1e-5 --downscale 2 -o sample
      snowshed grains segment snow.mhd --threshold 32000 --method curvature -o sample
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.tomography.sample import check_new
    from snowshed.analysis.tomography.segmented_file import plan_text, segment_image
    from snowshed.analysis.tomography.threshold import ImageSettings
    from snowshed.cli.output.progress import progress_bar
    from snowshed.io.voxels.open_voxels import open_voxels
    from snowshed.methods.grains.sample_folder import SNOW, find_sample

    check_new(folder)
    _refuse_other_options(image, options["method"])
    names = {field.name for field in fields(SegmentationSettings)}
    settings = SegmentationSettings(
        threads=threads or available_cores(),
        **{name: value for name, value in options.items() if name in names},
    )
    sample = find_sample(image, SNOW)
    wanted = ImageSettings(
        voxel_size=sample.voxel_size if options["voxel"] is None else options["voxel"],
        threshold=options["threshold"],
        dark_ice=options["dark_ice"],
        crop=_crop(options["crop"]),
        downscale=options["downscale"],
        connected=not options["all_parts"],
        synthetic_source=sample.source,
    )
    raw_shape = options["raw_shape"]
    file = open_voxels(sample.file, raw_shape and raw_shape[::-1], options["raw_type"])
    plan = plan_text(file, wanted)
    with progress_bar(quiet=quiet, announce=lambda _: plan) as progress:
        numbers, read = segment_image(
            file, folder, wanted, settings, surface=surface, progress=progress
        )
    if not quiet:
        print_image(read)
        print_sample(numbers, folder)


def _refuse_other_options(image: Path, method: str) -> None:
    """Refuse options of the other method of segmentation, and of files of another format."""
    if method != "watershed":
        refuse_without_effect(OF_WATERSHED, f"with --method {method}")
    if method != "curvature":
        refuse_without_effect(OF_CURVATURE, f"with --method {method}")
    if image.suffix.lower() != ".raw":
        refuse_without_effect(OF_RAW_FILES, "without a .raw file")


def _crop(text: Optional[str]) -> Optional[Crop]:
    """Return the crop along z, y and x from an option along x, y and z."""
    if text is None:
        return None
    match = re.fullmatch(r"(\d{1,9}):(\d{1,9}),(\d{1,9}):(\d{1,9}),(\d{1,9}):(\d{1,9})", text)
    if match is None:
        raise InputError(f"--crop {quoted(text)}: X0:X1,Y0:Y1,Z0:Z1 is needed")
    x0, x1, y0, y1, z0, z1 = map(int, match.groups())
    return (z0, z1), (y0, y1), (x0, x1)


def print_image(read: ReadImage) -> None:
    """Print the threshold of an image and the ice that is left out."""
    console = PlainConsole(soft_wrap=True)
    console.print(f"ice from a value of {number(read.threshold)} ({read.chosen})")
    if read.lost:
        console.print(f"left out: {percent(read.lost)} of the ice, which is disconnected")


def print_sample(numbers: SampleNumbers, folder: Path) -> None:
    """Print the numbers of an image of snow."""
    ice, grains = numbers.ice, numbers.grains
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
    print_rows("Sample", rows)
    console = PlainConsole(soft_wrap=True)
    if grains is not None and grains.grains < FEW_GRAINS:
        console.note(
            f"{grains.grains:,} grains; a sample needs {FEW_GRAINS:,} or more to represent a snow"
        )
    console.print(f"sample and slices.png in {folder}")


def _length(metres: float) -> str:
    return f"{number(1e3 * metres)} mm"


def _along(x: float, y: float, z: float) -> str:
    x_text, y_text, z_text = (number(1e3 * value) for value in (x, y, z))
    return f"{x_text}, {y_text}, {z_text} mm along x, y, z"
