"""Tables of docs/trust/performance.md, from the cases that benchmarks/record.py measured.

Usage: python -m benchmarks.tables benchmarks/results/DATE.json
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

Case = dict[str, Any]

#: Features, each with the two cases whose difference is its cost.
PRICES = {
    "third dimension (27 nodes instead of 9)": ("base_3d", "base_2d"),
    "plasticity and hardening, snow not yielding": ("cam_clay_elastic", "base_3d"),
    "plasticity and hardening, all snow yielding": ("ground_cam_clay_in_flow", "sticky_contact"),
    "double precision": ("double", "base_3d"),
    "cubic splines (64 nodes)": ("cubic", "base_3d"),
    "APIC": ("apic", "base_3d"),
    "sticky ground": ("sticky_contact", "base_3d"),
    "ground with friction, slip": ("slip_contact", "base_3d"),
    "ground with friction, separate": ("separate_contact", "base_3d"),
    "sticky ground that moves": ("moving_contact", "base_3d"),
    "several snows": ("several_snows", "cam_clay_elastic"),
    "energy balance, with several snows": ("energy_balance", "cam_clay_elastic"),
    "sleep, of snow in motion": ("sleep_of_awake_snow", "base_3d"),
    "sleep, of snow at rest": ("sleep_at_rest", "cam_clay_elastic"),
}


def speeds(cases: list[Case]) -> None:
    """Print the speed of whole steps, and their share of the bare kernel's."""
    by_name = {case["case"]: case for case in cases}
    print("| case | threads | M updates/s | over the bare kernel | bytes per particle |")
    print("| --- | --- | --- | --- | --- |")
    for name, case in by_name.items():
        if not name.startswith(("slab_", "bare_")):
            continue
        what, threads = name.rsplit("/", 1)
        bare = by_name[f"bare_kernel_3d/float/{threads}"]["updates_per_s"]
        share = f"{case['updates_per_s'] / bare:.2f}" if name.startswith("slab_3d/float") else ""
        memory = f"{case['bytes_per_particle']:.0f}" if case["bytes_per_particle"] else ""
        speed = case["updates_per_s"] / 1e6
        print(f"| {what} | {threads} | {speed:.1f} | {share} | {memory} |")


def prices(cases: list[Case]) -> None:
    """Print the cost of each feature in an update, in ns and in bytes per particle."""
    prefix = "price/"
    features = {
        case["case"][len(prefix) :].rsplit("/", 1)[0]: case
        for case in cases
        if case["case"].startswith(prefix)
    }
    ns = {name: 1e9 / case["updates_per_s"] for name, case in features.items()}
    size = {name: case["bytes_per_particle"] for name, case in features.items()}
    print("| feature | ns per update | bytes per particle |\n| --- | --- | --- |")
    print(f"| plain elastic snow in 3D | {ns['base_3d']:.1f} | {size['base_3d']:.0f} |")
    for feature, (with_it, without) in PRICES.items():
        more, bytes_more = ns[with_it] - ns[without], size[with_it] - size[without]
        print(f"| {feature} | {more:+.1f} | {bytes_more:+.0f} |")


def exponent(cases: list[Case]) -> float:
    """Return the exponent of the number of particles in the time of a step."""
    scaled = [case for case in cases if case["case"].startswith("scaling_")]
    particles = np.array([float(case["case"].split("/")[1]) for case in scaled])
    seconds = particles / np.array([case["updates_per_s"] for case in scaled])
    return float(np.polyfit(np.log(particles), np.log(seconds), 1)[0])


def scaling(cases: list[Case]) -> None:
    """Print speed and memory against the number of particles."""
    print("| particles | M updates/s | bytes per particle | of the process |")
    print("| --- | --- | --- | --- |")
    for case in cases:
        if not case["case"].startswith("scaling_"):
            continue
        particles = int(case["case"].split("/")[1])
        process = (
            f"{1e6 * case['peak_memory_mb'] / particles:.0f}" if "peak_memory_mb" in case else ""
        )
        speed, memory = case["updates_per_s"] / 1e6, case["bytes_per_particle"]
        print(f"| {particles:,} | {speed:.1f} | {memory:.0f} | {process} |")
    print(
        f"\nThe time of a step grows with the particle number to the power {exponent(cases):.3f}."
    )


def whole_problems(cases: list[Case]) -> None:
    """Print the runs with several events."""
    print("| case | wall, s | M updates/s | share asleep | MB | heights, m | lengths, m |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for case in cases:
        if "steps" not in case:
            continue
        asleep = case["slept_updates"] / (case["slept_updates"] + case["particle_updates"])
        heights, lengths = (
            " ".join(f"{value:.3f}" for value in case[key]) for key in ("height_m", "length_m")
        )
        print(
            f"| {case['case']} | {case['wall_s']:.1f} | {case['updates_per_s'] / 1e6:.1f} "
            f"| {asleep:.0%} | {case['peak_memory_mb']:.0f} | {heights} | {lengths} |"
        )


def print_tables(cases: list[Case]) -> None:
    """Print all tables in the order of docs/trust/performance.md."""
    for table in (speeds, prices, scaling, whole_problems):
        table(cases)
        print()


if __name__ == "__main__":
    print_tables(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["cases"])
