#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "solvers/fluid/map_paste.h"

namespace geoprior {
namespace {

constexpr std::size_t kBlock = 4096;

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
  return {mesh.x[static_cast<std::size_t>(f[0])], mesh.x[static_cast<std::size_t>(f[1])],
          mesh.x[static_cast<std::size_t>(f[2])]};
}

/// Closest hit over all triangles; of equal ones the first.
template <class Test>
Hit nearest_hit(const WorkMesh& mesh, const Test& test) {
  std::vector<Hit> best((mesh.triangles.size() + kBlock - 1) / kBlock);
  parallel_blocks(mesh.triangles.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    Hit hit;
    for (std::size_t t = begin; t < end; ++t) test(t, hit);
    best[begin / kBlock] = hit;
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

}  // namespace geoprior
