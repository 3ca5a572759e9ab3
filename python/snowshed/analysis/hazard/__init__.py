"""Maps of many slides: the probability that snow reaches a place, and its intensity."""
