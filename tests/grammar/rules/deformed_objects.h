#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/maps/spatial_map.h"
#include "solvers/grammar/engine/derivation.h"

/// What rules make of a whole object under a map, and how it compares with the object at rest, for
/// the tests of rules.
namespace geoprior::grammar::samples {

/// Of all key points of what is present.
inline Eigen::AlignedBox3d key_box(const Hierarchy& h) {
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3d> keys;
  for (int e = 0; e < h.size(); ++e)
    if (h.present(e)) h.keys(e, keys);
  for (const Eigen::Vector3d& x : keys) box.extend(x);
  return box;
}

inline Hierarchy deformed(const Hierarchy& rest, const RuleSet& rules,
                          const std::shared_ptr<const SpatialMap>& map) {
  Hierarchy h = rest;
  Transaction undo(h);
  derive(h, undo, rules, {0, Delta::free(map)});
  return h;
}

/// Whether an element is the same in both, bit for bit.
inline bool is_same(const Hierarchy& a, const Hierarchy& b, int e) {
  const auto p = a.parameters(e), q = b.parameters(e);
  const auto x = a.points(e), y = b.points(e);
  return a.present(e) == b.present(e) && a.position(e) == b.position(e) &&
         a.turn(e).coeffs() == b.turn(e).coeffs() && std::equal(p.begin(), p.end(), q.begin()) &&
         std::equal(x.begin(), x.end(), y.begin());
}

/// Root mean square over the elements that are still there of that over their key points.
inline double deviation(const Hierarchy& rest, const Hierarchy& h, const SpatialMap& map) {
  double sum = 0;
  int count = 0;
  for (int e = 0; e < rest.size(); ++e) {
    std::vector<Eigen::Vector3d> before, after;
    if (!rest.present(e) || !h.present(e)) continue;
    rest.keys(e, before);
    h.keys(e, after);
    if (before.empty()) continue;
    double squares = 0;
    for (std::size_t k = 0; k < before.size(); ++k)
      squares += (after[k] - map.at(before[k])).squaredNorm();
    sum += squares / static_cast<double>(before.size());
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace geoprior::grammar::samples
