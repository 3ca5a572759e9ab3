-- The laboratory experiment of the thesis (Tables 2.3.1 and 4.1.1): the panel at 40 degrees.
--
--   snowshed lua lab_init.lua -o lab-40
--   snowshed lua lab_init.lua lab_update.lua -o lab-50
--
-- The settings are those of the preset "lab-40" and differ from Table 4.1.1 in three points:
--   the panel is SEPARATE; the table has SLIP:       panel { condition = SLIP }
--   the stack is carried; the thesis reseeds it:     events { between = "reseed" }
--   events end at rest; the table has 60 frames:     frames { interval = 1 / 24, count = 60 }
-- The thesis prints neither the friction of the panel nor the frames per second.

title "Laboratory experiment, Tables 2.3.1 and 4.1.1, calibrated snow"
dimension(3)
gravity(9.81) -- m/s2, along -z
grid_size(0.01) -- m

-- Calibrated snow (Table 4.3.1) in the thesis's symbols; units kg/m3 and Pa.
material {
  rho = 210,
  E = 1e6,
  nu = 0.3,
  M = 0.5,
  p0 = 7000,
  beta = 0.2,
  xi = 0.1,
}

-- The panel is simulated 1.5 times as wide as the slab, so that no snow falls off its sides (Table
-- 4.1.1). The panel of the experiment was as wide as the slab, 0.142 m (Table 2.3.1).
local length = 0.245 -- m

panel {
  height = 0.33,
  length = length,
  width = 0.213,
  tilt = 40,
  condition = SEPARATE,
  friction = 0.3,
}
slab { thickness = 0.02, length = length, width = 0.142 }
ground { condition = STICKY }

events { count = 5 }
