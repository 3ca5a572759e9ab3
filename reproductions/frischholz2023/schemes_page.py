"""The page ``docs/trust/thesis-schemes.md``: verdicts on the thesis with each scheme of the MPM.

Its numbers come from the folder ``data``, which holds the claims of the last ``--middle`` (3D) and
``--planar`` (2D) with each scheme, and those on chapter 5, which have the rows of panels that come
with snowshed; ``python -m reproductions.frischholz2023.schemes_page`` writes it again. The claims
of ``--middle`` with the scheme thesis are those of `reproductions.frischholz2023.claims_page`.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import click

from reproductions.common.claims_tables import VERDICTS, claims_csv, read_claims
from reproductions.common.folder import IDENTITY, ReproductionFolder
from reproductions.common.hypothesis_tests import JudgedClaim
from reproductions.common.markdown import markdown_table
from reproductions.frischholz2023.claims.scheme_reasons import REASONS
from reproductions.frischholz2023.claims_page import (
    CLAIMS_FILE,
    COMPUTED_FILE,
    DATA,
    DOCS,
    explanation,
    origin_of_runs,
)
from snowshed._core import InputError
from snowshed.cli.main import main as snowshed
from snowshed.io.atomic import write_text
from snowshed.io.json_file import read_object
from snowshed.methods.mpm.settings import Scheme
from snowshed.plot.html_page import HtmlTable
from snowshed.study.store import Store

PAGE = DOCS / "thesis-schemes.md"
ORIGINS_FILE = "schemes-computed.json"
THESIS, OBJECTIVE = get_args(Scheme)
#: Size and scheme of the claims that `claims_page` keeps.
OF_CLAIMS_PAGE = ("middle", THESIS)


@dataclass(frozen=True)
class Group:
    """Claims that are judged by simulations of one kind.

    Attributes
    ----------
    label, place
        The simulations in the table, and in a sentence.
    sections
        Beginnings of the claims' sections.
    size
        Size of the reproduction whose claims with the scheme "thesis" are compared.
    """

    label: str
    place: str
    sections: tuple[str, ...]
    size: str

    def claims(self, file: Path) -> list[JudgedClaim]:
        """Return the claims of its sections in a table."""
        claims = read_claims(file)
        return [claim for claim in claims if claim.source.startswith(self.sections)]


SIMULATED = ("2", "3", "4", "Table 4")
#: Sections on simulations in 3D alone.
IN_SPACE = ("5.1.1", "beyond the thesis")
#: Sections on the rows of panels, and on their regression.
OF_ROWS = ("5.1.2", "5.3", "Figure 5", "Table 5")
GROUPS = {
    "middle": Group("3D", "in 3D", (*SIMULATED, *IN_SPACE), "middle"),
    "planar": Group("2D", "in 2D", SIMULATED, "planar"),
    "panels": Group("rows of panels", "in chapter 5", OF_ROWS, "middle"),
}
#: A claim with the finding of each scheme.
Pair = tuple[JudgedClaim, JudgedClaim]


def page(data: Path = DATA) -> str:
    """Return the page, from the results in a folder.

    Raises
    ------
    InputError
        If the results are damaged, two tables list different claims, or a changed verdict has no
        reason.
    """
    pairs = {name: _pairs(data, name) for name in GROUPS}
    changed = {name: [pair for pair in pairs[name] if _is_changed(pair)] for name in pairs}
    counts = [
        f"{group.place} {len(changed[name])} of {len(pairs[name])}"
        for name, group in GROUPS.items()
    ]
    parts = [
        "# The thesis's claims with both schemes",
        "This page is for those who ask which verdicts on the thesis depend on the [scheme]"
        "(../methods/mpm-scheme.md). The simulations were made with each: with "
        f"`{THESIS}`, which is the default, and with `{OBJECTIVE}`, whose stacks depend [less on "
        "the cells](stack-grid.md). Those of chapters 2 to 4 have the thesis's cells of 1 cm. "
        "Chapter 5 is judged by the [rows of panels that come with snowshed](prediction-record.md"
        "#the-rows-that-come-with-snowshed), which have cells of 1.5 cm.",
        "```sh\n"
        f"snowshed reproduce frischholz2023 --middle --scheme {OBJECTIVE} \\\n"
        "  --stage lab --stage s-index --stage fixation --stage calibration -o spatial\n"
        f"snowshed reproduce frischholz2023 --planar --scheme {OBJECTIVE} \\\n"
        "  --stage lab --stage s-index --stage fixation --stage calibration --stage regression "
        "-o planar\n"
        "```",
        f"Claims that have another verdict with `{OBJECTIVE}`: {', '.join(counts)}.",
        markdown_table(_counts_grid(pairs, _origins(data))),
        *_left_out(data, pairs),
    ]
    for name, group in GROUPS.items():
        same = [pair for pair in pairs[name] if pair not in changed[name]]
        parts += [
            f"## Claims with another verdict {group.place}",
            "\n".join(
                explanation(claim, REASONS[name], "reason", "scheme_reasons.py")
                for claim, _ in changed[name]
            ),
            markdown_table(_findings_grid(changed[name])),
            f"## Claims with the same verdict {group.place}",
            markdown_table(_findings_grid(same)),
        ]
    parts.append(
        "`python -m reproductions.frischholz2023.schemes_page` writes this page from the results "
        "in `reproductions/frischholz2023/data`. Do not edit it by hand."
    )
    return "\n\n".join(parts) + "\n"


def keep(folder: Path, data: Path = DATA) -> None:
    """Copy the claims from the folder of a reproduction, with the origin of its simulations.

    Claims of groups that the reproduction did not judge stay as they were.

    Raises
    ------
    InputError
        If the folder holds another reproduction.
    """
    identity = read_object(folder / IDENTITY)
    size, scheme = str(identity.get("size")), str(identity.get("scheme"))
    if size not in GROUPS or (size, scheme) == OF_CLAIMS_PAGE:
        raise InputError(
            f"{folder}: holds --{size} with the scheme {scheme}; allowed: --planar, and --middle "
            f"with the scheme {OBJECTIVE}"
        )
    reproduction = ReproductionFolder(folder)
    for name in (size, *(["panels"] if scheme == OBJECTIVE else [])):
        claims = GROUPS[name].claims(reproduction.claims)
        if claims:
            write_text(_file(data, name, scheme), claims_csv(claims))
    if GROUPS[size].claims(reproduction.claims):
        file = data / ORIGINS_FILE
        origins = read_object(file) if file.is_file() else {}
        with Store.open(reproduction.runs) as store:
            origins[f"{size}-{scheme}"] = origin_of_runs(store)
        write_text(file, json.dumps(origins) + "\n")


def _file(data: Path, name: str, scheme: str) -> Path:
    """Return the table of a group's claims with a scheme."""
    if (GROUPS[name].size, scheme) == OF_CLAIMS_PAGE:
        return data / CLAIMS_FILE
    return data / f"claims-{name}-{scheme}.csv"


