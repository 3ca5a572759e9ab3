from .landing import Landing as Landing
from .landing import landing as landing
from .reach import distance_passed_by as distance_passed_by
from .report import write_loads as write_loads
from .rules import Rule as Rule
from .rules import RuleInputs as RuleInputs
from .rules import rules as rules
from .structures import structure_loads as structure_loads
