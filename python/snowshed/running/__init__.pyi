from .ageing.ageing import Ageing as Ageing
from .ageing.ageing import Interval as Interval
from .extension import extend_run as extend_run
from .laws import LAW_PROTOTYPES as LAW_PROTOTYPES
from .laws import LAW_SIGNATURES as LAW_SIGNATURES
from .laws import Laws as Laws
from .progress_bar import ProgressBar as ProgressBar
