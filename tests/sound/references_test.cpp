#include <gtest/gtest.h>

#include "experiments/sound/topic.h"
#include "tests/testbed/runner/headline_references.h"

namespace geoprior::sound {
namespace {

TEST(References, EachHeadlineMetricWorsenedAloneIsNamed) {
  test::expect_headline_metrics_are_guarded(make_topic());
}

}  // namespace
}  // namespace geoprior::sound
