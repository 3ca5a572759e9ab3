-- A panel above a yard with a fence and an old heap of snow, in 2D: vectors are {x, z}.
--
--   snowshed lua yard_init.lua -o yard
--   snowshed lua yard_init.lua yard_update.lua -o yards

title "Panel above a yard"
dimension(2)
grid_size(0.02)

material "calibrated" -- the calibrated snow of the thesis,
material { rho = 250 } -- with another density

panel { height = 0.5, length = 1, tilt = 45, friction = 0.2 }
slab { thickness = 0.06 }
ground { tilt = 5, condition = STICKY }

-- Posts of a fence along the slide direction.
for i = 0, 2 do
  local x = 1.2 + 0.3 * i
  levelset {
    name = "post " .. i,
    shape = box { center = { x, -0.1 }, size = { 0.04, 0.3 } },
    condition = SEPARATE,
    friction = 0.4,
  }
end

-- The heap is a disc that is cut off at the ground.
body {
  name = "heap",
  shape = difference {
    sphere { center = { 0.9, 0 }, radius = 0.08 },
    box { center = { 0.9, -0.13 }, size = { 0.4, 0.2 } },
  },
  event = 1,
}

events { count = 2 }
frames { interval = 0.1, count = 50 } -- s; an event lasts at most 5 s
