"""Maps of many slides: how often snow comes where, and how hard."""
