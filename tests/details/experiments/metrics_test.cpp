// Rows of the table of metrics on frames whose answers are known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "experiments/details/scene/pattern.h"
#include "experiments/details/scene/scene.h"
#include "experiments/details/scene/surfaces.h"
#include "experiments/details/topic.h"
#include "models/details/process.h"
#include "tests/testbed/runner/metric_table.h"

namespace geoprior::details {
namespace {

/// Details on a plane of 1 m that grows to `kGrowth` times its size in two seconds.
constexpr double kGrowth = 1.5;

class DetailsMetrics : public ::testing::Test {
 protected:
  DetailsMetrics() {
    const TriMesh plane = plane_surface(1, 1, 0.05);
    DetailPatternOptions pattern;
    pattern.count = 120;
    const Eigen::VectorXd density = gradient_density(plane, {});
    scene.input.surface = plane;
    scene.input.details = scatter(plane, pattern, density);
    for (pattern.seed = 2; pattern.seed < 4; ++pattern.seed)
      scene.resamples.push_back(scatter(plane, pattern, density));
    scene.region.assign(plane.F.rows(), 1);
    scene.pair_frames = 1;
    scene.input.motion = std::make_shared<StoredMotion>(
        std::vector<Eigen::MatrixX3d>{plane.V, 1.25 * plane.V, kGrowth * plane.V},
        std::vector<double>{0, 1, 2});
  }

  /// The details as they are, on the plane scaled by `factor`.
  [[nodiscard]] DetailMesh details_at(double factor) const {
    DetailMesh details = build_detail_mesh(scene.input.surface, scene.input.details);
    move_surface(details, factor * scene.input.surface.V, LengthRule::chord);
    return details;
  }
  [[nodiscard]] std::optional<double> value(const std::string& name, const Frame& frame) const {
    return table.of_frame(name, scene, frame);
  }
  [[nodiscard]] std::optional<double> over(const std::string& name,
                                           const std::vector<Frame>& frames) const {
    return table.of_sequence(name, scene, frames);
  }

