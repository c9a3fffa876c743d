#include <gtest/gtest.h>

#include "experiments/paper/topic.h"
#include "tests/testbed/runner/headline_references.h"

namespace geoprior::paper {
namespace {

TEST(References, EachHeadlineMetricWorsenedAloneIsNamed) {
  test::expect_headline_metrics_are_guarded(make_topic());
}

}  // namespace
}  // namespace geoprior::paper
