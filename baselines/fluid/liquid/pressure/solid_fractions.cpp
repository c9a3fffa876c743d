#include "baselines/fluid/liquid/pressure/solid_fractions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr float kTouching = 1e-4F;  ///< cells: nearer than this counts as inside
constexpr float kSmallestOpening = 0.01F;
constexpr double kSampledBand = 4;  ///< cells around a body in which it is sampled
constexpr float kFar = 1e30F;       ///< distance where no body was sampled

/// Share of an edge that lies outside, from the distances at its ends (one of them positive).
float open_length(float inside, float outside) { return outside / (outside - inside); }

/// Area fraction of a unit square that lies outside (distance > 0), corners in cyclic order.
float open_area(std::array<float, 4> d) {
  int count = 0;
  for (const float v : d) count += v > 0;
  if (count == 0) return 0;
  if (count == 4) return 1;
  if (count == 2 && (d[0] > 0) == (d[2] > 0)) {
    // Two opposite corners: the centre says whether they are joined.
    const bool joined = d[0] + d[1] + d[2] + d[3] > 0;
    const std::size_t first = (d[0] > 0) == joined ? 1 : 0;  // corner that is cut off
    float cut = 0;
    for (std::size_t c = first; c < 4; c += 2) {
      const float a = d[c], b = d[(c + 1) % 4], e = d[(c + 3) % 4];
      cut += 0.5F * (a / (a - b)) * (a / (a - e));
    }
    return joined ? 1 - cut : cut;
  }
  if (count == 2) {
    // Turn so that corners 0 and 1 are open: a trapezoid.
    while (!(d[0] > 0 && d[1] > 0)) std::rotate(d.begin(), d.begin() + 1, d.end());
    return 0.5F * (open_length(d[3], d[0]) + open_length(d[2], d[1]));
  }
  const bool one_open = count == 1;
  while ((d[0] > 0) != one_open || (d[1] > 0) == one_open || (d[3] > 0) == one_open)
    std::rotate(d.begin(), d.begin() + 1, d.end());
  const float triangle = 0.5F * (d[0] / (d[0] - d[1])) * (d[0] / (d[0] - d[3]));
  return one_open ? triangle : 1 - triangle;
}

Eigen::Vector3i unit(int axis) {
  Eigen::Vector3i e = Eigen::Vector3i::Zero();
  e[axis] = 1;
  return e;
}

/// Distance of a node to the walls of the domain (m).
float wall_distance(const GridShape& shape, bool open_top, const DomainSide& top,
                    const Eigen::Vector3i& node) {
  int nearest = std::numeric_limits<int>::max();
  for (int a = 0; a < 3; ++a) {
    const bool opens = open_top && top.axis == a;
    if (!(opens && !top.upper)) nearest = std::min(nearest, node[a]);
    if (!(opens && top.upper)) nearest = std::min(nearest, shape.cells[a] - node[a]);
  }
  return static_cast<float>(nearest * shape.cell);
}

/// Calls `body(node)` for every node of a box, layers in parallel.
template <class Body>
void for_nodes(const Eigen::AlignedBox3i& box, const Body& body) {
  if (box.isEmpty()) return;
  const std::size_t layers = box.max().z() - box.min().z() + 1;
  parallel_blocks(layers, 2, [&](std::size_t begin, std::size_t end) {
    for (int k = box.min().z() + static_cast<int>(begin); k < box.min().z() + static_cast<int>(end);
         ++k)
      for (int j = box.min().y(); j <= box.max().y(); ++j)
        for (int i = box.min().x(); i <= box.max().x(); ++i) body(Eigen::Vector3i(i, j, k));
  });
}

}  // namespace

DomainSide top_side(const Eigen::Vector3d& gravity) {
  if (gravity.isZero()) return {};
  int axis = 0;
  gravity.cwiseAbs().maxCoeff(&axis);
  return {axis, gravity[axis] < 0};
}

SolidSampler::SolidSampler(const Tank& tank, const GridShape& shape)
    : shape_(shape), open_top_(tank.open_top), top_(top_side(tank.gravity)) {
  for (const TankSolid& solid : tank.solids) moves_.push_back(solid.motion.has_value());
}

SolidSampler::NodeBox SolidSampler::box_of(const PlacedSolid& solid) const {
  const NodeBox all(Eigen::Vector3i::Zero(), shape_.cells);
  const Eigen::AlignedBox3d bounds = solid.distance->bounds();
  if (!bounds.sizes().allFinite()) return all;
  Eigen::AlignedBox3d moved;
  for (int c = 0; c < 8; ++c)
    moved.extend(solid.placement * bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));
  // Bodies far outside must not overflow whole numbers.
  const Eigen::Array3d limit = shape_.cells.cast<double>().array() + 2 * kSampledBand;
  const auto to_node = [&](const Eigen::Vector3d& x, double band) {
    const Eigen::Array3d node = (x - shape_.origin).array() / shape_.cell + band;
    return Eigen::Vector3i(node.max(-2 * kSampledBand).min(limit).floor().cast<int>());
  };
  const NodeBox box(to_node(moved.min(), -kSampledBand), to_node(moved.max(), kSampledBand + 1));
  return box.intersection(all);
}

void SolidSampler::sample_solid(const PlacedSolid& solid, int index, const NodeBox& box,
                                SolidFractions& out) {
  for_nodes(box, [&](const Eigen::Vector3i& n) {
    const std::size_t at = out.distance.index(n.x(), n.y(), n.z());
    const auto d = static_cast<float>(solid.distance_at(shape_.node(n.x(), n.y(), n.z())));
    if (d >= distance_.values[at]) return;
    distance_.values[at] = d;
    owner_[at] = static_cast<std::int16_t>(index);
    out.distance.values[at] = std::min(out.distance.values[at], d);
  });
}

