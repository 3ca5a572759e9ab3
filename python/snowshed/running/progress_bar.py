"""A progress bar for scripts and notebooks."""

from __future__ import annotations

from typing import Any

from snowshed.base.extras import require
from snowshed.base.progress import Progress

FORMAT = "{desc} |{bar}| {percentage:3.0f} % [{elapsed}{postfix}]"


class ProgressBar:
    """A bar for ``progress=`` of runs, studies and seasons: a widget in notebooks, else a line.

    A bar object may be used again: the next run begins a new bar.

    Raises
    ------
    InputError
        If tqdm is not installed (extra ``notebook``).

    Examples
    --------
    >>> from snowshed.base.progress import Progress
    >>> bar = ProgressBar()
    >>> for step in (1, 2):
    ...     bar(Progress(step / 2, step, 2, "events"))
    >>> bar.shown
    False
    """

    def __init__(self) -> None:
        self._tqdm = require("tqdm.auto", "notebook", "a progress bar")
        self._bar: Any = None

    @property
    def shown(self) -> bool:
        """Whether a run is under way on the bar."""
        return self._bar is not None

    def __call__(self, progress: Progress) -> None:
        """Show a report."""
        if self._bar is not None and progress.fraction < self._bar.n:  # another run has begun
            self.close()
        if self._bar is None:
            self._bar = self._tqdm.tqdm(total=1.0, bar_format=FORMAT)
        self._bar.set_description_str(progress.description, refresh=False)
        if progress.failed:
            self._bar.set_postfix_str(f"{progress.failed} failed", refresh=False)
        self._bar.n = min(progress.fraction, 1.0)
        self._bar.refresh()
        if progress.fraction >= 1.0:
            self.close()

    def close(self) -> None:
        """End the bar, which stays visible; after an interrupt it shows how far the run came."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None
