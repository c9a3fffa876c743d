local pull = 0.5
bounds("joint")
rule{
  name = "joint goes part of the way", type = "joint", on = "free", phase = "down",
  apply = function(b)
    for i = 1, #b do
      local x, y, z = b:position(i)
      local mx, my, mz, qx, qy, qz, qw = b:mapped(i)
      b:set_position(i, x + pull * (mx - x), y + pull * (my - y), z + pull * (mz - z))
      b:down(i)
    end
  end
}
rule{
  name = "part grows", type = "part*", phase = "down",
  apply = function(b)
    local t = {}
    for i = 1, #b do t[i] = b:parameter(i, "length") * (1 + 0.1 * math.random()) end
    table.sort(t)
    for i, length in ipairs(t) do b:set_parameter(i, "length", length) end
  end
}