  DetailsScene scene;
  test::MetricTable table{details::metrics()};
};

/// A triangle of M_d with details at all corners.
int triangle_of_details(const DetailMesh& d) {
  for (int t = 0; t < d.mesh.triangle_slots(); ++t) {
    if (!d.mesh.triangle_alive(t)) continue;
    if (details_of(d, t) > 0.49) return t;
  }
  return -1;
}

/// Inserts a detail of that weight into the middle of a triangle.
void insert(DetailMesh& d, double weight, int type = 0) {
  Detail like;
  like.weight = weight;
  like.type = type;
  insert_detail(d, triangle_of_details(d), Eigen::Vector3d::Constant(1.0 / 3), like);
}

TEST_F(DetailsMetrics, ScaledDetailsAreFartherApartByTheFactor) {
  const Frame frame = detail_frame(details_at(kGrowth), 2);
  for (const char* name : {"mean_edge_change", "visible_edge_change", "edge_change_p10",
                           "edge_change_p50", "edge_change_p90"}) {
    EXPECT_NEAR(value(name, frame).value(), kGrowth - 1, 1e-12) << name;
  }
  const Frame rest = detail_frame(details_at(1), 0);
  EXPECT_NEAR(value("mean_edge_change", rest).value(), 0, 1e-12);
  EXPECT_NEAR(value("edge_variation", frame).value(), value("edge_variation", rest).value(), 1e-12);
  EXPECT_NEAR(value("smallest_edge", frame).value(), kGrowth * value("smallest_edge", rest).value(),
              1e-12);
  EXPECT_GT(value("outside_share", frame).value(), value("outside_share", rest).value());
}

TEST_F(DetailsMetrics, DensityIsAgainstTheArea) {
  DetailMesh details = details_at(kGrowth);
  insert(details, 0.4);
  const Frame frame = detail_frame(details, 2);
  EXPECT_NEAR(value("count_ratio", frame).value(), 121.0 / 120, 1e-12);
  EXPECT_NEAR(value("density_ratio", frame).value(), 121.0 / 120 / (kGrowth * kGrowth), 1e-12);
  EXPECT_NEAR(value("visible_density_ratio", frame).value(), 1 / (kGrowth * kGrowth), 1e-12);
}

// Who does nothing is as far from the original as doing nothing.
TEST_F(DetailsMetrics, PairCorrelationOfDoingNothingHasRatioOne) {
  const Frame last = detail_frame(details_at(kGrowth), 2);
  EXPECT_EQ(value("pair_distance_ratio", last), 1);
  EXPECT_EQ(value("pair_distance", last), value("pair_distance_naive", last));
  EXPECT_GT(value("pair_noise", last).value(), 0);
  EXPECT_GT(value("pair_distance", last).value(), 2 * value("pair_noise", last).value());
  // Frames that the scene does not choose have none.
  EXPECT_FALSE(value("pair_distance", detail_frame(details_at(1.25), 1)));
}

// A scaled rectangle has the spectrum of the original at other frequencies, and no axis more than
// it had; stretched to twice its length, the power goes to the other axis.
TEST_F(DetailsMetrics, SpectrumShowsSpacingAndDirection) {
  const Frame scaled = detail_frame(details_at(kGrowth), 2);
  EXPECT_GT(value("spectrum_distance", scaled).value(),
            1.5 * value("spectrum_noise", scaled).value());
  DetailMesh details = details_at(1);
  Eigen::MatrixX3d V = scene.input.surface.V;
  V.col(0) *= 2;
  move_surface(details, V, LengthRule::chord);
  const Frame stretched = detail_frame(details, 2);
  EXPECT_GT(value("spectrum_elongation", stretched).value(),
            1.5 * value("spectrum_elongation", scaled).value());
  V.col(2) = V.col(0).cwiseProduct(V.col(0));
  move_surface(details, V, LengthRule::chord);
  EXPECT_FALSE(value("spectrum_distance", detail_frame(details, 2))) << "no plane";
}

// Invisible details are not there for who looks.
TEST_F(DetailsMetrics, PairCorrelationIsOfVisibleDetails) {
  DetailMesh details = details_at(kGrowth);
  insert(details, 0.4);
  EXPECT_EQ(value("pair_distance_ratio", detail_frame(details, 2)), 1);
  insert(details, 0.6);
  EXPECT_NE(value("pair_distance_ratio", detail_frame(details, 2)), 1);
}

TEST_F(DetailsMetrics, AMotionIsJudgedByItsWorstFrame) {
  const std::vector<Frame> frames{detail_frame(details_at(1), 0), detail_frame(details_at(1.25), 1),
                                  detail_frame(details_at(1.1), 2)};
  EXPECT_NEAR(over("worst_edge_change", frames).value(), 0.25, 1e-12);
  EXPECT_NEAR(over("worst_visible_change", frames).value(), 0.25, 1e-12);
  for (const char* name : {"weight_step", "inserted_total", "removed_total", "churn", "turns"})
    EXPECT_EQ(over(name, frames), 0) << name;
  EXPECT_NEAR(over("popping", frames).value(), 0, 1e-12);
  EXPECT_FALSE(over("events_at_rest", frames));
}

// Half as high at once: its tip moves by half its height.
TEST_F(DetailsMetrics, ADetailThatComesAtOncePops) {
  DetailMesh details = details_at(1);
  const Frame first = detail_frame(details, 0);
  insert(details, 0.5);
  const Frame second = detail_frame(details, 1);
  move_surface(details, 1.25 * scene.input.surface.V, LengthRule::chord);
  const std::vector<Frame> frames{first, second, detail_frame(details, 2)};
  EXPECT_NEAR(over("weight_step", frames).value(), 0.5, 1e-12);
  EXPECT_NEAR(over("popping", frames).value(), 0.5, 1e-12);
  EXPECT_EQ(over("inserted_total", frames), 1);
  EXPECT_EQ(over("removed_total", frames), 0);
  EXPECT_EQ(over("churn", frames), 0);
}

// A spike of half its height stands there a second later; it is far from the others, so that the
// surface is what is nearest to its tip.
TEST_F(DetailsMetrics, ASpikeThatComesAtOncePopsByItsHeight) {
  DetailMesh details = details_at(1);
  std::vector<Frame> frames{detail_frame(details, 0)};
  insert(details, 0.5);
  for (const double time : {1, 2}) frames.push_back(detail_frame(details, time));
  EXPECT_FALSE(over("drawn_popping", frames)) << "nothing is drawn";
  scene.drawing.emplace();
  scene.drawing->look.unit = DrawnUnit::metre;
  scene.drawing->look.radius = 0.002;
  scene.drawing->look.spike.height = 0.01;
  scene.drawing->pop_frames = 2;
  EXPECT_NEAR(over("drawn_popping", frames).value(), 0.5, 1e-9);
  scene.drawing->pop_frames = 1;  // the last: nothing happens any more
  EXPECT_NEAR(over("drawn_popping", frames).value(), 0, 1e-9);
}

// A hole of radius r is cut at once: its centre was surface, and is r from the rim.
TEST_F(DetailsMetrics, AHoleThatIsCutAtOncePopsByItsRadius) {
  DetailMesh details = details_at(1);
  std::vector<Frame> frames{detail_frame(details, 0)};
  insert(details, 1, 1);
  for (const double time : {1, 2}) frames.push_back(detail_frame(details, time));
  scene.drawing.emplace();
  scene.drawing->look.kind = DrawnKind::hole;
  scene.drawing->look.type = 1;  // no others, which would take some of its radius
  scene.drawing->look.unit = DrawnUnit::metre;
  scene.drawing->look.radius = 0.03;
  scene.drawing->pop_frames = 2;
  const double popping = over("drawn_popping", frames).value();
  EXPECT_LT(popping, 1 + 1e-9);
  // Samples are up to a sixth of the radius beside the centre; 40 chords are 0.3 % within the rim.
  EXPECT_GT(popping, 1 - 1.0 / 6 - 0.004);
}

// Ten frames of rest are allowed for weights to end; what comes after is an oscillation.
TEST_F(DetailsMetrics, EventsAtRestCountAfterTenFrames) {
  const auto events = [&](int frame_of_event) {
    DetailMesh details = details_at(1);
    std::vector<Frame> frames;
    for (int i = 0; i < 20; ++i) {
      if (i == frame_of_event) insert(details, 0);
      frames.push_back(detail_frame(details, i));
    }
    return over("events_at_rest", frames);
  };
  EXPECT_EQ(events(10), 0);
  EXPECT_EQ(events(11), 1);
  EXPECT_EQ(events(19), 1);
}

}  // namespace
}  // namespace geoprior::details
