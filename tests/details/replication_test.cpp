#include "solvers/details/replication.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tests/details/detail_scenes.h"

namespace geoprior {
namespace {

using namespace detail_scenes;

/// What a motion showed at its worst.
struct Course {
  double worst_edge = 0;     ///< |mean edge / mean edge at rest - 1|
  double worst_visible = 0;  ///< the same of details of weight above 1/2
  double last_edge = 0;      ///< signed
  int inserted = 0, fading = 0, revived = 0;
  double weight_change = 0;
};

/// Mean edge of the visible triangulation among details, by the rule that metrics use: edges whose
/// two triangles have no ghost.
double visible_edge(const DetailMesh& d) {
  std::map<std::pair<int, int>, int> clean;  // triangles without ghosts at an edge
  for (const auto& t : visible_triangles(d, 0.5)) {
    if (!d.is_detail(t[0]) || !d.is_detail(t[1]) || !d.is_detail(t[2])) continue;
    for (std::size_t k = 0; k < 3; ++k) ++clean[std::minmax(t[k], t[(k + 1) % 3])];
  }
  double sum = 0;
  int count = 0;
  for (const auto& [edge, triangles] : clean) {
    if (triangles < 2) continue;
    sum += (d.position[static_cast<std::size_t>(edge.first)] -
            d.position[static_cast<std::size_t>(edge.second)])
               .norm();
    ++count;
  }
  return sum / count;
}

Course follow(DetailMethod& method, const SurfaceMotion& motion) {
  Course course;
  RunContext context;
  const double rest = mean_edge(method.details()), visible_rest = visible_edge(method.details());
  for (int frame = 1; frame < motion.frame_count(); ++frame) {
    method.step(motion.positions(frame), context);
    course.last_edge = mean_edge(method.details()) / rest - 1;
    course.worst_edge = std::max(course.worst_edge, std::abs(course.last_edge));
    course.worst_visible =
        std::max(course.worst_visible, std::abs(visible_edge(method.details()) / visible_rest - 1));
    std::map<std::string, double> d;
    method.diagnose(d);
    course.inserted += static_cast<int>(d["inserted"]);
    course.revived += static_cast<int>(d["revived"]);
    course.fading += static_cast<int>(d["fading"]);
    course.weight_change = std::max(course.weight_change, d["max_weight_change"]);
  }
  return course;
}

TEST(Replication, SpacingHoldsUnderStretch) {
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 400, 1), stretch(mesh, 240, 2));
  const auto method = make_replication(s, {}, 1);
  const Course c = follow(*method, *s.motion);
  EXPECT_LE(c.worst_edge, 0.03);
  EXPECT_LE(c.worst_visible, 0.03);
  EXPECT_LE(c.weight_change, 0.1 + 1e-12);
  printf("stretch: worst %.4f visible %.4f last %.4f inserted %d fading %d revived %d n %d\n",
         c.worst_edge, c.worst_visible, c.last_edge, c.inserted, c.fading, c.revived,
         method->details().detail_count());
}

TEST(Replication, SpacingHoldsUnderInflation) {
  const TriMesh mesh = shapes::sphere(5);
  const auto s = scene(mesh, even_details(mesh, 600, 1), inflate(mesh, 240, 2));
  const auto method = make_replication(s, {}, 1);
  const Course c = follow(*method, *s.motion);
  EXPECT_LE(c.worst_edge, 0.03);
  EXPECT_LE(c.worst_visible, 0.03);
  printf("inflate: worst %.4f visible %.4f last %.4f inserted %d fading %d revived %d n %d\n",
         c.worst_edge, c.worst_visible, c.last_edge, c.inserted, c.fading, c.revived,
         method->details().detail_count());
}

TEST(Replication, SpacingHoldsUnderCompression) {
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 800, 1), stretch(mesh, 240, 0.5));
  const auto method = make_replication(s, {}, 1);
  const Course c = follow(*method, *s.motion);
  EXPECT_LE(c.worst_edge, 0.03);
  EXPECT_LE(c.worst_visible, 0.03);
  printf("compress: worst %.4f visible %.4f last %.4f inserted %d fading %d revived %d n %d\n",
         c.worst_edge, c.worst_visible, c.last_edge, c.inserted, c.fading, c.revived,
         method->details().detail_count());
}

}  // namespace
}  // namespace geoprior
