-- Three runs with different fences. An item with a name is changed when the name is used again.

for _, friction in ipairs { 0.2, 0.4, 0.8 } do
  for i = 0, 2 do
    levelset { name = "post " .. i, friction = friction }
  end
  run("friction-" .. friction)
end
