"""HTML pages, parsed for tests."""

from html.parser import HTMLParser
from typing import Optional

VOID = {"meta", "br", "img", "link", "hr", "input"}


class Page(HTMLParser):
    """Checks that tags are balanced, and gathers the content of the page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[Optional[str]] = []
        self.links: list[Optional[str]] = []
        self.sources: list[Optional[str]] = []
        self.images: list[Optional[str]] = []
        self.rows: list[list[str]] = []
        self.text: list[str] = []
        self.feed(html)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, attributes: list[tuple[str, Optional[str]]]) -> None:
        """Gather the ids, links and images of a tag."""
        values = dict(attributes)
        self.ids += [values["id"]] if "id" in values else []
        self.links += [values["href"]] if "href" in values else []
        self.sources += [values["src"]] if "src" in values else []
        self.images += [values["src"]] if tag == "img" else []
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        """Check that the tag was the last to be opened."""
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        """Gather the text of the page and of table cells."""
        if "style" not in self.open:
            self.text.append(data)
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data
