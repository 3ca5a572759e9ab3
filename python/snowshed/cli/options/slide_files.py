"""Input files of ``snowshed slide``: terrain, areas, and their copies."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional, TypeVar

import click

from snowshed._core import InputError
from snowshed.base.notes import issue_note
from snowshed.base.paths import beside
from snowshed.cli.options.common import PATH, given_values
from snowshed.scene.builders.terrain_copy import terrain_copy
from snowshed.scene.scene import ResolvedScene, Scene

Command = TypeVar("Command", bound=Callable[..., Any])

#: Options that have the same names as the fields of `SlideFiles`.
UNCHANGED_OPTIONS = (
    "terrain",
    "release",
    "thickness_raster",
    "thickness",
    "secondary_release",
    "inflow",
    "hydrograph",
    "dams",
    "band",
    "thickness_band",
)
LIMITS = ("max_slope", "max_thickness", "max_cells")
INPUTS = "give --terrain and --release, or --avaframe, or --example"


def file_options(command: Command) -> Command:
    """Add the options of the files of a slide."""
    for option in (
        click.option("--max-cells", type=int, help="Largest number of cells of the terrain."),
        click.option(
            "--max-thickness", type=float, help="Largest plausible thickness of snow [m]."
        ),
        click.option(
            "--max-slope",
            type=float,
            help="Steepest plausible cliff under the release [degrees].",
        ),
        click.option("--thickness-band", type=int, help="Band of the thickness raster."),
        click.option("--band", type=int, help="Band of the terrain, if the GeoTIFF has several."),
        click.option(
            "--inflow-layer", metavar="NAME", help="Layer of the GeoPackage of the inflow."
        ),
        click.option(
            "--secondary-release-layer",
            metavar="NAME",
            help="Layer of the GeoPackage of secondary release areas.",
        ),
        click.option(
            "--resistance-layer", metavar="NAME", help="Layer of the GeoPackage of forest."
        ),
        click.option(
            "--entrainment-layer",
            metavar="NAME",
            help="Layer of the GeoPackage of entrainment areas.",
        ),
        click.option("--layer", metavar="NAME", help="Layer of the GeoPackage of release areas."),
        click.option("--dams", type=PATH, help="Lines of dams."),
        click.option(
            "--hydrograph",
            type=PATH,
            help="Table (CSV) of the times, thicknesses and velocities of the inflow.",
        ),
        click.option("--inflow", type=PATH, help="Polygons that snow enters at given times."),
        click.option(
            "--secondary-release",
            type=PATH,
            help="Polygons that are released when snow enters them.",
        ),
        click.option("--resistance-areas", type=PATH, help="Polygons of forest."),
        click.option("--entrainment-areas", type=PATH, help="Polygons of the entrainment areas."),
        click.option(
            "--thickness-raster",
            type=PATH,
            help="Raster of the thickness of the released snow [m].",
        ),
        click.option("--thickness", type=float, help="Thickness of the released snow [m]."),
        click.option("--release", type=PATH, help="Polygons of the release areas."),
        click.option("--terrain", type=PATH, help="Elevations: an ESRI ASCII grid or a GeoTIFF."),
    ):
        command = option(command)
    return command


@dataclass(frozen=True)
class SlideFiles:
    """Files of a slide, their bands, and the thickness of its release, m, if given.

    `layers` are those of `snowshed.scene.slide_scene`, and `limits` its largest plausible values.
    """

    terrain: Optional[Path]
    release: Optional[Path]
    thickness_raster: Optional[Path]
    entrainment: Optional[Path]
    resistance: Optional[Path]
    thickness: Optional[float]
    secondary_release: Optional[Path] = None
    inflow: Optional[Path] = None
    hydrograph: Optional[Path] = None
    dams: Optional[Path] = None
    band: Optional[int] = None
    thickness_band: Optional[int] = None
    layers: Mapping[str, str] = field(default_factory=dict)
    limits: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def pop_from(cls, options: dict[str, Any]) -> SlideFiles:
        """Return the files in `options`, and remove them there; see `file_options`."""
        from snowshed.scene.builders.slides import LAYER_OPTIONS

        layers = {
            part: options.pop(option.replace("-", "_")) for part, option in LAYER_OPTIONS.items()
        }
        return cls(
            entrainment=options.pop("entrainment_areas"),
            resistance=options.pop("resistance_areas"),
            layers=given_values(layers),
            limits=given_values({name: options.pop(name) for name in LIMITS}),
            **{name: options.pop(name) for name in UNCHANGED_OPTIONS},
        )

    def refuse_terrain_options(self) -> None:
        """Refuse options that need a terrain: bands and limits."""
        bands = {"band": self.band, "thickness_band": self.thickness_band}
        for name in (*given_values(bands), *self.limits):
            raise InputError(f"--{name.replace('_', '-')}: only with --terrain")

    def has_files(self) -> bool:
        """Return whether any file is given."""
        return any(
            file is not None
            for file in (self.terrain, self.hydrograph, *self.area_files().values())
        )

    def layered_files(self) -> dict[str, Optional[Path]]:
        """Return the files that may have several layers, by their key in `LAYER_OPTIONS`."""
        return {
            "release": self.release,
            "entrainment": self.entrainment,
            "resistance": self.resistance,
            "secondary_release": self.secondary_release,
            "inflow": self.inflow,
        }

    def area_files(self) -> dict[str, Optional[Path]]:
        """Return the files of areas by their key in a scene's terrain."""
        return {
            "release": self.release or self.thickness_raster,
            "entrainment": self.entrainment,
            "resistance": self.resistance,
            "secondary_release": self.secondary_release,
            "inflows": self.inflow,
            "dams": self.dams,
        }

    def scene(
        self,
        folder: Path,
        *,
        example: bool,
        settings: Mapping[str, object],
    ) -> Scene:
        """Return the scene of the files, or the example.

        Parameters
        ----------
        folder
            The results folder; copies of files are written beside it.
        example
            Whether to return the example, which takes no files.
        settings
            Settings of the method.
        """
        from snowshed.methods.slide.settings import SlideSettings
        from snowshed.scene.builders.slides import example_slide, slide_scene

        if self.has_files() == example:
            raise InputError(INPUTS)
        if example:
            terrain = beside(folder, suffix="-terrain")
            terrain.mkdir(parents=True, exist_ok=True)
            return example_slide(terrain).update({"numerics": dict(settings)})
        if self.terrain is None or self.area_files()["release"] is None:
            raise InputError("give both --terrain and --release (or --thickness-raster)")
        return slide_scene(
            self.terrain,
            self.release,
            thickness=self.thickness,
            thickness_raster=self.thickness_raster,
            entrainment=self.entrainment,
            resistance=self.resistance,
            secondary_release=self.secondary_release,
            inflow=self.inflow,
            hydrograph=self.hydrograph,
            dams=self.dams,
            layers=self.layers,
            settings=SlideSettings.from_data(dict(settings)),
            ascii_copy=terrain_copy(folder),
            title=f"Slide on {self.terrain.name}",
            band=self.band,
            thickness_band=self.thickness_band,
            **self.limits,
        )


def notes_for_summary(notes: Sequence[str], *scenes: Scene) -> list[str]:
    """Return the notes that summaries of the scenes repeat, and issue the others.

    Parameters
    ----------
    notes
        Notes from the making of the scenes.
    scenes
        The scenes, whose terrain holds the notes on its files.
    """
    stored = {
        line
        for scene in scenes
        if scene.terrain is not None
        for line in str(scene.terrain.notes or "").splitlines()
    }
    for note in notes:
        if note not in stored:
            issue_note(note)
    return [note for note in notes if note in stored]


def refuse_changed_areas(
    scene: ResolvedScene, folder: Path, files: Mapping[str, Optional[Path]]
) -> None:
    """Refuse to resume a run whose areas have changed, and name their file."""
    stored = folder / "scene.json"
    if not stored.is_file():
        return  # the run itself reports that there is nothing to resume
    earlier = ResolvedScene.load(stored).data
    current = scene.data
    for key, file in files.items():
        if file is not None and earlier["terrain"].get(key) != current["terrain"].get(key):
            raise InputError(
                f"{file}: has changed since the run in {folder} began; restore the file, or "
                "start again"
            )
