from .ageing.ageing import Ageing as Ageing
from .ageing.ageing import Interval as Interval
from .extension import extend_run as extend_run
from .slide_history import particles_at as particles_at
from .slide_history import slide_states as slide_states
