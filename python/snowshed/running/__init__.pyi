from .ageing.ageing import Ageing as Ageing
from .ageing.ageing import Interval as Interval
from .extension import extend_run as extend_run
