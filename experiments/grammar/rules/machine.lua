-- An engine of two opposed cylinders, imported from glTF (2CylinderEngine.glb). Its nodes have no
-- names, so types are named after meshes, without the numbers at their ends; the axes below are
-- those of the parts' frames (z up). Six rules, by patterns of names. A deformation m of space:
--
-- 1. "body*": castings, covers, bolts. Goes with m, keeps its axes (the turn is what it was) and
--    stretches along each axis a as m does there, by |J a|, between 1/2 and 2.
-- 2. "Piston*": slides along its cylinder, the axis x of its frame: the shift is a multiple of x,
--    the turn is what it was.
-- 3. "rod*": stays in the plane of its motion, whose normal is the axis y of its frame: the shift
--    has no part along y, and the turn is about y only.
-- 4. "Lifter*": slides along its own axis y, as a piston does along x.
-- 5. "Spring_Link*": the links of one spring or chain move as one rigid body, that of m at their
--    middle: distances between the links of one parent stay.
-- 6. "*": groups, which hold parts and have no shape: move rigidly with m and ask their parts.
--
-- No part but the body's changes its size. What m leaves where it is stays bit for bit.

local half, double = 0.5, 2

rule{
  name = "body keeps its axes", type = "body*", on = "free", phase = "down",
  apply = function(b)
    local sqrt, min, max = math.sqrt, math.min, math.max
    local axes = {{"stretch_x", 1, 0, 0}, {"stretch_y", 0, 1, 0}, {"stretch_z", 0, 0, 1}}
    for i = 1, #b do
      local px, py, pz = b:position(i)
      local qx, qy, qz, qw = b:turn(i)
      local x, y, z, xx, xy, xz, yx, yy, yz, zx, zy, zz = b:map_jacobian(i, px, py, pz)
      local still = xx == 1 and yy == 1 and zz == 1 and xy == 0 and xz == 0 and yx == 0
                    and yz == 0 and zx == 0 and zy == 0
      b:set_position(i, x, y, z)
      for _, axis in ipairs(still and {} or axes) do
        local ax, ay, az = rotation.apply(qx, qy, qz, qw, axis[2], axis[3], axis[4])
        local ux, uy, uz = xx * ax + xy * ay + xz * az, yx * ax + yy * ay + yz * az,
                           zx * ax + zy * ay + zz * az
        local factor = b:parameter(i, axis[1]) * sqrt(ux * ux + uy * uy + uz * uz)
        b:set_parameter(i, axis[1], max(half, min(double, factor)))
      end
      b:down(i)
    end
  end
}

-- A part that slides along one axis of its frame.
local function slide(name, type, ax, ay, az)
  rule{
    name = name, type = type, on = "free", phase = "down",
    apply = function(b)
      for i = 1, #b do
        local x, y, z = b:position(i)
        local mx, my, mz = b:map(i, x, y, z)
        local qx, qy, qz, qw = b:turn(i)
        local dx, dy, dz = rotation.apply(qx, qy, qz, qw, ax, ay, az)
        local s = (mx - x) * dx + (my - y) * dy + (mz - z) * dz
        if s ~= 0 then b:set_position(i, x + s * dx, y + s * dy, z + s * dz) end
        b:down(i)
      end
    end
  }
end

slide("piston slides", "Piston*", 1, 0, 0)
slide("lifter slides", "Lifter*", 0, 1, 0)

rule{
  name = "rod stays in its plane", type = "rod*", on = "free", phase = "down",
  apply = function(b)
    for i = 1, #b do
      local x, y, z = b:position(i)
      local qx, qy, qz, qw = b:turn(i)
      local mx, my, mz, rx, ry, rz, rw = b:mapped(i)
      local nx, ny, nz = rotation.apply(qx, qy, qz, qw, 0, 1, 0)
      local s = (mx - x) * nx + (my - y) * ny + (mz - z) * nz
      b:set_position(i, mx - s * nx, my - s * ny, mz - s * nz)
      local tx, ty, tz, tw = rotation.twist(rx, ry, rz, rw, nx, ny, nz)
      b:set_turn(i, rotation.product(tx, ty, tz, tw, qx, qy, qz, qw))
      b:down(i)
    end
  end
}

rule{
  name = "links move as one", type = "Spring_Link*", on = "free", phase = "down",
  apply = function(b)
    local cx, cy, cz = 0, 0, 0
    for i = 1, #b do
      local x, y, z = b:position(i)
      cx, cy, cz = cx + x / #b, cy + y / #b, cz + z / #b
    end
    local mx, my, mz, rx, ry, rz, rw = b:map_rotation(1, cx, cy, cz)
    if mx == cx and my == cy and mz == cz and rw == 1 then return end
    for i = 1, #b do
      local x, y, z = b:position(i)
      local dx, dy, dz = rotation.apply(rx, ry, rz, rw, x - cx, y - cy, z - cz)
      b:set_position(i, mx + dx, my + dy, mz + dz)
      b:set_turn(i, rotation.product(rx, ry, rz, rw, b:turn(i)))
    end
  end
}

rule{
  name = "group asks its parts", type = "*", on = "free", phase = "down",
  apply = function(b)
    for i = 1, #b do
      local x, y, z, rx, ry, rz, rw = b:mapped(i)
      b:set_position(i, x, y, z)
      b:set_turn(i, rotation.product(rx, ry, rz, rw, b:turn(i)))
      b:down(i)
    end
  end
}
