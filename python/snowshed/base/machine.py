"""Facts about the machine of a run, and the memory that it used."""

from __future__ import annotations

import platform
import resource
import sys
from datetime import datetime, timezone
from pathlib import Path

import numpy as np

import snowshed._core as _core
from snowshed.base.build import package_digest


def cpu_name() -> str:
    """Return the name of the processor; empty if the system does not provide it."""
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        for line in cpuinfo.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def peak_memory_mb() -> float:
    """Return the peak memory of this process so far, MB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e6 if sys.platform == "darwin" else peak * 1024 / 1e6


def machine_facts() -> dict[str, str]:
    """Return the facts about the machine, and about this program, that run.json holds."""
    return {
        "package": package_digest(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "machine": platform.platform(),
        "cpu": cpu_name(),
    }


def present_facts() -> dict[str, str]:
    """Return the facts that run.json holds about its run: program, build, date and machine."""
    return {
        "version": _core.version,
        "build": _core.build_id,
        "commit": _core.build_commit,
        "compiler": _core.build_compiler,
        "kernels": _core.kernel_variant(),
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        **machine_facts(),
    }
