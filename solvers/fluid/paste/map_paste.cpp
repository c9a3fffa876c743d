#include "solvers/fluid/paste/map_paste.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/parallel.h"
#include "solvers/fluid/lift/exponential_map.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kTexelBlock = 4096;
/// A vertex whose normal leans this far (n.z) against a projected map moves with it fully.
constexpr double kMapFacing = 0.2;
/// `MappingKind::automatic`: geodesics when more than this share is steeper than 45 degrees.
constexpr double kSteepShareOfMaps = 0.05;

enum class Side : char { outside, facing, averted };

struct Projection {
  std::vector<Eigen::Vector3d> local;  ///< target vertices in the feature's frame
  std::vector<Side> side;              ///< of the triangles
};

Projection project(const WorkMesh& mesh, const EditedFrame& frame, double half, double anchor_w,
                   double reach) {
  Projection result;
  const Eigen::Affine3d inverse = frame.placement.inverse();
  result.local.resize(mesh.x.size());
  parallel_blocks(mesh.x.size(), kTexelBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) result.local[v] = inverse * mesh.x[v];
  });
  const double turn = frame.placement.linear().determinant() < 0 ? -1 : 1;
  result.side.resize(mesh.triangles.size());
  parallel_blocks(mesh.triangles.size(), kTexelBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& f = mesh.triangles[t];
      const Eigen::Vector3d& a = result.local[f[0]];
      const Eigen::Vector3d& b = result.local[f[1]];
      const Eigen::Vector3d& c = result.local[f[2]];
      const Eigen::Array3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
      const bool over = low.x() <= half && low.y() <= half && high.x() >= -half &&
                        high.y() >= -half && low.z() <= anchor_w + reach &&
                        high.z() >= anchor_w - reach;
      const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
      result.side[t] = !over ? Side::outside : turn * area > 0 ? Side::facing : Side::averted;
    }
  });
  return result;
}

/// What lies under a projected map, connected with the anchor.
struct Footprint {
  std::vector<char> inside;             ///< of the vertices
  std::vector<Eigen::Vector3d> normal;  ///< area weighted, not unit
  double steep_share = 0;
};

Footprint footprint(const WorkMesh& mesh, const Projection& projection, const PasteAnchor& anchor,
                    const Eigen::Vector3d& z) {
  Footprint result;
  result.normal.assign(mesh.x.size(), Eigen::Vector3d::Zero());
  // Vertices that facing triangles join.
  DisjointSets components(static_cast<int>(mesh.x.size()));
  double area = 0, steep = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (projection.side[t] == Side::outside) continue;
    const auto& f = mesh.triangles[t];
    const Eigen::Vector3d& a = mesh.x[f[0]];
    const Eigen::Vector3d n = (mesh.x[f[1]] - a).cross(mesh.x[f[2]] - a);
    for (const int v : f) result.normal[v] += n;
    if (projection.side[t] == Side::averted) continue;
    components.join(f[0], f[1]);
    components.join(f[1], f[2]);
    const double size = n.norm();
    area += size;
    if (n.dot(z) < std::sqrt(0.5) * size) steep += size;
  }
  result.steep_share = area > 0 ? steep / area : 0;
  const int home = components.find(mesh.triangles[anchor.triangle][0]);
  result.inside.assign(mesh.x.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (projection.side[t] != Side::facing) continue;
    const auto& f = mesh.triangles[t];
    if (components.find(f[0]) != home) continue;
    for (const int v : f) result.inside[v] = 1;
  }
  return result;
}

double facing_weight(const Eigen::Vector3d& normal, const Eigen::Vector3d& z) {
  const double length = normal.norm();
  const double x = length > 0 ? std::clamp(normal.dot(z) / (kMapFacing * length), 0.0, 1.0) : 0;
  return x * x * (3 - 2 * x);
}

MapCoordinates projected(const Projection& projection, const Footprint& under,
                         const Eigen::Vector3d& z) {
  MapCoordinates places;
  for (int v = 0; v < std::ssize(under.inside); ++v) {
    if (under.inside[v] == 0) continue;
    places.vertex.push_back(v);
    places.uv.emplace_back(projection.local[v].head<2>());
    places.weight.push_back(facing_weight(under.normal[v], z));
  }
  return places;
}

MapCoordinates unrolled(const WorkMesh& mesh, const EditedFrame& frame,
                        const DisplacementSampler& map, const PasteAnchor& anchor) {
  // A = R diag(scale): the scale may be negative across the path (mirror).
  const Eigen::Matrix3d& A = frame.placement.linear();
  Eigen::Vector3d scale = A.colwise().norm().transpose();
  if (A.determinant() < 0) scale.y() = -scale.y();
  const Eigen::Matrix3d R = A * scale.cwiseInverse().asDiagonal();
  const double reach = map.extent() * std::sqrt(0.5) * scale.head<2>().cwiseAbs().maxCoeff();
  const ExponentialMap geodesics =
      exponential_map(mesh.x, mesh.triangles, anchor.triangle, anchor.position, R, reach);
  MapCoordinates places;
  places.vertex = geodesics.vertices;
  for (std::size_t i = 0; i < geodesics.vertices.size(); ++i) {
    places.uv.emplace_back(geodesics.uv[i].cwiseQuotient(scale.head<2>()));
    places.weight.push_back(1);
    places.axes.emplace_back(geodesics.axes[i] * scale.asDiagonal());
  }
  return places;
}