def _pairs(data: Path, name: str) -> list[Pair]:
    """Return the claims of a group that were judged with both schemes."""
    claims = GROUPS[name].claims(_file(data, name, THESIS))
    of_thesis = {(claim.source, claim.text): claim for claim in claims}
    of_objective = GROUPS[name].claims(_file(data, name, OBJECTIVE))
    if not {(claim.source, claim.text) for claim in of_objective} <= set(of_thesis):
        raise InputError(f"{data}: the tables of the two schemes list different claims")
    return [(of_thesis[claim.source, claim.text], claim) for claim in of_objective]


def _is_changed(pair: Pair) -> bool:
    return pair[0].finding.verdict != pair[1].finding.verdict


def _left_out(data: Path, pairs: Mapping[str, Sequence[Pair]]) -> list[str]:
    """Return a paragraph for each group in which claims were not judged with both schemes."""
    paragraphs = []
    for name, group in GROUPS.items():
        judged = [of_thesis for of_thesis, _ in pairs[name]]
        missing = [
            claim for claim in group.claims(_file(data, name, THESIS)) if claim not in judged
        ]
        if missing:
            texts = "; ".join(f"{claim.text} ({claim.source})" for claim in missing)
            paragraphs.append(f"Not computed {group.place} with `{OBJECTIVE}`: {texts}")
    return paragraphs


def _origins(data: Path) -> Mapping[str, Mapping[str, object]]:
    of_thesis = read_object(data / COMPUTED_FILE)
    of_rows = dict.fromkeys(("runs", "date", "cpu"), "")  # which their own page names
    return {
        "-".join(OF_CLAIMS_PAGE): of_thesis,
        **{f"panels-{scheme}": of_rows for scheme in (THESIS, OBJECTIVE)},
        **read_object(data / ORIGINS_FILE),
    }


def _counts_grid(
    pairs: Mapping[str, Sequence[Pair]], origins: Mapping[str, Mapping[str, object]]
) -> HtmlTable:
    rows = []
    for name, group in GROUPS.items():
        for k, scheme in enumerate((THESIS, OBJECTIVE)):
            count = Counter(pair[k].finding.verdict for pair in pairs[name])
            origin = origins[f"{name}-{scheme}"]
            rows.append(
                [f"`{scheme}`, {group.label}"]
                + [str(count[verdict]) for verdict in VERDICTS]
                + [str(origin[column]) for column in ("runs", "date", "cpu")]
            )
    return HtmlTable(["scheme", *VERDICTS, "simulations", "date", "processor"], rows, "lrrrrll")


def _findings_grid(pairs: Sequence[Pair]) -> HtmlTable:
    rows = [
        [claims[0].source, claims[0].text]
        + [f"{claim.finding.verdict}: {claim.finding.sentence}" for claim in claims]
        for claims in pairs
    ]
    return HtmlTable(["section", "the thesis", f"`{THESIS}`", f"`{OBJECTIVE}`"], rows, "llll")


@click.command()
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path))
def main(folders: tuple[Path, ...]) -> None:
    """Write docs/trust/thesis-schemes.md, after taking results, if FOLDERS are given."""
    for folder in folders:
        keep(folder)
    write_text(PAGE, page())


if __name__ == "__main__":
    sys.exit(snowshed(command=main, name="python -m reproductions.frischholz2023.schemes_page"))
