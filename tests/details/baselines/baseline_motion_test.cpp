#include <algorithm>
#include <cmath>

#include "baselines/details/dart_throwing.h"
#include "baselines/details/delaunay_refinement.h"
#include "baselines/details/lloyd.h"
#include "baselines/details/naive_stretch.h"
#include "tests/details/baselines/baseline_runs.h"
#include "tests/details/random_motion.h"
#include "tests/support/long_tests.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

using Make = std::unique_ptr<DetailMethod> (*)(const DetailScene&);

struct Baseline {
  const char* name;
  Make make;
};

class BaselineMotion : public testing::TestWithParam<Baseline> {};

/// 150 steps; with GEOPRIOR_LONG, 5 x 1,000.
void wander(const TriMesh& mesh, Make make) {
  const bool is_long = test::at_length();
  for (std::uint64_t seed = 1; seed <= (is_long ? 5 : 1); ++seed) {
    const auto s = scene(mesh, even_details(mesh, 300, seed), stretch(mesh, 1, 1.01));
    const auto method = make(s);
    RandomMotion motion(mesh, seed);
    RunContext context;
    double flips = 0;
    for (int frame = 1; frame <= (is_long ? 1000 : 150); ++frame) {
      method->step(motion.next(), context);
      ASSERT_NO_FATAL_FAILURE(expect_invariants(method->details(), frame));
      flips += diagnostic(*method, "flips");
    }
    EXPECT_GT(flips, 100);
  }
}

TEST_P(BaselineMotion, LongMotionKeepsTheMeshDelaunayAndManifoldOnASphere) {
  wander(shapes::sphere(4), GetParam().make);
}

TEST_P(BaselineMotion, LongMotionKeepsTheMeshDelaunayAndManifoldOnASheet) {
  wander(shapes::square(20), GetParam().make);
}

TEST_P(BaselineMotion, BareSurfaceStaysBare) {
  // Details on the upper cap of a sphere that grows to twice the area: none comes more than four
  // edges below the lowest (three are no bare surface yet, and a face more).
  const TriMesh mesh = shapes::sphere(5);
  std::vector<Detail> details = even_details(mesh, 1200, 1);
  std::erase_if(details,
                [&](const Detail& d) { return position_of(d.at, mesh.V, mesh.F).z() < 0.4; });
  const auto s = scene(mesh, details, inflate(mesh, 60, 2));
  const auto method = GetParam().make(s);
  const double edge = std::sqrt(4 * std::acos(-1.0) / 1200) * 1.1;
  run_through(*method, s);
  const DetailMesh& d = method->details();
  const double lowest = std::sin(std::asin(0.4) - 4 * edge) * std::sqrt(2.0);
  for (int i = 0; i < d.site_slots(); ++i)
    if (d.is_detail(i)) {
      EXPECT_GT(d.position[i].z(), lowest);
    }
  EXPECT_LT(d.detail_count(), 2.4 * static_cast<double>(details.size()));
}

INSTANTIATE_TEST_SUITE_P(
    All, BaselineMotion,
    testing::Values(
        Baseline{"naive", [](const DetailScene& s) { return make_naive_stretch(s, {}); }},
        Baseline{"darts", [](const DetailScene& s) { return make_dart_throwing(s, {}, 1); }},
        Baseline{"refinement",
                 [](const DetailScene& s) { return make_delaunay_refinement(s, {}); }},
        Baseline{"lloyd", [](const DetailScene& s) { return make_lloyd(s, {}); }}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace geoprior::details