/// Places by vertex, and which triangles have a place and something of the map over them.
class Covered {
 public:
  Covered(const MapCoordinates& places, int vertex_count)
      : places_(places), slot_(vertex_count, -1) {
    for (int i = 0; i < std::ssize(places.vertex); ++i) {
      slot_[places.vertex[i]] = i;
    }
  }
  void extend(int vertex_count) {
    const auto first = static_cast<int>(slot_.size());
    slot_.resize(vertex_count, -1);
    for (std::size_t i = places_.vertex.size(); i-- > 0 && places_.vertex[i] >= first;) {
      slot_[places_.vertex[i]] = static_cast<int>(i);
    }
  }
  [[nodiscard]] const Eigen::Vector2d& uv(int v) const { return places_.uv[slot_[v]]; }
  [[nodiscard]] bool holds(const std::array<int, 3>& f, const DisplacementSampler& map) const {
    for (const int v : f) {
      if (slot_[v] < 0) return false;
    }
    const Eigen::Vector2d &a = uv(f[0]), &b = uv(f[1]), &c = uv(f[2]);
    return map.occupied(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c));
  }

 private:
  const MapCoordinates& places_;
  std::vector<int> slot_;
};

std::string metres(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", x);
  return text;
}

[[noreturn]] void refuse_coarse(const std::string& who, double mean, double limit) {
  throw Error(
      "the target is too coarse for the map: its edges measure " + metres(mean), who,
      "edges of about " + metres(limit) + " under the map (its own scale), or refine = true");
}

[[noreturn]] void refuse_large(const std::string& who, std::size_t triangles, int allowed) {
  throw Error("the refined target would have more than " + std::to_string(triangles) + " triangles",
              who, "max_triangles, " + std::to_string(allowed) + ", or more refine_texels");
}

/// Mean length in the map of the edges of triangles under it.
double mean_edge(const WorkMesh& mesh, const Covered& covered, const DisplacementSampler& map) {
  double sum = 0;
  int count = 0;
  for (const auto& f : mesh.triangles) {
    if (!covered.holds(f, map)) continue;
    for (std::size_t k = 0; k < 3; ++k)
      sum += (covered.uv(f[k]) - covered.uv(f[(k + 1) % 3])).norm();
    count += 3;
  }
  return count > 0 ? sum / count : 0;
}

/// Estimate of the triangles needed, for the message: triangles count with all of their area.
std::size_t triangles_needed(const WorkMesh& mesh, const std::vector<int>& candidates,
                             const Covered& covered, double limit) {
  double needed = static_cast<double>(mesh.triangles.size());
  for (const int t : candidates) {
    const auto& f = mesh.triangles[t];
    const Eigen::Vector2d u = covered.uv(f[1]) - covered.uv(f[0]),
                          w = covered.uv(f[2]) - covered.uv(f[0]);
    needed += std::abs(cross(u, w)) / (limit * limit);
  }
  return static_cast<std::size_t>(std::min(needed, 1e15));
}

}  // namespace

MapCoordinates locate(const WorkMesh& mesh, const EditedFrame& frame,
                      const DisplacementSampler& map, const PasteAnchor& anchor,
                      const PasteOptions& options) {
  if (options.mapping == MappingKind::exponential) return unrolled(mesh, frame, map, anchor);
  const Eigen::Vector3d z = frame.placement.linear().col(2).normalized();
  const double anchor_w = (frame.placement.inverse() * anchor.position).z();
  const Projection projection =
      project(mesh, frame, 0.5 * map.extent(), anchor_w, options.projection_reach * map.extent());
  const Footprint under = footprint(mesh, projection, anchor, z);
  if (options.mapping == MappingKind::automatic && under.steep_share > kSteepShareOfMaps) {
    return unrolled(mesh, frame, map, anchor);
  }
  return projected(projection, under, z);
}

void add_middles(const std::vector<std::array<int, 2>>& parents, int first,
                 MapCoordinates& places) {
  const std::ptrdiff_t known = places.vertex.size();
  const auto find = [&](int v) -> std::ptrdiff_t {
    const auto end = places.vertex.begin() + known;
    const auto it = std::lower_bound(places.vertex.begin(), end, v);
    return it != end && *it == v ? it - places.vertex.begin() : -1;
  };
  for (int e = 0; e < std::ssize(parents); ++e) {
    const std::ptrdiff_t a = find(parents[e][0]), b = a < 0 ? -1 : find(parents[e][1]);
    if (b < 0) continue;
    places.vertex.push_back(first + e);
    places.uv.emplace_back(0.5 * (places.uv[a] + places.uv[b]));
    places.weight.push_back(0.5 * (places.weight[a] + places.weight[b]));
    if (!places.axes.empty()) places.axes.emplace_back(0.5 * (places.axes[a] + places.axes[b]));
  }
}

