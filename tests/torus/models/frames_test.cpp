#include "models/torus/frames.h"

#include <gmock/gmock.h>

#include <cmath>

#include "baselines/torus/revolution.h"
#include "core/connectivity.h"
#include "core/error.h"
#include "metrics/volume/closedness.h"
#include "models/torus/sampling.h"
#include "tests/support/recording.h"
#include "tests/torus/torus_inputs.h"

namespace geoprior::torus {
namespace {

TEST(TorusFrames, AFrameIsACorrugationAndHoldsWhatMetricsRead) {
  TorusInput input = published_input({4, 12, 36});
  input.sampling.surface = 20;
  input.sampling.windows = 3;
  test::Recording run;
  RunContext context;
  make_revolution_torus(input, {})->run(run, context, std::nullopt);
  ASSERT_EQ(run.frames.size(), 4u);
  const Frame& last = run.frames[3];
  EXPECT_EQ(last.parameter, 3);
  EXPECT_EQ(last.require_part("surface").triangles.rows(), 2 * 20 * 20);
  EXPECT_EQ(last.require_part("windows").points.rows(), 3 * kWindowSide * kWindowSide);
  EXPECT_NEAR(last.require_table("windows").rows(0, 2), 1 / (40 * 36 * std::sqrt(5.)), 1e-15);
  EXPECT_EQ(last.require_table("corrugations").rows.col(3), Eigen::Vector3d(0, 1, 1)) << "stages";
  EXPECT_EQ(run.frames[0].find_part("windows_before"), nullptr);
}

TEST(TorusFrames, TheWholeTorusIsClosedAndItsVolumeIsThatOfGuldin) {
  TorusInput input;
  input.sampling.surface = 200;
  test::Recording run;
  RunContext context;
  make_revolution_torus(input, {})->run(run, context, std::nullopt);
  const Part& surface = run.frames.at(0).require_part("surface");
  double volume = 0;  // of tetrahedra to the origin: positive where triangles look outwards
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.row(k) = surface.points.row(surface.triangles(t, k));
    volume += corners.determinant() / 6;
  }
  // 2 pi^2 R r^2 with R = r2 / 2 pi, r = r1 / 2 pi.
  EXPECT_NEAR(volume, 0.5 * 0.04 / (4 * std::numbers::pi), 1e-3 * volume);
}

TEST(TorusFrames, ViewsComeNearerByTheirFactor) {
  TorusInput input = published_input({4, 12, 36});
  input.sampling.surface = 11;
  input.sampling.view = SquareWindow{{0.25, 0.5}, 0.2};
  input.sampling.zooms = 3;
  const auto plans = plan_frames(input, std::nullopt);
  ASSERT_EQ(plans.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const Eigen::MatrixX2d& at = plans[k].parts.at(0).samples.at;
    EXPECT_NEAR(at.col(0).maxCoeff() - at.col(0).minCoeff(), 0.2 / std::pow(10, k), 1e-12);
    EXPECT_NEAR(at.col(0).mean(), 0.25, 1e-12);
  }
}

TEST(TorusFrames, PlacesOfAGridAreItsNodes) {
  const TorusInput input = published_input({4, 12, 36});
  for (const FramePlan& plan : plan_frames(input, 500))
    for (const FramePart& part : plan.parts) {
      const Eigen::ArrayXXd nodes = 500 * part.samples.at.array();
      EXPECT_LT((nodes - nodes.round()).abs().maxCoeff(), 1e-9) << part.name;
    }
}

TEST(TorusInput, SaysWhatIsWrong) {
  const auto error = [](auto change) -> std::string {
    TorusInput input = published_input();
    change(input);
    try {
      require_valid(input);
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  };
  using testing::HasSubstr;
  EXPECT_EQ(error([](TorusInput&) {}), "");
  EXPECT_THAT(error([](TorusInput& x) { x.radii = {0.5, 0.6}; }), HasSubstr("r1 + r2 < 1"));
  EXPECT_THAT(error([](TorusInput& x) { x.corrugations[1].number = 0; }),
              HasSubstr("scene.corrugations[1].number"));
  EXPECT_THAT(error([](TorusInput& x) { x.corrugations[2].direction = 3; }),
              HasSubstr("0, 1 or 2"));
  EXPECT_THAT(error([](TorusInput& x) { x.corrugations[0].begins_stage = false; }),
              HasSubstr("no target"));
  EXPECT_THAT(error([](TorusInput& x) {
                x.sampling.view = SquareWindow{{0.9, 0.5}, 0.4};
              }),
              HasSubstr("out of the unit square"));
}

}  // namespace
}  // namespace geoprior::torus
