-- A sensitivity analysis with the reference snow and the geometry of the thesis (Table 3.2.1).
--
--   snowshed lua sensitivity_init.lua -o reference
--   snowshed lua sensitivity_init.lua sensitivity_update.lua --to-json scenes
--
-- The settings are those of the preset "sensitivity" and differ from the table in three points:
--   the panel is SEPARATE; the table has SLIP:       panel { condition = SLIP }
--   the stack is carried; the thesis reseeds it:     events { between = "reseed" }
--   events end at rest; the table has 50 frames:     frames { interval = 1 / 24, count = 50 }
-- The thesis prints neither the friction of the panel nor the frames per second.

dimension(3)
grid_size(0.01)

material { rho = 210, E = 1e6, nu = 0.3, M = 0.5, p0 = 5000, beta = 0.1, xi = 0.1 }

panel { height = 0.5, length = 0.245, width = 0.213, tilt = 40, condition = SEPARATE, friction = 0.3 }
slab { thickness = 0.02, length = 0.245, width = 0.142 }
ground { condition = STICKY }

events { count = 3 }

title "Sensitivity analysis, Table 3.2.1, reference snow"
