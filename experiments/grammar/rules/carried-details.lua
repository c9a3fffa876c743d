-- Details that are carried along on a triangle mesh which deforms.
--
-- The root's own points are the vertices: each goes where the deformation takes it. An item sits on
-- a triangle (parameter `triangle`) at b0 p0 + b1 p1 + (1 - b0 - b1) p2. It goes to the same place
-- on the triangle as it is then, and turns as the triangle's frame does: first axis along p1 - p0,
-- third along the normal (p1 - p0) x (p2 - p0). An item that stands off its triangle keeps its
-- offset in that frame. Sizes stay.

local sqrt = math.sqrt

local function unit(x, y, z)
  local length = sqrt(x * x + y * y + z * z)
  return x / length, y / length, z / length
end

local function cross(ax, ay, az, bx, by, bz)
  return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
end

-- The frame's axes of a triangle, nine numbers: axis by axis.
local function frame(x0, y0, z0, x1, y1, z1, x2, y2, z2)
  local ax, ay, az = unit(x1 - x0, y1 - y0, z1 - z0)
  local nx, ny, nz = unit(cross(ax, ay, az, x2 - x0, y2 - y0, z2 - z0))
  local bx, by, bz = cross(nx, ny, nz, ax, ay, az)
  return ax, ay, az, bx, by, bz, nx, ny, nz
end

-- The quaternion that takes one frame to the other: the matrix sum_k after_k before_k^T.
local function change(ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz, ex, ey, ez, fx, fy, fz)
  return rotation.of_matrix(
    dx * ax + ex * bx + fx * cx, dx * ay + ex * by + fx * cy, dx * az + ex * bz + fx * cz,
    dy * ax + ey * bx + fy * cx, dy * ay + ey * by + fy * cy, dy * az + ey * bz + fy * cz,
    dz * ax + ez * bx + fz * cx, dz * ay + ez * by + fz * cy, dz * az + ez * bz + fz * cz)
end

rule{
  name = "surface follows the map", type = "surface-set", on = "free", phase = "down",
  apply = function(b)
    local e = b:element(1)
    for k = 0, b:point_count(e) - 1 do
      b:set_point(1, k, b:map(1, b:point_of(e, k)))
    end
    b:down(1)
  end
}

local function triangle(b, point, mesh, t)
  local i, j, k = b:triangle_of(mesh, t)
  local x0, y0, z0 = point(b, mesh, i)
  local x1, y1, z1 = point(b, mesh, j)
  return x0, y0, z0, x1, y1, z1, point(b, mesh, k)
end

local function on_triangle(u, v, x0, y0, z0, x1, y1, z1, x2, y2, z2)
  local w = 1 - u - v
  return u * x0 + v * x1 + w * x2, u * y0 + v * y1 + w * y2, u * z0 + v * z1 + w * z2
end

rule{
  name = "item is carried", type = "item", on = "free", from = "parent", phase = "down",
  apply = function(b)
    local mesh = b:parent(1)
    for i = 1, #b do
      local t, u, v = b:parameter(i, "triangle"), b:parameter(i, "b0"), b:parameter(i, "b1")
      local p0, p1, p2, p3, p4, p5, p6, p7, p8 = triangle(b, b.point_of, mesh, t)
      local n0, n1, n2, n3, n4, n5, n6, n7, n8 = triangle(b, b.point_now, mesh, t)
      if p0 ~= n0 or p1 ~= n1 or p2 ~= n2 or p3 ~= n3 or p4 ~= n4 or p5 ~= n5
         or p6 ~= n6 or p7 ~= n7 or p8 ~= n8 then
        local a0, a1, a2, a3, a4, a5, a6, a7, a8 = frame(p0, p1, p2, p3, p4, p5, p6, p7, p8)
        local qx, qy, qz, qw =
          change(a0, a1, a2, a3, a4, a5, a6, a7, a8, frame(n0, n1, n2, n3, n4, n5, n6, n7, n8))
        local bx, by, bz = on_triangle(u, v, p0, p1, p2, p3, p4, p5, p6, p7, p8)
        local x, y, z = b:position(i)
        local ox, oy, oz = rotation.apply(qx, qy, qz, qw, x - bx, y - by, z - bz)
        local ax, ay, az = on_triangle(u, v, n0, n1, n2, n3, n4, n5, n6, n7, n8)
        b:set_position(i, ax + ox, ay + oy, az + oz)
        b:set_turn(i, rotation.product(qx, qy, qz, qw, b:turn(i)))
      end
    end
  end
}
