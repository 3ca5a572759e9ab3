"""Published relations between measured properties of snow and those that a simulation needs.

Each is a named function with its source, range and scatter (`Relation`). Relations without a second
source are left out, or their description says that they have none.

Examples
--------
>>> from snowshed.snow import NEW_SNOW_DENSITY
>>> relation = NEW_SNOW_DENSITY["hedstrom-pomeroy-1998"]
>>> round(relation(-5.0)), relation.outside(-30.0)
(75, ['temperature -30 degrees C (-20 to 0)'])
"""
