-- A steeper panel than in lab_init.lua. Later values override earlier ones.

panel { tilt = 50 }
