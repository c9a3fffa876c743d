#include "metrics/contact/self_contact.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;

class TrianglePairs {
 public:
  TrianglePairs(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) : F_(F) {
    points_.reserve(V.rows());
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
      if (!V.row(v).allFinite()) {
        throw Error("coordinate is not finite", "vertex " + std::to_string(v), "finite numbers");
      }
      points_.emplace_back(V(v, 0), V(v, 1), V(v, 2));
    }
    for (int t = 0; t < F.rows(); ++t) {
      const auto& p = point(t, 0);
      const auto& q = point(t, 1);
      const auto& r = point(t, 2);
      if (!CGAL::collinear(p, q, r)) boxes_.emplace_back(p.bbox() + q.bbox() + r.bbox(), t);
    }
  }

  /// Calls `found(a, b)` for every intersecting pair, in no useful order.
  template <class Found>
  void each(const Found& found) const {
    std::vector<const Box*> pointers;
    pointers.reserve(boxes_.size());
    for (const Box& box : boxes_) pointers.push_back(&box);
    CGAL::box_self_intersection_d(pointers.begin(), pointers.end(),
                                  [&](const Box* a, const Box* b) {
                                    if (meet(a->info(), b->info())) found(a->info(), b->info());
                                  });
  }

 private:
  [[nodiscard]] const Kernel::Point_3& point(int t, int k) const { return points_[F_(t, k % 3)]; }
  [[nodiscard]] Kernel::Triangle_3 triangle(int t) const {
    return {point(t, 0), point(t, 1), point(t, 2)};
  }

  [[nodiscard]] bool meet(int a, int b) const {
    int shared = 0;
    int in_a = 0;  // sums of the corners that are shared: the corner itself when there is one,
    int in_b = 0;  // three minus the free corner when there are two
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (F_(a, i) != F_(b, j)) continue;
        ++shared;
        in_a += i;
        in_b += j;
      }
    }
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    if (shared == 1) {
      const Kernel::Segment_3 opposite_a(point(a, in_a + 1), point(a, in_a + 2));
      const Kernel::Segment_3 opposite_b(point(b, in_b + 1), point(b, in_b + 2));
      return CGAL::do_intersect(triangle(a), opposite_b) ||
             CGAL::do_intersect(triangle(b), opposite_a);
    }
    if (shared == 2) return folded(a, 3 - in_a, 3 - in_b, b);
    return true;  // the same three vertices twice
  }

  /// Two triangles with a common edge, free corners given: in one plane and on the same side.
  [[nodiscard]] bool folded(int a, int free_a, int free_b, int b) const {
    const auto& p = point(a, free_a + 1);
    const auto& q = point(a, free_a + 2);
    const auto& apex_a = point(a, free_a);
    const auto& apex_b = point(b, free_b);
    return CGAL::coplanar(p, q, apex_a, apex_b) &&
           CGAL::coplanar_orientation(p, q, apex_a, apex_b) == CGAL::POSITIVE;
  }

  const Eigen::MatrixX3i& F_;
  std::vector<Kernel::Point_3> points_;
  std::vector<Box> boxes_;
};

}  // namespace

std::vector<std::array<int, 2>> intersecting_triangles(const Eigen::MatrixX3d& V,
                                                       const Eigen::MatrixX3i& F) {
  std::vector<std::array<int, 2>> pairs;
  TrianglePairs(V, F).each([&](int a, int b) {
    pairs.push_back({std::min(a, b), std::max(a, b)});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

int intersecting_pairs(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  return static_cast<int>(intersecting_triangles(V, F).size());
}

std::vector<std::array<int, 2>> pairs_between_layers(std::span<const std::array<int, 2>> pairs,
                                                     std::span<const int> layer) {
  std::vector<std::array<int, 2>> between;
  for (const std::array<int, 2>& pair : pairs) {
    if (layer[pair[0]] != layer[pair[1]]) between.push_back(pair);
  }
  return between;
}

int pairs_in_region(std::span<const std::array<int, 2>> pairs, const JointRegion& region) {
  const auto inside = [&](int t) {
    return std::binary_search(region.triangles.begin(), region.triangles.end(), t);
  };
  return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return inside(pair[0]) || inside(pair[1]);
  }));
}

}  // namespace geoprior
