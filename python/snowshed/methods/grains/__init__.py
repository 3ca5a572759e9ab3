"""Grains of snow: discrete elements with bonds that break."""

from snowshed.methods.grains.settings import GrainsSettings
from snowshed.methods.method import Method

METHOD = Method(
    name="grains",
    title="Grains of snow under load",
    settings=GrainsSettings,
    run="snowshed.methods.grains.run:GrainsRun",
    results={
        "summary": "snowshed.methods.grains.summary:GrainsSummary.read",
        "curve": "snowshed.methods.grains.curve:read_curve",
        "forces": "snowshed.methods.grains.contacts:read_forces",
    },
    in_memory={
        "curve": "snowshed.methods.grains.curve:present_curve",
        "forces": "snowshed.methods.grains.contacts:present_forces",
    },
)
