"""Published relations between measured properties of snow and those that a simulation needs.

Each is a named function with its source, range and scatter (`Relation`). Relations without a second
source are left out, or say so.

Examples
--------
>>> relation = NEW_SNOW_DENSITY["hedstrom-pomeroy-1998"]
>>> round(relation(-5.0)), relation.outside(-30.0)
(75, ['temperature -30 degrees C (-20 to 0)'])
"""

from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY
from snowshed.snow.relations.relation import Relation
from snowshed.snow.relations.settling import SETTLING_LAWS
from snowshed.snow.relations.sintering import SINTERING_LAWS
from snowshed.snow.relations.snow import snow_from_density
from snowshed.snow.relations.stiffness import YOUNGS_MODULUS
from snowshed.snow.relations.strength import TENSILE_STRENGTH

__all__ = [
    "NEW_SNOW_DENSITY",
    "SETTLING_LAWS",
    "SINTERING_LAWS",
    "TENSILE_STRENGTH",
    "YOUNGS_MODULUS",
    "Relation",
    "snow_from_density",
]
