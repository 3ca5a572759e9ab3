from .answer import ClearanceResult as ClearanceResult
from .answer import required_clearance as required_clearance
from .panel_design import PanelDesign as PanelDesign
from .panel_design import SnowRanges as SnowRanges
from .winters import Winter as Winter
from .winters import split_winters as split_winters
