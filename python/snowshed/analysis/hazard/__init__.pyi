from .candidate_files import candidate_table as candidate_table
from .candidate_files import write_candidates as write_candidates
from .candidates import ReleaseCandidate as ReleaseCandidate
from .candidates import ReleaseCandidates as ReleaseCandidates
from .candidates import ReleaseRules as ReleaseRules
from .candidates import find_release_areas as find_release_areas
from .maps import hazard_maps as hazard_maps
