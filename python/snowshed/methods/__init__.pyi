from .grains.curve import LoadingCurve as LoadingCurve
from .grains.phases import Phases as Phases
from .grains.phases import find_phases as find_phases
from .grains.phases import mean_stress as mean_stress
from .grains.summary import GrainsSummary as GrainsSummary
from .slide.states import SlideState as SlideState
from .slide.states import slide_states as slide_states
from .slide.summary import SlideSummary as SlideSummary
