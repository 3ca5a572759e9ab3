"""Images of snow: ``snowshed grains synthetic|segment``."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import click

from snowshed._core import InputError
from snowshed.analysis.tomography.segmentation import SegmentationSettings
from snowshed.base.messages import quoted
from snowshed.cli.quiet import quiet_option

if TYPE_CHECKING:
    from snowshed.analysis.tomography.threshold import Crop

Command = TypeVar("Command", bound=Callable[..., Any])

PATH = click.Path(path_type=Path)
VOXEL = "Edge of a voxel [m]."
HELP = {
    "depth": "How much deeper than the neck a grain's maximum of the distance from the air must "
    "be [voxels] (watershed).",
    "smoothing": "Standard deviation of the Gaussian that smooths the surface [voxels] "
    "(curvature).",
    "neck_curvature": "Smaller principal curvature below which the surface is a neck [1/voxel] "
    "(curvature).",
    "contiguity": "Part of a grain's surface that a contact may take; more is one grain.",
    "smallest": "Voxels of the smallest grain.",
}


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
    """Add the options of how grains are told apart."""
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
        help="What cuts the ice into grains.",
    )(command)


@click.command()
@click.option(
    "--shape",
    type=int,
    nargs=3,
    default=(48, 48, 48),
    show_default=True,
    metavar="NX NY NZ",
    help="Voxels along x, y and z.",
)
@click.option("--voxel", type=float, default=5e-5, show_default=True, help=VOXEL)
@click.option("--density", type=float, help="Density of the snow [kg/m3]; or --ice-fraction.")
@click.option("--ice-fraction", type=float, help="Volume of ice over that of the snow.")
@click.option(
    "--specific-surface",
    type=float,
    help="Surface of the ice over its mass [m2/kg]; or --correlation-length.",
)
@click.option("--correlation-length", type=float, help="Wavelength of the field [m].")
@click.option(
    "--anisotropy",
    type=float,
    default=1.0,
    show_default=True,
    help="Length of the ice along z over that along x and y.",
)
@click.option(
    "--spheres",
    type=float,
    metavar="DIAMETER",
    help="Make a pack of sintered spheres instead, of this mean diameter [m].",
)
@click.option("--neck", type=float, help="Radius of the necks over that of spheres. [default: 0.4]")
@click.option("--spread", type=float, help="Half-width of the diameters over their mean.")
@click.option("--seed", type=int, default=0, show_default=True, help="Of what is random.")
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
    from snowshed.analysis.tomography.gaussian_snow import gaussian_snow
    from snowshed.analysis.tomography.sample import check_new, write_grains, write_ice
    from snowshed.analysis.tomography.segmentation import known_grains
    from snowshed.analysis.tomography.sphere_snow import sphere_snow
    from snowshed.cli.display.grain_images import print_sample

    check_new(folder)
    nx, ny, nz = shape
    given = {name: value for name, value in options.items() if value is not None}
    wrong = [
        f"--{name.replace('_', '-')}"
        for name in ("neck", "spread", "specific_surface", "correlation_length")
        if name in given and (name in ("neck", "spread")) == (spheres is None)
    ]
    if wrong:
        kind = "a Gaussian random field" if spheres is None else "a pack of spheres"
        raise InputError(f"{', '.join(wrong)}: not taken by {kind}")
    facts = {"voxel": voxel, "seed": given["seed"]}
    if spheres is None:
        image = gaussian_snow((nz, ny, nx), voxel, **given)
        numbers = write_ice(folder, image, facts)
    else:
        if given.pop("anisotropy") != 1.0:
            raise InputError("--anisotropy: not taken by a pack of spheres")
        if "neck" in given:
            given["neck_ratio"] = given.pop("neck")
        image = sphere_snow((nz, ny, nx), voxel, diameter=spheres, **given)
        numbers = write_grains(folder, known_grains(image), facts)
    if not quiet:
        print_sample(numbers, folder)


@click.command("segment")
@click.argument("image", type=PATH)
@click.option("--voxel", type=float, help=f"{VOXEL[:-1]}; files with a header know it.")
@click.option(
    "--threshold",
    type=float,
    help="What is above is ice. [default: halfway between two values, or Otsu's]",
)
@click.option("--dark-ice", is_flag=True, help="Ice is below the threshold.")
@click.option(
    "--crop",
    metavar="X0:X1,Y0:Y1,Z0:Z1",
    help="Voxels that are kept: the first, and the one after the last.",
)
@click.option(
    "--downscale",
    type=int,
    default=1,
    show_default=True,
    help="Voxels along an edge that become one; the ice fraction stays.",
)
@click.option("--all-parts", is_flag=True, help="Keep ice that is not connected, too.")
@click.option("--raw-shape", type=int, nargs=3, metavar="NX NY NZ", help="Voxels of a .raw file.")
@click.option(
    "--raw-type",
    metavar="TYPE",
    help="Numbers of a .raw file, such as uint16, or uint16-be if big-endian.",
)
@segmentation_options
@click.option("--threads", type=int, default=0, help="Threads; 0: all.")
@click.option("--surface", is_flag=True, help="Write the surface for ParaView, too.")
@output_options
def segment_command(
    image: Path, folder: Path, quiet: bool, surface: bool, threads: int, **options: Any
) -> None:
    """Find the grains in an image of snow.

    IMAGE is a TIFF stack, a folder of numbered TIFF, PNG or BMP slices, or a .mhd, .mha, .raw or
    .npy file, or a folder that ``grains synthetic`` wrote.

    \b
    Examples:
      snowshed grains segment slices --voxel 1e-5 --downscale 2 -o sample
      snowshed grains segment snow.mhd --threshold 32000 --method curvature -o sample
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.tomography.sample import check_new
    from snowshed.analysis.tomography.segmented_file import plan_text, segment_image
    from snowshed.analysis.tomography.threshold import ImageSettings
    from snowshed.cli.display.grain_images import print_image, print_sample
    from snowshed.cli.progress import progress_bar
    from snowshed.io.voxels.open_voxels import open_voxels
    from snowshed.methods.grains.sample_folder import SNOW, find_sample

    check_new(folder)
    names = {field.name for field in fields(SegmentationSettings)}
    settings = SegmentationSettings(
        threads=threads or os.cpu_count() or 1,
        **{name: value for name, value in options.items() if name in names},
    )
    known = find_sample(image, SNOW)
    wanted = ImageSettings(
        voxel_size=known.voxel_size if options["voxel"] is None else options["voxel"],
        threshold=options["threshold"],
        dark_ice=options["dark_ice"],
        crop=_crop(options["crop"]),
        downscale=options["downscale"],
        connected=not options["all_parts"],
        synthetic_source=known.source,
    )
    raw_shape = options["raw_shape"]
    file = open_voxels(known.file, raw_shape and raw_shape[::-1], options["raw_type"])
    plan = plan_text(file, wanted)
    with progress_bar(quiet=quiet, announce=lambda _: plan) as progress:
        numbers, read = segment_image(
            file, folder, wanted, settings, surface=surface, progress=progress
        )
    if not quiet:
        print_image(read)
        print_sample(numbers, folder)


def _crop(text: Optional[str]) -> Optional[Crop]:
    """Return the crop along z, y and x that an option gives along x, y and z."""
    if text is None:
        return None
    found = re.fullmatch(r"(\d{1,9}):(\d{1,9}),(\d{1,9}):(\d{1,9}),(\d{1,9}):(\d{1,9})", text)
    if found is None:
        raise InputError(f"--crop {quoted(text)}: X0:X1,Y0:Y1,Z0:Z1 is needed")
    x0, x1, y0, y1, z0, z1 = map(int, found.groups())
    return (z0, z1), (y0, y1), (x0, x1)
