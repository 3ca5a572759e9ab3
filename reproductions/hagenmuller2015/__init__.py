"""Reproduction of Hagenmuller, Chambon and Naaim (2015), doi:10.5194/tc-9-1969-2015."""
