"""Interrupted runs, and comparison of their tables with those of uninterrupted runs."""

import signal

import pandas as pd


def compare_tables(one, other):
    for name in ("events.csv", "outline.csv"):
        a, b = (pd.read_csv(folder / name) for folder in (one, other))
        pd.testing.assert_frame_equal(
            a.drop(columns="wall_s", errors="ignore"),
            b.drop(columns="wall_s", errors="ignore"),
            check_exact=True,
        )
    assert (one / "film.bin").read_bytes() == (other / "film.bin").read_bytes()


def interrupt_at(event, moment):
    """A progress reporter that presses Ctrl-C once in the given event, after some time."""
    pressed = []

    def report(progress):
        if progress.event == event and progress.time >= moment and not pressed:
            pressed.append(progress)
            signal.raise_signal(signal.SIGINT)

    return report
