#include <gtest/gtest.h>

#include "experiments/fluid/topic.h"
#include "tests/testbed/runner/headline_references.h"

namespace geoprior::fluid {
namespace {

TEST(References, EachHeadlineMetricWorsenedAloneIsNamed) {
  test::expect_headline_metrics_are_guarded(make_topic());
}

}  // namespace
}  // namespace geoprior::fluid
