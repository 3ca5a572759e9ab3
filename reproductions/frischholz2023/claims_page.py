"""The page ``docs/trust/thesis-claims.md``: every claim of the thesis with our verdict.

Its numbers come from the folder ``data``, which holds the claims of the last ``--middle``; ``python
-m reproductions.frischholz2023.claims_page`` writes it again. Likely causes of contradictions are
in `reproductions.frischholz2023.claims.causes`.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Optional

import click

from reproductions.common.claims_tables import VERDICTS, claims_csv, claims_table, read_claims
from reproductions.common.folder import ReproductionFolder
from reproductions.common.hypothesis_tests import CONTRADICTED, JudgedClaim
from reproductions.common.markdown import markdown_table
from reproductions.frischholz2023.claims.causes import CAUSES
from snowshed._core import InputError
from snowshed.cli.main import main as snowshed
from snowshed.io.atomic import write_text
from snowshed.study.store import Store

DATA = Path(__file__).with_name("data")
DOCS = Path(__file__).parents[2] / "docs" / "trust"
PAGE, REPORT = DOCS / "thesis-claims.md", DOCS / "reports" / "thesis-middle.html"
REPORT_FILE = "thesis.html"  # of `--middle`
CLAIMS_FILE, COMPUTED_FILE = "claims.csv", "claims-computed.json"
#: SQL condition for runs of a study; a store may also hold runs of earlier sizes.
OF_A_STUDY = "hash IN (SELECT hash FROM study_run)"


def page(data: Path = DATA) -> str:
    """Return the page, from the results in a folder.

    Raises
    ------
    InputError
        If the results are damaged, or a contradiction has no cause.
    """
    claims = read_claims(data / CLAIMS_FILE)
    computed = json.loads((data / COMPUTED_FILE).read_text(encoding="utf-8"))
    counts = Counter(claim.finding.verdict for claim in claims)
    verdicts = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS)
    parts = [
        "# The thesis's claims",
        "This page lists our verdicts on the thesis's "
        f"{len(claims)} claims: {verdicts}. They come from "
        "`snowshed reproduce frischholz2023 --middle`. [The report](reports/thesis-middle.html) "
        "has the figures, the tables and the rule for each claim.",
        f"The {computed['runs']} simulations were finished on {computed['date']}, on "
        f"{computed['cpu']}. [Reproducing the thesis](reproduce.md) explains the simulations and "
        "the verdicts, and [the gap](thesis-gap.md) explains the differences between our stacks of "
        "chapter 5 and those of the thesis. A number after ± is the standard deviation of the "
        "noise.",
        "`python -m reproductions.frischholz2023.claims_page` writes this page from the results "
        "in `reproductions/frischholz2023/data`. Do not edit it by hand.",
        "## Contradicted claims, and their likely causes",
        "\n".join(
            explanation(claim, CAUSES, "cause", "causes.py")
            for claim in claims
            if claim.finding.verdict == CONTRADICTED
        ),
        "## All claims",
        markdown_table(claims_table(claims, "the thesis")),
    ]
    return "\n\n".join(parts) + "\n"


def explanation(claim: JudgedClaim, texts: Mapping[str, str], kind: str, file: str) -> str:
    """Return a line of a list with a claim and the text on it, a cause or a reason.

    Raises
    ------
    InputError
        If the file has no text on the claim.
    """
    if claim.text not in texts:
        raise InputError(f"claims/{file}: no {kind} for {claim.text!r}")
    return f"- **{claim.text}** ({claim.source}) {texts[claim.text]}"


def keep(folder: Path, data: Path = DATA, report: Path = REPORT) -> None:
    """Copy the claims and the report from a reproduction's folder.

    Raises
    ------
    InputError
        If the folder holds no finished reproduction.
    """
    reproduction = ReproductionFolder(folder)
    claims = read_claims(reproduction.claims)
    with Store.open(reproduction.runs) as store:
        ((left,),) = store.read(
            f"SELECT count(*) FROM run WHERE status = 'pending' AND {OF_A_STUDY}"
        )
        if left:
            raise InputError(f"{folder}: {left} simulations are not computed yet")
        origin = origin_of_runs(store)
    write_text(data / CLAIMS_FILE, claims_csv(claims))
    write_text(data / COMPUTED_FILE, json.dumps(origin) + "\n")
    report.parent.mkdir(exist_ok=True)
    shutil.copyfile(folder / REPORT_FILE, report)


def origin_of_runs(store: Store) -> dict[str, object]:
    """Return the number of computed simulations, and the date and the processor of the last."""
    ((runs, date, cpu),) = store.read(
        "SELECT count(*), substr(max(finished), 1, 10), max(cpu) FROM run_timing"
        f" WHERE {OF_A_STUDY}"
    )
    return {"runs": runs, "date": date, "cpu": cpu}


@click.command()
@click.argument("folder", required=False, type=click.Path(path_type=Path))
def main(folder: Optional[Path]) -> None:
    """Write docs/trust/thesis-claims.md, after taking the results in FOLDER, if one is given."""
    if folder is not None:
        keep(folder)
    write_text(PAGE, page())


if __name__ == "__main__":
    sys.exit(snowshed(command=main, name="python -m reproductions.frischholz2023.claims_page"))
