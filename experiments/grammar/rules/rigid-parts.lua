-- Skinning of rigid parts: a chain of joints, each with a part that is rigid with it.
--
-- A rotation that the user asks of a joint (or of its part) turns everything below about the
-- joint's position p: x -> p + R (x - p). That is forward kinematics: the motion of a part is the
-- product of those of the joints above it, and a part has one bone of weight 1.
--
-- Constraints: parts keep their shape, and the place that they have at their joint.

bounds("joint") -- what is above a joint stays

rule{
  name = "part is its joint", type = "part", on = "rigid", from = "user", phase = "up",
  apply = function(b) b:up() end
}

rule{
  name = "joint turns about itself", type = "joint", on = "rigid", from = "user", phase = "down",
  apply = function(b)
    for i = 1, #b do
      local x, y, z = b:position(i)
      local _, _, _, qx, qy, qz, qw = b:mapped(i)
      b:set_turn(i, rotation.product(qx, qy, qz, qw, b:turn(i)))
      b:down(i, delta.turn(x, y, z, qx, qy, qz, qw))
    end
  end
}

rule{
  name = "joint turns for its part", type = "joint", on = "rigid", from = "child", phase = "down",
  apply = function(b)
    local x, y, z = b:position(1)
    local _, _, _, qx, qy, qz, qw = b:mapped(1)
    b:set_turn(1, rotation.product(qx, qy, qz, qw, b:turn(1)))
    b:down(1, delta.turn(x, y, z, qx, qy, qz, qw))
  end
}

for _, kind in ipairs{"joint", "part"} do
  rule{
    name = kind .. " is carried", type = kind, on = "rigid", from = "parent", phase = "down",
    apply = function(b)
      for i = 1, #b do
        local x, y, z, qx, qy, qz, qw = b:mapped(i)
        b:set_position(i, x, y, z)
        b:set_turn(i, rotation.product(qx, qy, qz, qw, b:turn(i)))
        b:down(i)
      end
    end
  }
end
