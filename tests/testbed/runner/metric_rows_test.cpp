// A group measures once for all of its rows; what goes wrong names the row where one is to blame.

#include "testbed/metric_rows.h"

#include <gmock/gmock.h>

#include <memory>

#include "testbed/runner/judgement/measure.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

struct SquareScene final : ProcessScene {
  double edge = 2;
};

struct SquareMeasures {
  double area = 0;
  std::optional<double> diagonal;
};

constexpr Direction kNoDirection = Direction::none;

/// Area and diagonal of the scene's square, the latter not in the first second.
SquareMeasures measure_square(const SquareScene& scene, const Frame& frame) {
  SquareMeasures m{scene.edge * scene.edge, std::nullopt};
  if (frame.parameter >= 1) m.diagonal = scene.edge * std::sqrt(2.0);
  return m;
}

Frame frame_at(double time) {
  Frame frame;
  frame.parameter = time;
  return frame;
}

TEST(MetricGroups, MeasureOnceForAllRows) {
  const auto calls = std::make_shared<int>(0);
  Topic topic;
  topic.metrics = {
      frame_metrics<SquareScene>([calls](const SquareScene& scene, const Frame& f) {
        ++*calls;
        return measure_square(scene, f);
      })
          .row("area", "m^2", "area", kNoDirection, {}, &SquareMeasures::area)
          .row("diagonal", "m", "diagonal", kNoDirection, {}, &SquareMeasures::diagonal)
          .row("half", "m^2", "half of it", kNoDirection, {},
               [](const SquareMeasures& m) { return m.area / 2; })};
  const SquareScene scene;
  EXPECT_THAT(measure_frame(topic, scene, frame_at(0), nullptr),
              ElementsAre(Pair("area", 4), Pair("half", 2)));
  EXPECT_EQ(*calls, 1);
  EXPECT_EQ(measure_frame(topic, scene, frame_at(1), nullptr).size(), 3U);
  EXPECT_EQ(*calls, 2);
}

TEST(MetricGroups, AttributesBelongToTheRowBeforeThem) {
  const MetricGroup group = frame_metrics<SquareScene>(measure_square)
                                .row("area", "m^2", "area", kNoDirection, {}, &SquareMeasures::area)
                                .oracle()
                                .ungated("what it is")
                                .row("diagonal", "m", "diagonal", Direction::closer_to_target, {},
                                     &SquareMeasures::diagonal)
                                .target(3);
  ASSERT_EQ(group.rows.size(), 2U);
  EXPECT_TRUE(group.rows[0].oracle);
  EXPECT_FALSE(group.rows[0].gated());
  EXPECT_FALSE(group.rows[1].oracle);
  EXPECT_TRUE(group.rows[1].gated());
  EXPECT_EQ(group.rows[1].target, 3);
}

TEST(MetricGroups, WithoutMeasuresOrReferenceThereAreNoValues) {
  int calls = 0;
  Topic topic;
  topic.metrics = {
      frame_metrics<SquareScene>([](const SquareScene&, const Frame&) {
        return std::optional<SquareMeasures>();
      }).row("area", "m^2", "area", kNoDirection, {}, &SquareMeasures::area),
      reference_metrics<SquareScene>({}, [&](const SquareScene&, const Frame&, const Frame& r) {
        ++calls;
        return r.parameter;
      }).row("then", "s", "time of the reference", kNoDirection, {})};
  const SquareScene scene;
  EXPECT_TRUE(measure_frame(topic, scene, frame_at(0), nullptr).empty());
  EXPECT_EQ(calls, 0);
  const Frame reference = frame_at(7);
  EXPECT_THAT(measure_frame(topic, scene, frame_at(0), &reference), ElementsAre(Pair("then", 7)));
}

TEST(MetricGroups, ErrorsNameTheRowOrAllOfThem) {
  Topic topic;
  topic.metrics = {frame_metrics<SquareScene>(measure_square)
                       .row("area", "m^2", "area", kNoDirection, {}, &SquareMeasures::area)
                       .row("crooked", "m", "diagonal", kNoDirection, {},
                            [](const SquareMeasures&) -> double { throw Error("no diagonal"); })};
  const SquareScene scene;
  const auto message = [&] {
    return error_of([&] { measure_frame(topic, scene, frame_at(2), nullptr); });
  };
  EXPECT_EQ(message(), "metric 'crooked' at parameter 2: no diagonal");
  topic.metrics = {
      frame_metrics<SquareScene>([](const SquareScene&, const Frame&) {
        throw Error("no square");
        return SquareMeasures();
      })
          .row("area", "m^2", "area", kNoDirection, {}, &SquareMeasures::area)
          .row("diagonal", "m", "diagonal", kNoDirection, {}, &SquareMeasures::diagonal)};
  EXPECT_EQ(message(), "metrics 'area', 'diagonal' at parameter 2: no square");
}

}  // namespace
}  // namespace geoprior::test
