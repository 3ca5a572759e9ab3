"""From an image of snow, through loading tests of its grains, to the stack below a panel.

    python examples/image_to_stack.py [FOLDER [VOXELS [COARSER [DX]]]]

The image is synthetic (318 kg/m3, voxels of 50 um), because snowshed ships none; pass your own to
``segment``. COARSER is the number of voxels along the edge of a sphere, DX the grid of the scene in
m. The example takes half a minute on two free cores, and draws ``image_to_stack.png`` into the
folder.
"""

import json
import subprocess
import sys
from pathlib import Path

import matplotlib.image
from matplotlib import rc_context

from snowshed import read_events
from snowshed.plot import STYLE, blank_figure, save_figure

PICTURES = {
    "sample/slices.png": "The image, and the grains that were found in it",
    "material": "The grains' loading tests, and the law that was fitted to them",
    "stack/stack.png": "The stack of the fitted snow below the panel",
}


def main(folder: Path, voxels: int = 40, coarser: int = 2, dx: float = 0.01) -> None:
    """Run the four commands, each of which reads what the one before has written."""
    image, sample, material, stack = (folder / name for name in ("image", *stages()))
    command(f"grains synthetic --density 318 --correlation-length 5e-4 --seed 1 -o {image}",
            "--shape", *[voxels] * 3)  # fmt: skip
    command(f"grains segment {image} -o {sample}")
    command(f"grains material {sample} --coarser {coarser} -o {material}")
    (snow,) = material.glob("snow-*.json")
    command(f"panel --preset lab-50 --dim 2 --dx {dx} --snow {snow} -o {stack}")
    draw(folder, material, snow)
    print_results(snow, stack)


def stages() -> list[str]:
    """Return the folders of the results."""
    return [name.split("/")[0] for name in PICTURES]


def command(line: str, *more: object) -> None:
    """Run a command of snowshed; end with its exit code if it fails."""
    arguments = [*line.split(), *map(str, more)]
    print("snowshed", *arguments, flush=True)
    code = subprocess.call([sys.executable, "-m", "snowshed", *arguments, "-q"])
    if code:
        sys.exit(code)


def draw(folder: Path, material: Path, snow: Path) -> None:
    """Put the pictures of the commands below one another."""
    files = [folder / name for name in PICTURES]
    files[1] = material / snow.name.replace("snow", "material").replace(".json", ".png")
    pictures = [matplotlib.image.imread(file) for file in files]
    width = 10.0  # inches
    heights = [width * picture.shape[0] / picture.shape[1] for picture in pictures]
    with rc_context(STYLE):
        figure = blank_figure(width, sum(heights) + 0.3 * len(heights))
        for axes, picture, title in zip(
            figure.subplots(len(pictures), 1, height_ratios=heights), pictures, PICTURES.values()
        ):
            axes.imshow(picture, interpolation="antialiased")
            axes.set_title(title)
            axes.axis("off")
    save_figure(figure, folder / "image_to_stack.png")


def print_results(snow: Path, stack: Path) -> None:
    """Print the fitted snow and the table of events."""
    data = json.loads(snow.read_text(encoding="utf-8"))
    provenance = data.pop("provenance")
    print(", ".join(f"{name} {value}" for name, value in data.items()))
    for note in provenance["notes"]:
        print("note:", note)
    print(read_events(stack)[["event", "height_m", "length_m", "ended"]].to_string(index=False))


if __name__ == "__main__":
    main(
        Path(sys.argv[1] if len(sys.argv) > 1 else "image-to-stack"),
        *map(int, sys.argv[2:4]),
        *map(float, sys.argv[4:5]),
    )
