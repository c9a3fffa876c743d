#include "models/sketch/positive_winding.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_with_history_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "core/planar.h"

namespace geoprior::sketch {
namespace {

using WindingKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using WindingPoint = WindingKernel::Point_2;
using WindingTraits = CGAL::Arr_segment_traits_2<WindingKernel>;
using WindingArrangement = CGAL::Arrangement_with_history_2<WindingTraits>;
using WindingHalfedge = WindingArrangement::Halfedge_const_handle;
using WindingFace = WindingArrangement::Face_const_handle;

/// Of every face by its address: only looked up, never walked through.
using WindingNumbers = std::map<const void*, int>;

WindingArrangement winding_arrangement(const std::vector<PlaneLoop>& curves) {
  std::vector<WindingTraits::Curve_2> segments;
  for (const PlaneLoop& curve : curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Eigen::Vector2d& a = curve[i];
      const Eigen::Vector2d& b = curve[(i + 1) % curve.size()];
      if (a != b) segments.emplace_back(WindingPoint(a.x(), a.y()), WindingPoint(b.x(), b.y()));
    }
  }
  WindingArrangement arrangement;
  CGAL::insert(arrangement, segments.begin(), segments.end());
  return arrangement;
}

/// How often curves run along the half-edge in its direction, less how often against it.
int winding_step(const WindingArrangement& arrangement, WindingHalfedge edge) {
  const bool rightwards = edge->direction() == CGAL::ARR_LEFT_TO_RIGHT;
  int step = 0;
  for (auto curve = arrangement.originating_curves_begin(edge);
       curve != arrangement.originating_curves_end(edge); ++curve) {
    const bool same =
        (CGAL::compare_xy(curve->source(), curve->target()) == CGAL::SMALLER) == rightwards;
    step += same ? 1 : -1;
  }
  return step;
}

/// Spreads from the unbounded face, around which nothing winds.
WindingNumbers winding_numbers(const WindingArrangement& arrangement) {
  WindingNumbers winding;
  std::vector<WindingFace> open{arrangement.unbounded_face()};
  winding[&*open.front()] = 0;
  const auto visit = [&](WindingArrangement::Ccb_halfedge_const_circulator begin, int here) {
    auto edge = begin;
    do {
      const WindingFace beyond = edge->twin()->face();
      const auto [place, fresh] = winding.try_emplace(&*beyond, 0);
      if (fresh) {
        place->second = here - winding_step(arrangement, edge);
        open.push_back(beyond);
      }
    } while (++edge != begin);
  };
  while (!open.empty()) {
    const WindingFace face = open.back();
    open.pop_back();
    const int here = winding.at(&*face);
    for (auto ccb = face->outer_ccbs_begin(); ccb != face->outer_ccbs_end(); ++ccb) {
      visit(*ccb, here);
    }
    for (auto ccb = face->inner_ccbs_begin(); ccb != face->inner_ccbs_end(); ++ccb) {
      visit(*ccb, here);
    }
  }
  return winding;
}

PlaneLoop loop_from_leftmost(PlaneLoop loop) {
  const auto left = std::min_element(loop.begin(), loop.end(),
                                     [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                                       return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
                                     });
  std::rotate(loop.begin(), left, loop.end());
  return loop;
}

/// The loop of border half-edges that `start` begins; points in the middle of a straight stretch
/// are left out, exactly.
PlaneLoop walk_winding_border(WindingHalfedge start, const auto& is_border,
                              std::set<const void*>& done) {
  std::vector<WindingPoint> corners;
  WindingHalfedge edge = start;
  do {
    done.insert(&*edge);
    WindingHalfedge next = edge->next();
    while (!is_border(next)) next = next->twin()->next();
    if (!CGAL::collinear(edge->source()->point(), edge->target()->point(),
                         next->target()->point())) {
      corners.push_back(edge->target()->point());
    }
    edge = next;
  } while (edge != start);
  PlaneLoop loop;
  for (const WindingPoint& corner : corners) {
    const Eigen::Vector2d p(CGAL::to_double(corner.x()), CGAL::to_double(corner.y()));
    if (loop.empty() || loop.back() != p) loop.push_back(p);
  }
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  return loop;
}

double loop_extent(const PlaneLoop& loop) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : loop) box.extend(p);
  return box.diagonal().norm();
}

}  // namespace

double loop_area(const PlaneLoop& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    twice += cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
  }
  return twice / 2;
}

std::vector<PlaneLoop> positive_winding_border(const std::vector<PlaneLoop>& curves) {
  const WindingArrangement arrangement = winding_arrangement(curves);
  const WindingNumbers winding = winding_numbers(arrangement);
  const auto is_border = [&](WindingHalfedge edge) {
    return winding.at(&*edge->face()) > 0 && winding.at(&*edge->twin()->face()) <= 0;
  };
  std::vector<PlaneLoop> loops;
  std::set<const void*> done;
  for (auto edge = arrangement.halfedges_begin(); edge != arrangement.halfedges_end(); ++edge) {
    if (!is_border(edge) || done.contains(&*edge)) continue;
    PlaneLoop loop = walk_winding_border(edge, is_border, done);
    // Rounding may flatten a sliver that exact coordinates still enclose.
    if (loop.size() >= 3) loops.push_back(loop_from_leftmost(std::move(loop)));
  }
  std::sort(loops.begin(), loops.end(), [](const PlaneLoop& a, const PlaneLoop& b) {
    return std::tuple(-loop_extent(a), a[0].x(), a[0].y()) <
           std::tuple(-loop_extent(b), b[0].x(), b[0].y());
  });
  return loops;
}

}  // namespace geoprior::sketch
