from .relations.new_snow import NEW_SNOW_DENSITY as NEW_SNOW_DENSITY
from .relations.relation import Relation as Relation
from .relations.settling import SETTLING_LAWS as SETTLING_LAWS
from .relations.sintering import SINTERING_LAWS as SINTERING_LAWS
from .relations.snow import snow_from_density as snow_from_density
from .relations.stiffness import YOUNGS_MODULUS as YOUNGS_MODULUS
from .relations.strength import TENSILE_STRENGTH as TENSILE_STRENGTH
