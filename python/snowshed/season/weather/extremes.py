"""Record amounts of snow; larger amounts in a file are errors."""

from __future__ import annotations

#: New snow in 24 hours: 75.8 inches at Silver Lake, Colorado, on 14 and 15 April 1921 (Paulhus
#: 1953, Mon. Weather Rev. 81, 38-40).
RECORD_DAY = 1.93  # m
#: New snow of a winter: 1140 inches on Mount Baker, Washington, in 1998/99 (Leffler et al. 2001,
#: Natl. Weather Dig. 25).
RECORD_WINTER = 28.96  # m
RECORD_WORDS = f"no more than {RECORD_DAY:g} m was ever measured in 24 hours (Paulhus 1953)"
