"""Self-contained pages: tables of texts, embedded figures, one style for all reports."""

from __future__ import annotations

import base64
import io
import struct
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from snowshed._core import InputError
from snowshed.base.messages import printable
from snowshed.io.atomic import replacing

if TYPE_CHECKING:
    import jinja2
    from matplotlib.figure import Figure

#: Tables with more rows than this are folded.
FOLDED_FROM_ROWS = 12
DPI = 130
CSS_PIXELS = 96  # per inch
PNG = b"\x89PNG"  # first bytes of a PNG file
HEADER = 24  # bytes of a PNG file up to the end of its size
#: Cells with these words stand out; the class of the page's style decides their colour.
STATES: Mapping[str, str] = {
    "holds": "good",
    "does not hold": "bad-state",
    "not measured": "open",
    "confirmed": "good",
    "contradicted": "bad-state",
    "undecided": "open",
}


@dataclass(frozen=True)
class HtmlTable:
    """A table of texts.

    Attributes
    ----------
    head, rows
        Rows of texts; every row as long as the head.
    align
        A letter for each column: "l" for words, at the left, "r" for numbers.
    groups
        Headings over several columns, with the number of columns; none if empty.
    """

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    align: str
    groups: Sequence[tuple[str, int]] = ()

    @property
    def long(self) -> bool:
        """True if the table should be folded."""
        return len(self.rows) > FOLDED_FROM_ROWS


@dataclass(frozen=True)
class Picture:
    """A figure.

    Attributes
    ----------
    name, title, caption
        Name of the file without its suffix; title in a few words, and caption in a sentence.
    png, width
        The picture, and how wide it should be, in CSS pixels.
    """

    name: str
    title: str
    caption: str
    png: bytes
    width: int

    @classmethod
    def drawn(cls, figure: Figure, name: str, title: str, caption: str) -> Picture:
        """Return a figure as a picture."""
        file = io.BytesIO()
        figure.savefig(file, format="png", dpi=DPI)
        width = round(CSS_PIXELS * figure.get_figwidth())
        return cls(name, title, caption, file.getvalue(), width)

    @classmethod
    def read(cls, file: Path, title: str, caption: str, *, dpi: float) -> Picture:
        """Return a picture from a PNG file that was drawn with `dpi` dots per inch.

        Raises
        ------
        InputError
            If it is not a PNG file.
        """
        png = file.read_bytes()
        if not png.startswith(PNG) or len(png) < HEADER:
            raise InputError(f"{file}: damaged: not a PNG file")
        (pixels,) = struct.unpack(">I", png[16:20])  # the header's first field
        return cls(file.stem, title, caption, png, round(CSS_PIXELS * pixels / dpi))

    @property
    def base64(self) -> str:
        """The PNG file in base64, for a page."""
        return base64.b64encode(self.png).decode()


def write_pictures(pictures: Iterable[Picture], folder: Path) -> None:
    """Write pictures into a folder, as PNG files."""
    folder.mkdir(exist_ok=True)
    for picture in pictures:
        with replacing(folder / f"{picture.name}.png") as beside:
            beside.write_bytes(picture.png)


def _page_text(value: object) -> object:
    """Return a value as text on a page; existing markup stays."""
    return printable(value) if isinstance(value, str) and not hasattr(value, "__html__") else value


def template(package: str, name: str) -> jinja2.Template:
    """Return a page's template from the folder ``templates`` of a package.

    Texts of the page pass `printable`. A template may extend ``page.html.j2`` and import the
    macros of ``parts.html.j2``.
    """
    import jinja2

    loaders = [jinja2.PackageLoader(name) for name in dict.fromkeys((package, "snowshed.plot"))]
    environment = jinja2.Environment(
        loader=jinja2.ChoiceLoader(loaders),
        autoescape=True,
        finalize=_page_text,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.globals["states"] = STATES
    return environment.get_template(name)
