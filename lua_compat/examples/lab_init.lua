-- The laboratory experiment of the thesis (Tables 2.3.1 and 4.1.1): the panel at 40 degrees.
--
--   snowshed lua lab_init.lua -o lab-40
--   snowshed lua lab_init.lua lab_update.lua -o lab-50

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

-- The panel is simulated 1.5 times as wide as the slab, so that no snow falls off its sides.
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
