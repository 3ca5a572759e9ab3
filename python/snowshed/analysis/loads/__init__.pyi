from .free_flight import Landing as Landing
from .free_flight import landing as landing
from .reach import distance_passed_by as distance_passed_by
from .report import write_loads as write_loads
from .standards import Rule as Rule
from .standards import RuleInputs as RuleInputs
from .standards import rules as rules
from .structures import structure_loads as structure_loads
