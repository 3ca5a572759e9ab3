"""The commands of grains that compute many tests: ``snowshed grains sensitivity|material``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import click

from snowshed.cli.commands.grain_images import VOXEL
from snowshed.cli.quiet import quiet_option
from snowshed.cli.settings_options import settings_options
from snowshed.cli.terminal import say

if TYPE_CHECKING:
    from snowshed.analysis.grains.samples import LabelledSample
    from snowshed.methods.grains.settings import GrainsSettings

Command = TypeVar("Command", bound=Callable[..., Any])

PATH = click.Path(path_type=Path)
SAMPLES, RUNS = "samples", "runs"
#: Inertia of the tests of a study unless it is given: that up to which stresses were seen to stay.
DENSITY_SCALING = 10.0


def study_options(command: Command) -> Command:
    """Add the options of commands that load samples again and again."""
    command = settings_options("grains", without=("threads",))(command)
    for option in (
        click.option("--voxel", type=float, help=VOXEL),
        click.option("--split-labels", is_flag=True,
                     help="Make each piece of a label that lies in several places a grain."),
        click.option("--coarser", type=click.IntRange(1, 64), default=1, show_default=True,
                     help="Voxels of the samples along the edge of a sphere; ice fraction kept."),
        click.option("--turned", is_flag=True,
                     help="Load each sample along x and y, too: more samples of the same snow."),
        click.option("--jobs", type=int, help="Tests at once.  [default: the number of cores]"),
        click.option("--plan", "plan_only", is_flag=True,
                     help="Only say how many tests there are, and how long they take."),
        quiet_option,
        click.option("-o", "--output", "folder", type=PATH, required=True,
                     help="Results folder, old or new."),
    ):  # fmt: skip
        command = option(command)
    return click.argument("labels", type=PATH, nargs=-1, required=True)(command)


@click.command()
@click.option("--speed", type=float, default=0.02, show_default=True, help="Of the plate [m/s].")
@click.option("--strain", type=float, default=0.3, show_default=True,
              help="Way over the sample's height at which a test ends.")  # fmt: skip
@click.option("--finer", is_flag=True, help="Vary towards finer spheres, too: ten times the time.")
@study_options
def sensitivity(
    labels: Sequence[Path], voxel: Optional[float], split_labels: bool, coarser: int,
    turned: bool, speed: float, strain: float, finer: bool, folder: Path, jobs: Optional[int],
    plan_only: bool, quiet: bool, **values: Any,
) -> None:  # fmt: skip
    """Find what matters for the strength in compression, compared with the scatter of samples.

    LABELS are samples of one snow. Friction, elastic modulus, strength of bonds, density of ice
    (by density_scaling), speed, sphere size and volume vary one at a time. After an interruption
    the same command goes on.

    \b
    Example:
      snowshed grains sensitivity a.npy b.npy --voxel 5e-5 --coarser 2 -o sensitivity
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.grains.sensitivity import evaluate_sensitivity
    from snowshed.analysis.grains.variants import sensitivity_variants
    from snowshed.cli.commands.study import compute_study, print_plan
    from snowshed.cli.display.grains_studies import print_comparison
    from snowshed.scene.loading import LoadingStage

    samples = read_samples(labels, voxel, turned=turned, split_labels=split_labels)
    stage = LoadingStage(kind="compress", speed=speed, strain=strain)
    comparison = sensitivity_variants(
        samples, folder / SAMPLES, stage, study_settings(values), coarser=coarser, finer=finer
    )
    study = comparison.study()
    study.save(folder / "study.toml")
    if plan_only:
        print_plan(study, jobs)
        return
    compute_study(study, folder / RUNS, quiet=quiet, jobs=jobs)
    found = evaluate_sensitivity(comparison, folder / RUNS, folder)
    if not quiet:
        print_comparison(found)
        say(f"tests.csv, sensitivity.csv and sensitivity.png in {folder}")


def read_samples(
    paths: Sequence[Path], voxel: Optional[float], *, turned: bool, split_labels: bool
) -> list[LabelledSample]:
    """Return samples of one voxel size; refuse two of one name."""
    from snowshed.analysis.grains.samples import LabelledSample

    samples = [LabelledSample.read(path, voxel, split_labels=split_labels) for path in paths]
    names = [one.name for one in samples]
    for one in samples:
        if names.count(one.name) > 1:
            raise click.UsageError(f"two samples are called {one.name}; rename one")
        if one.voxel_size != samples[0].voxel_size:
            raise click.UsageError(f"{one.name}: the voxels differ from those of {names[0]}")
    return [one.turned(axis) for one in samples for axis in (range(3) if turned else (0,))]


def study_settings(values: dict[str, Any]) -> GrainsSettings:
    """Return the settings that the options give, with the inertia of studies."""
    from snowshed.methods.grains.settings import GrainsSettings

    given = {name: value for name, value in values.items() if value is not None}
    return GrainsSettings(**{"density_scaling": DENSITY_SCALING, **given})


@click.command()
@click.option("--modulus", type=float, help="Young's modulus of the snow, for longer steps [Pa].")
@study_options
def material(
    labels: Sequence[Path], voxel: Optional[float], split_labels: bool, coarser: int,
    turned: bool, modulus: Optional[float], folder: Path, jobs: Optional[int], plan_only: bool,
    quiet: bool, **values: Any,
) -> None:  # fmt: skip
    """Fit the snow of the material point method to loading tests: for panel --snow FILE.

    LABELS are samples of one snow, or of several densities; those within a tenth are one snow.
    Each is compressed with and without strain sideways, stretched, and sheared under two normal
    stresses. After an interruption the same command goes on.

    \b
    Example:
      snowshed grains material a b c --coarser 2 -o material
      snowshed panel --preset lab-50 --dim 2 --snow material/snow-318.json -o stack
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.grains.material.run import MaterialFolder, by_density
    from snowshed.base.arrays import positive
    from snowshed.cli.commands.study import compute_study, print_plan
    from snowshed.cli.display.grains_studies import print_material

    if modulus is not None:
        positive("--modulus", modulus)
    given = read_samples(labels, voxel, turned=turned, split_labels=split_labels)
    samples = [one.coarser(coarser) for one in given]
    files = MaterialFolder(folder, study_settings(values), modulus)
    fits = []
    for tests in (files.tests(group) for group in by_density(samples)):
        first = tests.without_shear().study()
        if plan_only:
            print_plan(first, jobs)
            continue
        compute_study(first, files.runs, quiet=quiet, jobs=jobs, keep_particles=True)
        shear = tests.shear(files.strength(tests))
        compute_study(shear.study(), files.runs, quiet=quiet, jobs=jobs, keep_particles=True)
        fits.append(files.write(tests, shear))
    if plan_only:
        say("and 2 shear tests of each sample, whose stresses follow from these")
        return
    files.write_table(fits)
    if not quiet:
        print_material(fits)
        say(f"snow-*.json, material-*.png and material.csv in {folder}")
