"""The commands of many loading tests: ``snowshed grains sensitivity|material``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import click

from snowshed.base.formatting import MISSING
from snowshed.cli.commands.grain_images import VOXEL, split_labels_option
from snowshed.cli.options.common import (
    PATH,
    dry_run_option,
    given_values,
    jobs_option,
    quiet_option,
    resume_option,
    same_version_option,
)
from snowshed.cli.options.settings import settings_options
from snowshed.cli.output.terminal import plain_table, say, wide_console

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.analysis.grains.material.fit import FittedSnow, Range
    from snowshed.analysis.grains.samples import LabelledSample
    from snowshed.methods.grains.settings import GrainsSettings

Command = TypeVar("Command", bound=Callable[..., Any])

SAMPLES, RUNS = "samples", "runs"
#: Default `density_scaling` of studies: fewer time steps, but the same stresses.
DENSITY_SCALING = 10.0
#: Parameters of a fitted snow: title, unit, and the unit in SI units.
PARAMETERS = {
    "youngs_modulus": ("E of the grains", "MPa", 1e6),
    "poissons_ratio": ("nu", "", 1.0),
    "preconsolidation_pressure": ("p0", "kPa", 1e3),
    "critical_state_slope": ("M", "", 1.0),
    "cohesion": ("beta", "", 1.0),
    "hardening_factor": ("xi", "", 1.0),
    "tension_pa": ("tensile strength", "kPa", 1e3),
    "yield_residual": ("residual of the yield surface", "", 1.0),
    "hardening_residual": ("residual of the hardening", "", 1.0),
    "confined_yield_over_law": ("confined peak over law", "", 1.0),
}


def study_options(command: Command) -> Command:
    """Add the options of commands that run many loading tests."""
    command = settings_options("grains", without=("threads",))(command)
    for option in (
        click.option("--voxel", type=float, help=VOXEL),
        split_labels_option,
        click.option("--coarser", type=click.IntRange(1, 64), default=1, show_default=True,
                     help="Merge this many voxels per edge into one sphere; keeps the ice "
                          "fraction."),
        click.option("--turned", is_flag=True,
                     help="Load each sample along x and y, too, as further samples of the same "
                          "snow."),
        jobs_option("Tests"),
        same_version_option,
        resume_option,
        dry_run_option("Print the number of tests and their estimated time and exit."),
        quiet_option,
        click.option("-o", "--output", "folder", type=PATH, required=True,
                     help="Results folder, old or new."),
    ):  # fmt: skip
        command = option(command)
    return click.argument("labels", type=PATH, nargs=-1, required=True)(command)


@click.command()
@click.option(
    "--speed", type=float, default=0.02, show_default=True, help="Speed of the plate [m/s]."
)
@click.option("--strain", type=float, default=0.3, show_default=True,
              help="Distance over the sample's height at which a test ends.")  # fmt: skip
@click.option("--finer", is_flag=True, help="Include finer spheres: ten times the run time.")
@study_options
def sensitivity(
    labels: Sequence[Path], voxel: Optional[float], split_labels: bool, coarser: int,
    turned: bool, speed: float, strain: float, finer: bool, folder: Path, jobs: Optional[int],
    same_version: bool, dry_run: bool, quiet: bool, **values: Any,
) -> None:  # fmt: skip
    """Compare each parameter's effect on compressive strength with the scatter of samples.

    LABELS are samples of one snow. Friction, elastic modulus, strength of bonds, density of ice
    (by density_scaling), speed, sphere size and volume vary one at a time. After an interruption,
    the same command resumes.

    \b
    Example:
      snowshed grains sensitivity a.npy b.npy --voxel 5e-5 --coarser 2 -o sensitivity
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.grains.sensitivity import evaluate_variants
    from snowshed.analysis.grains.variants import sensitivity_variants
    from snowshed.cli.compute_study import compute_study, print_study_cost
    from snowshed.scene.loading import LoadingStage

    samples = read_samples(labels, voxel, turned=turned, split_labels=split_labels)
    stage = LoadingStage(kind="compress", speed=speed, strain=strain)
    comparison = sensitivity_variants(
        samples, folder / SAMPLES, stage, study_settings(values), coarser=coarser, finer=finer
    )
    study = comparison.study()
    study.save(folder / "study.toml")
    if dry_run:
        print_study_cost(study, jobs)
        return
    compute_study(study, folder / RUNS, quiet=quiet, jobs=jobs, same_version=same_version)
    table = evaluate_variants(comparison, folder / RUNS, folder)
    if not quiet:
        print_comparison(table)
        say(f"tests.csv, sensitivity.csv and sensitivity.png in {folder}")


def read_samples(
    paths: Sequence[Path], voxel: Optional[float], *, turned: bool, split_labels: bool
) -> list[LabelledSample]:
    """Return samples of one voxel size and of different names.

    Raises
    ------
    click.UsageError
        If voxel sizes differ or a name occurs twice.
    """
    from snowshed.analysis.grains.samples import LabelledSample

    samples = [LabelledSample.read(path, voxel, split_labels=split_labels) for path in paths]
    names = [sample.name for sample in samples]
    for sample in samples:
        if names.count(sample.name) > 1:
            raise click.UsageError(f"two samples are called {sample.name}; rename one")
        if sample.voxel_size != samples[0].voxel_size:
            raise click.UsageError(f"{sample.name}: the voxel size differs from that of {names[0]}")
    return [sample.turned(axis) for sample in samples for axis in (range(3) if turned else (0,))]


