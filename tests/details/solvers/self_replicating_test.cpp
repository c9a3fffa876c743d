#include "solvers/details/self_replicating.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "tests/details/detail_scenes.h"

namespace geoprior::details {
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
    sum += (d.position[edge.first] - d.position[edge.second]).norm();
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

TEST(SelfReplicating, SpacingHoldsUnderStretch) {
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 400, 1), stretch(mesh, 240, 2));
  const auto method = make_self_replicating(s, {}, 1);
  const Course c = follow(*method, *s.motion);
  EXPECT_LE(c.worst_edge, 0.03);
  EXPECT_LE(c.worst_visible, 0.03);
  EXPECT_LE(c.weight_change, 0.1 + 1e-12);
}

TEST(SelfReplicating, SpacingHoldsUnderInflation) {
  const TriMesh mesh = shapes::sphere(5);
  const auto s = scene(mesh, even_details(mesh, 600, 1), inflate(mesh, 240, 2));
  const auto method = make_self_replicating(s, {}, 1);
  const Course c = follow(*method, *s.motion);
  EXPECT_LE(c.worst_edge, 0.03);
  EXPECT_LE(c.worst_visible, 0.03);
}

TEST(SelfReplicating, SpacingHoldsUnderCompression) {
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 800, 1), stretch(mesh, 240, 0.5));
  const auto method = make_self_replicating(s, {}, 1);
  const Course c = follow(*method, *s.motion);
  EXPECT_LE(c.worst_edge, 0.03);
  EXPECT_LE(c.worst_visible, 0.03);
}

/// Clusters of six details within a disk of radius 0.02.
std::vector<Detail> clusters(const TriMesh& mesh, int count, std::uint64_t seed) {
  RandomStream random(seed, "clusters");
  std::vector<Eigen::Vector3d> x;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) x.emplace_back(mesh.V.row(v).transpose());
  const SurfaceTopology surface(mesh);
  std::vector<Detail> details;
  for (const Detail& centre : even_details(mesh, count, seed)) {
    for (int i = 0; i < 6; ++i) {
      const auto direction =
          tangent_direction(centre.at.face, 6.283 * random.uniform(), surface, x);
      Detail d;
      d.at = trace_straight(centre.at, direction, 0.02 * std::sqrt(random.uniform()), surface, x);
      details.push_back(d);
    }
  }
  return details;
}

/// L1 distance of the pair correlation after the motion to that at rest.
double correlation_change(const DetailScene& s, const SelfReplicatingOptions& options) {
  const auto method = make_self_replicating(s, options, 1);
  PairCorrelation correlation(mean_edge(method->details()), {});
  const Eigen::VectorXd rest = correlation.of(method->details());
  follow(*method, *s.motion);
  return (correlation.of(method->details()) - rest).lpNorm<1>();
}

/// No insertion, no merging: what naive stretch leaves.
SelfReplicatingOptions nothing() {
  SelfReplicatingOptions options;
  options.area_rule = AreaRule::own;
  options.stretch_threshold = options.shrink_threshold = 1e9;
  return options;
}

TEST(SelfReplicating, UniformPatternsKeepTheirPairCorrelation) {
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 500, 1), stretch(mesh, 240, 2));
  // Half of naive stretch: the target of the method. Measured: 0.3.
  EXPECT_LE(correlation_change(s, {}), 0.5 * correlation_change(s, nothing()));
}

TEST(SelfReplicating, TheHistogramKeepsClusters) {
  const TriMesh mesh = shapes::square(60);
  const auto s = scene(mesh, clusters(mesh, 80, 1), stretch(mesh, 120, 2));
  const double naive = correlation_change(s, nothing());
  SelfReplicatingOptions thesis, extension;
  thesis.area_rule = AreaRule::own;
  extension.copies.histogram = true;
  EXPECT_GT(correlation_change(s, thesis), naive);  // the limit that the thesis states
  const double kept = correlation_change(s, extension);
  EXPECT_LT(kept, naive);
  extension.copies.histogram = false;
  EXPECT_LT(kept, 0.9 * correlation_change(s, extension));  // 0.7 of it
}

TEST(SelfReplicating, AThresholdLetsTheEdgesGrow) {
  // Filled above tau times their area, triangles have between 1 and tau times it on the whole: the
  // mean edge grows with tau (the thesis reports about 10 %).
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 400, 1), stretch(mesh, 120, 2));
  std::vector<double> edge;
  for (const double tau : {1.5, 2.0, 3.0}) {
    SelfReplicatingOptions options;
    options.area_rule = AreaRule::mean;
    options.stretch_threshold = tau;
    options.shrink_threshold = 1e9;
    const auto method = make_self_replicating(s, options, 1);
    edge.push_back(follow(*method, *s.motion).last_edge);
  }
  EXPECT_LT(edge[0], edge[1]);
  EXPECT_LT(edge[1], edge[2]);
  EXPECT_GT(edge[2], 0.15);
}

