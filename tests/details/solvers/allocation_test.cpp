// What a frame of the method costs in allocations when nothing moves.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "solvers/details/self_replicating.h"
#include "tests/core/allocations.h"
#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

/// Allocations of the third of three steps of a surface at rest, on one thread.
std::optional<std::size_t> of_a_step_at_rest(int details, const SelfReplicatingOptions& options) {
  DetailScene scene;
  scene.surface = shapes::square(8);
  scene.details = detail_scenes::even_details(scene.surface, details, 1);
  scene.motion = std::make_shared<StoredMotion>(std::vector{scene.surface.V, scene.surface.V},
                                                std::vector{0.0, 1.0});
  std::unique_ptr<DetailMethod> method;
  std::optional<std::size_t> count =
      test::allocations_of([&] { method = make_self_replicating(scene, options, 1); });
  if (count) {
    EXPECT_GT(*count, 100U) << "what is kept of the surface";
  }
  with_threads(1, [&] {
    RunContext context;
    for (int frame = 0; frame < 2; ++frame) method->step(scene.surface.V, context);
    count = test::allocations_of([&] { method->step(scene.surface.V, context); });
  });
  return count;
}

TEST(AllocationsOfAStep, AtRestAreFewWhateverTheNumberOfDetails) {
  const auto few = of_a_step_at_rest(100, {}), many = of_a_step_at_rest(400, {});
  if (!few) GTEST_SKIP() << "a sanitizer build";
  EXPECT_EQ(*few, 0U);
  EXPECT_EQ(*many, *few);
}

}  // namespace
}  // namespace geoprior::details