void SolidSampler::restore(const NodeBox& box, SolidFractions& out) {
  for_nodes(box, [&](const Eigen::Vector3i& n) {
    const std::size_t at = out.distance.index(n.x(), n.y(), n.z());
    distance_.values[at] = still_distance_.values[at];
    owner_[at] = still_owner_[at];
    out.distance.values[at] =
        std::min(wall_distance(shape_, open_top_, top_, n), still_distance_.values[at]);
  });
}

void SolidSampler::update_faces(std::span<const PlacedSolid> solids, const NodeBox& box,
                                SolidFractions& out) {
  const float touching = kTouching * static_cast<float>(shape_.cell);
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i u = unit((a + 1) % 3), v = unit((a + 2) % 3);
    const Eigen::Array3d half = 0.5 * (u + v).cast<double>().array();
    for_nodes(box, [&](const Eigen::Vector3i& n) {
      if (((n + u + v).array() > shape_.cells.array()).any()) return;
      const std::size_t face = out.open[a].index(n.x(), n.y(), n.z());
      std::array<float, 4> d{};
      const std::array<Eigen::Vector3i, 4> corners{n, n + u, n + u + v, n + v};
      float nearest = kFar;
      int owner = -1;
      for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t at = distance_.index(corners[c].x(), corners[c].y(), corners[c].z());
        d[c] = distance_.values[at] <= touching ? std::min(distance_.values[at], 0.0F)
                                                : distance_.values[at];
        if (distance_.values[at] < nearest) {
          nearest = distance_.values[at];
          owner = owner_[at];
        }
      }
      float open = open_area(d);
      const bool lower = n[a] == 0, upper = n[a] == shape_.cells[a];
      const bool leads_out = open_top_ && top_.axis == a && (top_.upper ? upper : lower);
      if ((lower || upper) && !leads_out) open = 0;
      if (open < kSmallestOpening) open = 0;
      out.open[a].values[face] = open;
      float speed = 0;
      if (open < 1 && owner >= 0 && moves_[owner] && !lower && !upper) {
        const Eigen::Vector3d x =
            shape_.origin + shape_.cell * (n.cast<double>().array() + half).matrix();
        speed = static_cast<float>(solids[owner].velocity_at(x)[a]);
      }
      out.velocity[a].values[face] = speed;
    });
  }
}

void SolidSampler::sample(std::span<const PlacedSolid> solids, SolidFractions& out) {
  const Eigen::Vector3i nodes = shape_.cells + Eigen::Vector3i::Ones();
  const NodeBox all(Eigen::Vector3i::Zero(), shape_.cells);
  const auto moves = [&](std::size_t s) { return s < moves_.size() && moves_[s]; };
  std::vector<NodeBox> changed = moved_boxes_;
  if (!started_) {
    for (int a = 0; a < 3; ++a) {
      out.open[a] = ScalarGrid(shape_.face_cells(a), 1);
      out.velocity[a] = ScalarGrid(shape_.face_cells(a), 0);
    }
    still_distance_ = distance_ = out.distance = ScalarGrid(nodes, kFar);
    still_owner_.assign(distance_.values.size(), -1);
    owner_ = still_owner_;
    restore(all, out);
    for (std::size_t s = 0; s < solids.size(); ++s)
      if (!moves(s)) sample_solid(solids[s], static_cast<int>(s), box_of(solids[s]), out);
    still_distance_ = distance_;
    still_owner_ = owner_;
    changed = {all};
    started_ = true;
  } else {
    for (const NodeBox& box : changed) restore(box, out);
  }
  moved_boxes_.clear();
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (!moves(s)) continue;
    moved_boxes_.push_back(box_of(solids[s]));
    sample_solid(solids[s], static_cast<int>(s), moved_boxes_.back(), out);
    changed.push_back(moved_boxes_.back());
  }
  for (const NodeBox& box : changed) {
    // A face whose first node lies one below the box still has nodes in it.
    NodeBox wider(box.min() - Eigen::Vector3i::Ones(), box.max());
    update_faces(solids, wider.intersection(all), out);
  }
}

void solid_fractions(const Tank& tank, std::span<const PlacedSolid> solids, const GridShape& shape,
                     SolidFractions& out) {
  SolidSampler(tank, shape).sample(solids, out);
}

void extend_into_solids(const SolidFractions& solids, const GridShape& shape,
                        ScalarGrid& liquid_distance) {
  const auto half = static_cast<float>(0.5 * shape.cell);
  const ScalarGrid& d = solids.distance;
  const Eigen::Vector3i last = shape.cells - Eigen::Vector3i::Ones();
  for_nodes({Eigen::Vector3i::Zero(), last}, [&](const Eigen::Vector3i& c) {
    float& phi = liquid_distance(c.x(), c.y(), c.z());
    if (!(phi < half)) return;
    const int i = c.x(), j = c.y(), k = c.z();
    const float centre = d(i, j, k) + d(i + 1, j, k) + d(i, j + 1, k) + d(i + 1, j + 1, k) +
                         d(i, j, k + 1) + d(i + 1, j, k + 1) + d(i, j + 1, k + 1) +
                         d(i + 1, j + 1, k + 1);
    if (centre < 0) phi = std::min(phi, -half);
  });
}

}  // namespace geoprior::fluid
