"""The commands ``snowshed grains …``: loading tests of segmented snow."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Optional, TypeVar

import click

from snowshed.base.paths import beside
from snowshed.cli.commands.grain_images import segment_command, split_labels_option, synthetic
from snowshed.cli.commands.grains_studies import material, sensitivity
from snowshed.cli.options.common import PATH, given_values, run_options
from snowshed.cli.options.settings import settings_options
from snowshed.cli.output.dry_run import print_cost
from snowshed.cli.run_scene import run_or_cost, run_scene
from snowshed.methods.grains.sample_folder import LABELS
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import Cone, LoadingKind, LoadingStage
from snowshed.scene.output import Output
from snowshed.scene.scene import ResolvedScene

Command = TypeVar("Command", bound=Callable[..., Any])


@click.group()
def grains() -> None:
    """Segment images of snow into grains, and run loading tests of them.

    \b
    Examples:
      snowshed grains example -o example
      snowshed grains segment slices --voxel 5e-5 -o sample
      snowshed grains compress sample -o out
    """  # noqa: D301 - click wants the control character


def loading_command(
    kind: LoadingKind, text: str, *, stress: str = "", speed: float = 0.02, strain: float = 0.3
) -> click.Command:
    """Return the command of loading tests with one stage.

    Parameters
    ----------
    kind
        Kind of the stage.
    text
        Help of the command.
    stress
        Help of the option ``--stress``; empty for a command without it.
    speed, strain
        Defaults of the stage: m/s, and distance over height.
    """

    def run(
        folder: Path, resume: bool, dry_run: bool, quiet: bool, labels: Path,
        voxel: Optional[float], energy: bool, snapshots: float, split_labels: bool, speed: float,
        strain: float, stress: float = 0.0, **values: Any,
    ) -> None:  # fmt: skip
        cone = given_values({name: values.pop(name, None) for name in ("radius", "half_angle")})
        stage = LoadingStage(kind=kind, speed=speed, strain=strain, stress=stress or None)
        scene = grains_scene(
            labels,
            voxel,
            [stage],
            cone=Cone(**cone) if cone else None,
            settings=GrainsSettings(**given_values(values)),
            output=Output(energy=energy, snapshot_interval=snapshots),
            split_labels=split_labels or None,
        ).resolve()
        run_or_cost(scene, folder, resume=resume, dry_run=dry_run, quiet=quiet)

    if kind == "penetrate":
        run = settings_options("grains", "cone")(run)
    run = settings_options("grains")(run)
    if stress:
        run = click.option("--stress", type=float, default=0.0, help=f"{stress} [Pa].")(run)
    for option in (
        click.option("--snapshots", type=float, default=0.0,
                     help="Simulated time between snapshots of the spheres [s]; 0: no snapshots."),
        click.option("--energy", is_flag=True, help="Compute the energy balance."),
        click.option("--strain", type=float, default=strain, show_default=True,
                     help="Distance over the sample's height at which the test ends."),
        click.option("--speed", type=float, default=speed, show_default=True,
                     help="Speed of the moving plate or cone [m/s]."),
        split_labels_option,
        click.option("--voxel", type=float,
                     help="Edge of a voxel [m]; a folder of `grains segment` contains it."),
    ):  # fmt: skip
        run = option(run)
    run = run_options(run)
    run = click.argument("labels", type=PATH)(run)
    return click.command(kind, help=text)(run)


for command in (
    loading_command(
        "compress",
        "Press the top plate down onto a sample.",
        stress="Stress on the top plate that ends the test earlier; 0: no limit",
    ),
    loading_command(
        "stretch", "Pull the top plate up from a sample (with --bonded-plates).", strain=0.05
    ),
    loading_command(
        "shear",
        "Move the top plate along a sample.",
        stress="Normal stress on the top plate; 0: constant height",
    ),
    loading_command(
        "isotropic",
        "Compress a sample from all six sides.",
        stress="Stress that ends the test earlier; 0: no limit",
    ),
    loading_command("penetrate", "Push a cone down into a sample.", strain=0.5),
):
    grains.add_command(command)


grains.add_command(synthetic)
grains.add_command(segment_command)


@grains.command()
@run_options
def example(folder: Path, resume: bool, dry_run: bool, quiet: bool) -> None:
    """Compress a small synthetic sample, in seconds."""
    from snowshed.analysis.tomography.example import example_grains  # loads scipy.ndimage

    if dry_run:
        with TemporaryDirectory() as temporary:
            print_cost(example_grains(Path(temporary) / "sample").resolve())
        return
    if resume:
        run_scene(ResolvedScene.load(folder / "scene.json"), folder, resume, quiet)
        return
    sample = beside(folder, suffix="-sample")
    existed = sample.exists()
    scene = example_grains(sample)
    labels = sample / LABELS
    try:
        run_scene(scene.resolve(), folder, resume, quiet)
    except BaseException:
        if not existed and not (folder / "scene.json").exists():
            labels.unlink()
            sample.rmdir()
        raise


grains.add_command(sensitivity)
grains.add_command(material)
