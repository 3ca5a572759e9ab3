-- The sensitivity analysis of the thesis (Table 3.2.1): reference snow and geometry.
--
--   snowshed lua sensitivity_init.lua -o reference
--   snowshed lua sensitivity_init.lua sensitivity_update.lua --to-json scenes

dimension(3)
grid_size(0.01)

material { rho = 210, E = 1e6, nu = 0.3, M = 0.5, p0 = 5000, beta = 0.1, xi = 0.1 }

panel { height = 0.5, length = 0.245, width = 0.213, tilt = 40, condition = SEPARATE, friction = 0.3 }
slab { thickness = 0.02, length = 0.245, width = 0.142 }
ground { condition = STICKY }

events { count = 3 }

title "Sensitivity analysis, Table 3.2.1, reference snow"
