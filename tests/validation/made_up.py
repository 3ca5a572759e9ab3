"""A made-up case with known answers, which can also fail in several ways."""

import os
import signal
import sys
import time

from validation.framework.case import Case, Outcome, Quantity
from validation.framework.command import validate

from snowshed.cli.main import main
from snowshed.snow.accuracy.measurements import Measured

MEGABYTES = 150


def measure(settings):
    """Return errors of 4.4 dx^2 (apic) or 24 dx^2 (pic), and times of 0.02/dx s or 0.015/dx s."""
    mode, dx = settings.get("mode", "works"), settings.get("dx", 0.1)
    if mode == "raises":
        raise ValueError("no such\n snow")
    if mode == "crashes":
        os.kill(os.getpid(), signal.SIGKILL)
    if mode == "returns nothing":
        return None
    if mode == "measures something else":
        return Outcome([Measured("length", 1.0, 1.0, 0.0)], 1.0, 1)
    if mode == "needs memory":
        bytearray(MEGABYTES * 1_000_000)
    if mode == "takes long":
        time.sleep(60)
    if mode == "imports":
        imported = "colorsys" in sys.modules
        import colorsys

        return Outcome([Measured("height", float(imported), 0.0, 0.0)], bool(colorsys), 1)
    factor, cost = {"apic": (4.4, 0.02), "pic": (24.0, 0.015)}[settings.get("transfer", "apic")]
    error = factor * dx**2
    return Outcome(
        [Measured("height", 2 * (1 + error), 2.0, error), Measured("drift", error, 0.0, error)],
        wall_s=cost / dx,
        updates=1000,
        steps=10,
        particles=100,
    )


def matrix(full):
    sizes = (0.2, 0.1, 0.05) if full else (0.2, 0.1)
    return [{"dx": dx, "transfer": name} for dx in sizes for name in ("apic", "pic")]


HEIGHT = Quantity(
    "height", "height, m", limit=0.06, limit_for={"transfer": "apic", "dx": 0.1}, order_in="dx"
)
DRIFT = Quantity("drift", "drift, kg m2/s", relative=False, order_in="dx", min_order=1.9)


def made_up_case(*, entries=None, quantities=(HEIGHT, DRIFT), remarks="PIC damps."):
    return Case(
        name="made_up",
        title="A made-up case",
        source="Nowhere",
        description="A body falls.\n\nThe error is <known>.",
        quantities=quantities,
        matrix=matrix if entries is None else lambda full: list(entries),
        measure=measure,
        remarks=remarks,
    )


def program(*arguments):
    """Run ``python -m validation`` in this process and return its exit code."""
    return main(
        [str(argument) for argument in arguments], command=validate, name="python -m validation"
    )