TEST(SelfReplicating, WeightsFollowTheMotionByThatLaw) {
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 400, 1), stretch(mesh, 100, 2));
  SelfReplicatingOptions options;
  options.weight_law = WeightLaw::motion;
  options.motion_rate = 0.1;
  const auto method = make_self_replicating(s, options, 1);
  RunContext context;
  std::map<std::string, double> d;
  for (int frame = 1; frame <= 50; ++frame) method->step(s.motion->positions(frame), context);
  method->diagnose(d);
  // The right border moves by 1/100 a frame.
  EXPECT_NEAR(d["max_weight_change"], 0.1 * 0.01 / mean_edge(build_detail_mesh(mesh, s.details)),
              1e-3);
  method->step(s.motion->positions(50), context);
  method->diagnose(d);
  EXPECT_EQ(d["max_weight_change"], 0);
}

TEST(SelfReplicating, NewbornsCarryTypeAndLineage) {
  const TriMesh mesh = shapes::square(20);
  auto details = even_details(mesh, 200, 1);
  for (std::size_t i = 0; i < details.size(); ++i) details[i].type = 7;
  const auto s = scene(mesh, details, stretch(mesh, 30, 2));
  const auto method = make_self_replicating(s, {}, 1);
  follow(*method, *s.motion);
  const DetailMesh& d = method->details();
  std::set<std::int64_t> births;
  int born = 0;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i)) continue;
    const Detail& site = d.site[i];
    EXPECT_TRUE(births.insert(site.birth).second);
    EXPECT_EQ(site.type, 7);
    EXPECT_EQ(site.generation == 0, site.birth < 200);
    EXPECT_EQ(site.generation == 0, site.birth_frame == 0);
    born += site.generation > 0 ? 1 : 0;
  }
  EXPECT_GT(born, 150);
}

TEST(SelfReplicating, AlignedTangentsStayAligned) {
  // All tangents along -y on a sheet that is stretched along x: so are those of the newborns, as
  // far as those of the first details are (they keep an angle in triangles that are sheared).
  const TriMesh mesh = shapes::square(20);
  std::vector<Eigen::Vector3d> x;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) x.emplace_back(mesh.V.row(v).transpose());
  const SurfaceTopology surface(mesh);
  const Eigen::Vector3d down(0, -1, 0);
  auto details = even_details(mesh, 300, 1);
  for (Detail& d : details) d.tangent_angle = tangent_angle(d.at.face, down, surface, x);
  const auto s = scene(mesh, details, stretch(mesh, 60, 2));
  const auto method = make_self_replicating(s, {}, 1);
  follow(*method, *s.motion);
  const DetailMesh& d = method->details();
  double worst_first = 1, worst_born = 1;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i)) continue;
    const Detail& site = d.site[i];
    const double along =
        tangent_direction(site.at.face, site.tangent_angle, *d.surface, d.x).dot(down);
    double& worst = site.generation > 0 ? worst_born : worst_first;
    worst = std::min(worst, along);
  }
  EXPECT_GT(worst_first, 0.8);
  EXPECT_GT(worst_born, worst_first - 0.15);
}

TEST(SelfReplicating, TheRimOfAPatternStaysAndNothingStacks) {
  // Details on the upper cap of a sphere that grows to twice the area. Triangles of M_d span the
  // bare rest: copies in them stay within one and a half spacings (and a face) of the rim, and
  // apart.
  const TriMesh mesh = shapes::sphere(5);
  std::vector<Detail> details = even_details(mesh, 1200, 1);
  std::erase_if(details,
                [&](const Detail& d) { return position_of(d.at, mesh.V, mesh.F).z() < 0.4; });
  const auto s = scene(mesh, details, inflate(mesh, 120, 2));
  const auto method = make_self_replicating(s, {}, 1);
  const auto nearest_two = [](const DetailMesh& d) {
    double nearest = 1;
    for (int i = 0; i < d.site_slots(); ++i)
      for (int j = 0; j < i; ++j)
        if (d.is_detail(i) && d.is_detail(j))
          nearest = std::min(nearest, (d.position[i] - d.position[j]).norm());
    return nearest;
  };
  const double at_rest = nearest_two(method->details());
  const double edge = mean_edge(method->details());
  follow(*method, *s.motion);
  const DetailMesh& d = method->details();
  const double lowest = std::sin(std::asin(0.4) - 2.2 * edge) * std::sqrt(2.0);
  for (int i = 0; i < d.site_slots(); ++i)
    if (d.is_detail(i)) {
      EXPECT_GT(d.position[i].z(), lowest);
    }
  EXPECT_GE(nearest_two(d), 0.5 * at_rest);
  EXPECT_GT(d.detail_count(), 1.9 * static_cast<double>(details.size()));
}

}  // namespace
}  // namespace geoprior::details
