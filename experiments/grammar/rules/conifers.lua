-- A forest on flat ground, without spacing (parameter `spacing` of "forest" is 0).
--
-- A conifer's foot goes where the deformation takes it in plan and keeps its height; the tree stays
-- upright and turns about the vertical as the deformation does there. Size, radius and height stay.
-- What the deformation leaves where it is stays bit for bit.
--
-- Constraints: z of the foot is what it was; the tree's axis is vertical.

bounds("conifer") -- an edit of one tree concerns no other

rule{
  name = "forest asks its trees", type = "forest", phase = "down",
  apply = function(b)
    for i = 1, #b do b:down(i) end
  end
}

local function stand(b)
  local sqrt = math.sqrt
  for i = 1, #b do
    local _, _, ground, qx, qy, qz, qw = b:pose(i)
    local x, y, _, _, _, rz, rw = b:mapped(i)
    -- The vertical part of the rotation: its components about z, scaled to length 1.
    local length = sqrt(rz * rz + rw * rw)
    if length > 0 then rz, rw = rz / length, rw / length else rz, rw = 0, 1 end
    b:set_pose(i, x, y, ground,
               rw * qx - rz * qy, rw * qy + rz * qx, rw * qz + rz * qw, rw * qw - rz * qz)
  end
end

for _, kind in ipairs{"free", "rigid", "affine", "translate"} do
  rule{name = "conifer stands (" .. kind .. ")", type = "conifer", on = kind, phase = "down",
       apply = stand}
end