void refine_under_map(WorkMesh& mesh, const DisplacementSampler& map, const PasteOptions& options,
                      const std::string& who, MapCoordinates& places,
                      const std::vector<MapCoordinates*>& others) {
  const double limit = options.refine_texels * map.texel();
  Covered covered(places, mesh.vertex_count());
  if (!options.refine) {
    const double mean = mean_edge(mesh, covered, map);
    if (mean > 2 * limit) refuse_coarse(who, mean, limit);
    return;
  }
  std::vector<int> candidates;
  for (int t = 0; t < std::ssize(mesh.triangles); ++t) {
    if (covered.holds(mesh.triangles[t], map)) candidates.push_back(t);
  }
  const std::size_t needed = triangles_needed(mesh, candidates, covered, limit);
  const std::size_t allowed = options.max_triangles;
  while (!candidates.empty()) {
    EdgeSplitter splitter(mesh.vertex_count());
    for (const int t : candidates) {
      const auto& f = mesh.triangles[t];
      if (!covered.holds(f, map)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = f[k], b = f[(k + 1) % 3];
        if ((covered.uv(a) - covered.uv(b)).squaredNorm() > limit * limit) splitter.mark(a, b);
      }
    }
    if (splitter.empty()) return;
    const int first = mesh.vertex_count();
    candidates = splitter.apply(mesh);
    if (mesh.triangles.size() > allowed)
      refuse_large(who, std::max(needed, allowed), options.max_triangles);
    add_middles(splitter.parents(), first, places);
    for (MapCoordinates* other : others) add_middles(splitter.parents(), first, *other);
    covered.extend(mesh.vertex_count());
  }
}

namespace {

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  int triangle = -1;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

struct Corners {
  Eigen::Vector3d a, b, c;
};

Corners corners(const WorkMesh& mesh, std::size_t t) {
  const auto& f = mesh.triangles[t];
  return {mesh.x[f[0]], mesh.x[f[1]], mesh.x[f[2]]};
}

/// Closest hit over all triangles; of equal ones the first.
template <class Test>
Hit nearest_hit(const WorkMesh& mesh, const Test& test) {
  std::vector<Hit> best((mesh.triangles.size() + kTexelBlock - 1) / kTexelBlock);
  parallel_blocks(mesh.triangles.size(), kTexelBlock, [&](std::size_t begin, std::size_t end) {
    Hit hit;
    for (std::size_t t = begin; t < end; ++t) test(t, hit);
    best[begin / kTexelBlock] = hit;
  });
  Hit result;
  for (const Hit& hit : best) {
    if (hit.distance < result.distance) result = hit;
  }
  return result;
}

/// Point of a triangle nearest to p. Source: Ericson 2005, Real-Time Collision Detection, 5.1.5.
Eigen::Vector3d nearest_point(const Corners& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return t.a;
  const Eigen::Vector3d bp = p - t.b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return t.b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.a + d1 / (d1 - d3) * ab;
  const Eigen::Vector3d cp = p - t.c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return t.c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return t.b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t.c - t.b);
  }
  const double sum = va + vb + vc;
  return sum > 0 ? Eigen::Vector3d(t.a + ab * (vb / sum) + ac * (vc / sum)) : t.a;
}

}  // namespace

std::optional<PasteAnchor> find_anchor(const WorkMesh& mesh, const Eigen::Vector3d& centre,
                                       const Eigen::Vector3d& up, double reach) {
  const Eigen::Vector3d e1 = up.unitOrthogonal(), e2 = up.cross(e1);
  const auto along = [&](std::size_t t, Hit& hit) {
    const Corners f = corners(mesh, t);
    const Eigen::Vector3d a = f.a - centre, b = f.b - centre, c = f.c - centre;
    const double ax = a.dot(e1), ay = a.dot(e2), bx = b.dot(e1), by = b.dot(e2), cx = c.dot(e1),
                 cy = c.dot(e2);
    const double wa = bx * cy - by * cx, wb = cx * ay - cy * ax, wc = ax * by - ay * bx;
    const double sum = wa + wb + wc;  // twice the area as seen from above; < 0 from below
    if (!(sum > 0) || wa < 0 || wb < 0 || wc < 0) return;
    const Eigen::Vector3d p = (wa * a + wb * b + wc * c) / sum;
    const double distance = std::abs(p.dot(up));
    if (distance < hit.distance) hit = {distance, static_cast<int>(t), centre + p};
  };
  const Hit above = nearest_hit(mesh, along);
  if (above.triangle >= 0) return PasteAnchor{above.triangle, above.position};
  const auto anywhere = [&](std::size_t t, Hit& hit) {
    const Corners f = corners(mesh, t);
    if ((f.b - f.a).cross(f.c - f.a).dot(up) <= 0) return;
    const Eigen::Vector3d p = nearest_point(f, centre);
    const double distance = (p - centre).norm();
    if (distance < hit.distance) hit = {distance, static_cast<int>(t), p};
  };
  const Hit beside = nearest_hit(mesh, anywhere);
  if (beside.triangle < 0 || beside.distance > reach) return {};
  return PasteAnchor{beside.triangle, beside.position};
}

}  // namespace geoprior::fluid
