-- Three fences, three runs. An item that has a name is changed by using the name again.

for _, friction in ipairs { 0.2, 0.4, 0.8 } do
  for i = 0, 2 do
    levelset { name = "post " .. i, friction = friction }
  end
  run("friction-" .. friction)
end
