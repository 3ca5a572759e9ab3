"""Tables in Markdown."""

from __future__ import annotations

from snowshed.plot.html_page import HtmlTable


def markdown_table(grid: HtmlTable) -> str:
    """Return a table in Markdown.

    Examples
    --------
    >>> print(markdown_table(HtmlTable(["name", "m"], [["a", "1"]], "lr")))
    | name | m |
    | --- | ---: |
    | a | 1 |
    """
    marks = ["---:" if letter == "r" else "---" for letter in grid.align]
    lines = [grid.head, marks, *([cell.replace("|", "\\|") for cell in row] for row in grid.rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
