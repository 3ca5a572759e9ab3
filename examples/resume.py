"""Interrupt a run and resume it; the results are those of an uninterrupted run.

    python examples/resume.py [FOLDER [DX]]

Here the progress callback interrupts the run as Ctrl-C would. The command line resumes a run with

    snowshed run FOLDER/scene.json -o FOLDER --resume
"""

import signal
import sys

from snowshed import Interrupted, Progress, Scene, run_events


def press_ctrl_c(progress: Progress) -> None:
    """Interrupt as the second event starts."""
    if progress.event == 2 and progress.time == 0:
        signal.raise_signal(signal.SIGINT)


def main(folder: str = "resumed", dx: float = 0.01) -> None:
    """Run three events into `folder`, new or empty, with an interruption."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": dx, "events.count": 3})
    try:
        run_events(scene, folder, progress=press_ctrl_c)
    except Interrupted as interrupted:
        print(interrupted)
    table = run_events(scene, folder, resume=True)
    print(table[["event", "height_m", "length_m", "ended"]].to_string())


if __name__ == "__main__":
    main(*sys.argv[1:2], *map(float, sys.argv[2:3]))
