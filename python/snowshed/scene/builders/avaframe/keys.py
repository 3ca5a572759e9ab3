"""The keys of AvaFrame's com5SnowSlide: settings, fixed values, and keys without effect."""

from __future__ import annotations

from collections.abc import Mapping

#: Keys that are settings here.
SETTINGS: Mapping[str, str] = {
    "dt": "time_step",
    "rho": "density",
    "meshcellsize": "cell",
    "deltath": "layer_thickness",
    "xsivoellmy": "turbulence",
    "cohesionmaxstrain": "max_strain",
    "cohesivesurfacetension": "bond_modulus",
    "mindistcohesion": "min_bond_length",
    "cresh": "resistance",
    "forestvmin": "forest_min_speed",
    "forestthmin": "forest_min_thickness",
    "forestvmax": "forest_max_speed",
    "forestthmax": "forest_max_thickness",
    "subgridmixingfactor": "artificial_viscosity",
    "rhoent": "entrained_density",
    "enteroenergy": "erosion_energy",
    "entshearresistance": "entrainment_shear",
    "entdefresistance": "entrainment_work",
    "thresholdmasssplit": "split_ratio",
    "stopcrit": "stop_ratio",
    "thresholdadaptsfc": "ground_min_change",
}
#: Switches that let the ground adapt to the snow.
GROUND_SWITCHES: Mapping[str, str] = {
    "adaptsfcstopped": "ground_gains_stopped",
    "adaptsfcdetrainment": "ground_gains_detrained",
    "adaptsfcentrainment": "ground_loses_entrained",
}
#: Keys that are switches here.
SWITCHES: Mapping[str, str] = {
    "snowslide": "bonds",
    "explicitfriction": "explicit_friction",
    **GROUND_SWITCHES,
}
#: The key of the Coulomb coefficient in each law of friction, and its default in com5SnowSlide.
FRICTION: Mapping[str, tuple[str, float]] = {
    "voellmy": ("muvoellmy", 0.325),
    "coulomb": ("mucoulomb", 0.155),
}
#: Keys that may only have the one value that is supported here.
FIXED_VALUES: Mapping[str, str] = {
    "centeredposition": "1",
    "createrangetimediagram": "false",
    "curvaccinfriction": "1",
    "curvaccingradient": "0",
    "curvaccintangent": "0",
    "defaultconfig": "true",
    "depmin": "1e-6",
    "distsplitpart": "0.41",
    "exportdata": "true",
    "exportrasters": "false",
    "gravacc": "9.81",
    "inistep": "false",
    "initialiseparticlesfromfile": "false",
    "initpartdisttype": "triangular",
    "interpoption": "2",
    "massperparticledeterminationmethod": "mppdh",
    "meshcellsizethreshold": "0.001",
    "methodmeshnormal": "1",
    "minrkern": "0.001",
    "modeltype": "ssl",
    "reprojectioniterations": "5",
    "reprojmethodforce": "2",
    "reprojmethodposition": "2",
    "resistancemodel": "default",
    "resizethreshold": "3",
    "sphkernelradiustimestepping": "false",
    "sphoption": "1",
    "splitoption": "0",
    "stopcrittype": "kinenergy",
    "thresholdpointinpoly": "0.001",
    "trackparticles": "false",
    "velmagmin": "1e-6",
    "viscoption": "1",
    "writeparttocsv": "false",
}
#: Variations of a thickness, one simulation for each value.
VARIATIONS = tuple(
    f"{area}th{kind}variation"
    for area in ("rel", "ent", "secondaryrel")
    for kind in ("percent", "range", "rangefromci", "dist")
)
#: Keys that change nothing with the values above: they belong to pictures, random numbers, and
#: features that are switched off.
WITHOUT_EFFECT = (
    "adaptdemplot", "additionallyfixedfactor", "appk", "bufferzonefactor", "centertrackpartpoint",
    "cleanremeshedrasters", "cmax", "cmaxnmass", "cmaxnppk", "cminmass", "cminnppk",
    "contourrestype", "cpice", "cvmaxsediment", "cvsediment", "dtini", "enthref", "enttempref",
    "exportparticleproperties", "ftoptionini", "hmin", "massperpart", "maxiterations",
    "nppk0", "nsplit", "particlefile", "particleproperties", "radius",
    "rhosediment", "saveparticlesini", "scenario",
    "seed", "sizesediment", "sphkr0", "sphoptionini",
    "stopcritini", "stopcritinismall", "subgridmixingfactorini", "thfromini",
    "thresholdprojection", "thresholdvalue",
    "timestepdistance", "tini", "ttdiagram",
    "uflowingthreshold", "usecompression", "visuparticleproperties", "volclassmedium",
    "volclasssmall",
)  # fmt: skip
#: Endings of keys of laws of friction that no simulation here uses.
OTHER_FRICTION = (
    "samosat", "samosatsmall", "samosatmedium", "voellmyminshear", "coulombminshear", "wetsnow",
    "obrienandjulien", "herschelandbulkley", "bingham",
)  # fmt: skip
OWN_KEYS = (
    "dam", "detk", "detrainment", "dissdam", "entth", "entthfromfile", "entthifmissinginshp",
    "frictmodel", "niterdam", "releasescenario", "relth", "relthfromfile",
    "restitutioncoefficient", "restype", "secondaryrelth", "secondaryrelthfromfile", "secrelarea",
    "simtypelist", "sphkernelradius", "tend", "thresholdpointinrel",
    "timedependentrelease", "timedependentreleasescenarios", "tsteps",
    *(key for key, _ in FRICTION.values()),
)  # fmt: skip
