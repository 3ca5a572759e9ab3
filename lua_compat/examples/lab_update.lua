-- What differs from lab_init.lua: a steeper panel. Later values override earlier ones.

panel { tilt = 50 }
