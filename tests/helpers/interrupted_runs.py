"""Interruption of runs, and comparison of their files with those of uninterrupted runs."""

import signal

import pandas as pd


def compare_tables(first, second):
    for name in ("events.csv", "outline.csv"):
        a, b = (pd.read_csv(folder / name) for folder in (first, second))
        pd.testing.assert_frame_equal(
            a.drop(columns="wall_s", errors="ignore"),
            b.drop(columns="wall_s", errors="ignore"),
            check_exact=True,
        )
    assert (first / "film.bin").read_bytes() == (second / "film.bin").read_bytes()


def interrupt_at(event, moment):
    """Return a progress reporter that raises SIGINT once, when an event has reached a time."""
    interrupts = []

    def report(progress):
        if progress.event == event and progress.time >= moment and not interrupts:
            interrupts.append(progress)
            signal.raise_signal(signal.SIGINT)

    return report
