-- Free-form deformation (Sederberg and Parry 1986) of a volume of grains, evaluated here.
--
-- With control points at low + (i / (l-1), j / (m-1), k / (n-1)) (high - low), each shifted by
-- d_ijk, a point of local coordinates (s, t, u) in the box moves by
--   sum_ijk B_i(s) B_j(t) B_k(u) d_ijk,   B_i of degree l-1: binomial(l-1, i) s^i (1-s)^(l-1-i).
-- The control points reach the script as constants: lattice_low, lattice_high (m), lattice_points
-- (how many along x, y, z), lattice_shifts (x, y, z of each, the control points' x fastest). They
-- are those of the whole gesture. Outside of the box nothing moves.

local low, high = constants.lattice_low, constants.lattice_high
local counts, shifts = constants.lattice_points, constants.lattice_shifts

local function binomials(degree)
  local row = {1}
  for i = 1, degree do row[i + 1] = row[i] * (degree - i + 1) / i end
  return row
end

local axes = {}
for k = 1, 3 do axes[k] = {count = counts[k], binomial = binomials(counts[k] - 1), weight = {}} end

-- Values of the Bernstein polynomials of an axis at s.
local function weigh(axis, s)
  local degree, weight = axis.count - 1, axis.weight
  local power = 1
  for i = 0, degree do
    weight[i + 1] = axis.binomial[i + 1] * power
    power = power * s
  end
  power = 1
  for i = degree, 0, -1 do
    weight[i + 1] = weight[i + 1] * power
    power = power * (1 - s)
  end
  return weight
end

local function shift_at(x, y, z)
  local a = weigh(axes[1], (x - low[1]) / (high[1] - low[1]))
  local b = weigh(axes[2], (y - low[2]) / (high[2] - low[2]))
  local c = weigh(axes[3], (z - low[3]) / (high[3] - low[3]))
  local dx, dy, dz, at = 0, 0, 0, 1
  for k = 1, axes[3].count do
    for j = 1, axes[2].count do
      local bc = b[j] * c[k]
      for i = 1, axes[1].count do
        local w = a[i] * bc
        dx, dy, dz = dx + w * shifts[at], dy + w * shifts[at + 1], dz + w * shifts[at + 2]
        at = at + 3
      end
    end
  end
  return dx, dy, dz
end

local function by_lattice(b, i)
  local x, y, z = b:position(i)
  if x >= low[1] and y >= low[2] and z >= low[3]
     and x <= high[1] and y <= high[2] and z <= high[3] then
    local dx, dy, dz = shift_at(x, y, z)
    b:set_position(i, x + dx, y + dy, z + dz)
  end
end

rule{
  name = "volume asks its grains", type = "volume-set", on = "free", phase = "down",
  apply = function(b)
    by_lattice(b, 1)
    b:down(1)
  end
}

rule{
  name = "grain by the lattice", type = "grain", on = "free", phase = "down",
  apply = function(b)
    for i = 1, #b do
      by_lattice(b, i)
    end
  end
}