def study_settings(values: dict[str, Any]) -> GrainsSettings:
    """Return the settings of the options, with the default inertia of studies."""
    from snowshed.methods.grains.settings import GrainsSettings

    return GrainsSettings(**{"density_scaling": DENSITY_SCALING, **given_values(values)})


@click.command()
@click.option(
    "--modulus",
    type=float,
    help="Young's modulus of the snow [Pa]; a smaller one allows longer steps.",
)
@study_options
def material(
    labels: Sequence[Path], voxel: Optional[float], split_labels: bool, coarser: int,
    turned: bool, modulus: Optional[float], folder: Path, jobs: Optional[int], same_version: bool,
    dry_run: bool, quiet: bool, **values: Any,
) -> None:  # fmt: skip
    """Fit the snow of the material point method to loading tests, for panel --snow FILE.

    LABELS are samples of one snow, or of several densities; densities within 10 % are one snow.
    Each sample is compressed with and without lateral strain, stretched, and sheared under two
    normal stresses. After an interruption, the same command resumes.

    \b
    Example:
      snowshed grains material a b c --coarser 2 -o material
      snowshed panel --preset lab-50 --dim 2 --snow material/snow-318.json -o stack
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.grains.material.run import MaterialFolder, by_density
    from snowshed.base.arrays import positive
    from snowshed.cli.compute_study import compute_study, print_study_cost

    if modulus is not None:
        positive("--modulus", modulus)
    samples = [
        sample.coarser(coarser)
        for sample in read_samples(labels, voxel, turned=turned, split_labels=split_labels)
    ]
    files = MaterialFolder(folder, study_settings(values), modulus)
    fits = []
    for tests in (files.tests(group) for group in by_density(samples)):
        first = tests.without_shear().study()
        if dry_run:
            print_study_cost(first, jobs)
            continue
        options: dict[str, Any] = {
            "quiet": quiet, "jobs": jobs, "same_version": same_version, "keep_particles": True,
        }  # fmt: skip
        compute_study(first, files.runs, **options)
        shear = tests.shear(files.strength(tests))
        compute_study(shear.study(), files.runs, **options)
        fits.append(files.write(tests, shear))
    if dry_run:
        say("and 2 shear tests of each sample, whose stresses depend on these results")
        return
    files.write_table(fits)
    if not quiet:
        print_material(fits)
        say(f"snow-*.json, material-*.png and material.csv in {folder}")


def print_comparison(comparison: pd.DataFrame) -> None:
    """Print the stresses of the base, and their ratios in the variants.

    Parameters
    ----------
    comparison
        From `snowshed.analysis.grains.ratios.compare_variants`.
    """
    from snowshed.analysis.grains.ratios import STRESSES
    from snowshed.analysis.grains.variants import BASE

    stresses = [name for name in STRESSES if name in set(comparison["stress"])]
    table = plain_table("Stresses, and their ratio to the base (95 % from the samples' scatter)")
    table.add_column("", no_wrap=True)
    for stress in stresses:
        table.add_column(STRESSES[stress], justify="right", no_wrap=True)
    for variant in dict.fromkeys(comparison["variant"]):
        rows = comparison[comparison["variant"] == variant].set_index("stress")
        cells = [_cell(rows.loc[stress], base=variant == BASE) for stress in stresses]
        table.add_row(str(variant), *cells)
    console = wide_console(140)
    console.print(table)
    console.print("? may be no effect: 1 lies within the interval")


def _cell(row: Any, *, base: bool) -> str:
    import numpy as np

    if not np.isfinite(row["ratio"]):
        return MISSING
    if base:
        scatter = f" x/ {np.exp(row['scatter']):.2f}" if np.isfinite(row["scatter"]) else ""
        return f"{row['value_pa'] / 1e3:.3g} kPa{scatter}  "
    if not np.isfinite(row["low"]):
        return f"{row['ratio']:.3g}  "
    doubt = " " if row["distinct"] else "?"
    return f"{row['ratio']:.3g} ({row['low']:.2g} to {row['high']:.2g}) {doubt}"


def print_material(fits: Sequence[FittedSnow]) -> None:
    """Print the parameters of fitted snows with their intervals and notes."""
    from snowshed.analysis.grains.material.fit import exponents

    table = plain_table("Snow of the grains (95 % interval of the mean, from the samples' scatter)")
    table.add_column("", no_wrap=True)
    for fit in fits:
        table.add_column(f"{fit.law.density:.0f} kg/m3", justify="right", no_wrap=True)
    for name, (title, unit, size) in PARAMETERS.items():
        head = f"{title}, {unit}" if unit else title
        table.add_row(head, *(_range(fit.ranges[name], size) for fit in fits))
    console = wide_console(100)
    console.print(table)
    for name, exponent in exponents([fit.law for fit in fits]).items():
        console.print(f"{PARAMETERS[name][0]} grows as density^{exponent:.2g}")
    for fit in fits:
        for note in fit.notes:
            console.print(f"note, {fit.law.density:.0f} kg/m3: {note}", soft_wrap=True)


def _range(interval: Range, size: float) -> str:
    import numpy as np

    text = f"{interval.value / size:.3g}"
    if not np.isfinite(interval.low):
        return text
    return f"{text} ({interval.low / size:.2g} to {interval.high / size:.2g})"
