#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "solvers/details/self_replicating.h"
#include "tests/details/detail_scenes.h"
#include "tests/details/random_motion.h"
#include "tests/support/long_tests.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

/// 1 x 300 steps; with GEOPRIOR_LONG, 10 x 2,000.
void wander(const TriMesh& mesh, int details, const SelfReplicatingOptions& options) {
  const bool is_long = test::at_length();
  for (std::uint64_t seed = 1; seed <= (is_long ? 10 : 1); ++seed) {
    const auto s = scene(mesh, even_details(mesh, details, seed), stretch(mesh, 1, 1.01));
    const auto method = make_self_replicating(s, options, seed);
    RandomMotion motion(mesh, seed);
    RunContext context;
    int changes = 0;
    for (int frame = 1; frame <= (is_long ? 2000 : 300); ++frame) {
      method->step(motion.next(), context);
      ASSERT_NO_FATAL_FAILURE(expect_invariants(method->details(), frame));
      std::map<std::string, double> d;
      method->diagnose(d);
      changes += static_cast<int>(d["inserted"] + d["fading"] + d["flips"]);
    }
    EXPECT_GT(changes, 1000);
  }
}

TEST(SelfReplicatingMotion, LongMotionKeepsTheMeshDelaunayAndManifoldOnASphere) {
  wander(shapes::sphere(4), 300, {});
}

TEST(SelfReplicatingMotion, LongMotionKeepsTheMeshDelaunayAndManifoldOnAnOpenSurface) {
  wander(shapes::square(20), 200, {});
}

TEST(SelfReplicatingMotion, LongMotionKeepsTheMeshDelaunayAndManifoldByThresholds) {
  SelfReplicatingOptions options;
  options.area_rule = AreaRule::own;
  options.stretch_threshold = options.shrink_threshold = 1.4;
  wander(shapes::sphere(4), 300, options);
}

TEST(SelfReplicatingMotion, LongMotionKeepsTheMeshDelaunayAndManifoldInLengthsAlongTheSurface) {
  SelfReplicatingOptions options;
  options.lengths = LengthRule::geodesic;
  wander(shapes::sphere(4), 300, options);
}

TEST(SelfReplicatingMotion, DetailsReturnWithTheSurface) {
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 2), stretch(mesh, 60, 2));
  const auto method = make_self_replicating(s, {}, 1);
  RunContext context;
  for (int round = 0; round < 5; ++round) {
    for (int frame = 1; frame <= 60; ++frame) method->step(s.motion->positions(frame), context);
    for (int frame = 59; frame >= 0; --frame) method->step(s.motion->positions(frame), context);
    // What fades at the turn needs ten frames of rest to be gone.
    for (int frame = 0; frame < 12; ++frame) method->step(mesh.V, context);
    EXPECT_NEAR(method->details().detail_count(), 600, 18) << round;
  }
  // At rest nothing happens any more.
  const auto before = method->details().mesh.triangles();
  for (int frame = 0; frame < 20; ++frame) {
    method->step(mesh.V, context);
    std::map<std::string, double> d;
    method->diagnose(d);
    for (const char* event : {"inserted", "revived", "fading", "flips", "max_weight_change"})
      EXPECT_EQ(d[event], 0) << event;
  }
  EXPECT_EQ(method->details().mesh.triangles(), before);
}

State state_after(const DetailScene& s, const SelfReplicatingOptions& options, int threads) {
  StateWriter out;
  with_threads(threads, [&] {
    const auto method = make_self_replicating(s, options, 1);
    RunContext context;
    for (int frame = 1; frame < s.motion->frame_count(); ++frame)
      method->step(s.motion->positions(frame), context);
    method->save(out);
  });
  return out.take();
}

TEST(SelfReplicatingMotion, OneThreadAndTwoMakeTheSameBytes) {
  const TriMesh mesh = shapes::sphere(5);
  const auto s = scene(mesh, even_details(mesh, 6000, 1), inflate(mesh, 5, 1.12));
  for (const bool histogram : {false, true}) {
    SelfReplicatingOptions options;
    options.copies.histogram = histogram;
    EXPECT_TRUE(state_after(s, options, 1) == state_after(s, options, 2)) << histogram;
  }
}

}  // namespace
}  // namespace geoprior::details
