from .maps import hazard_maps as hazard_maps
