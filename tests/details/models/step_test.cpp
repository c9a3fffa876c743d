#include "models/details/step.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

constexpr int kDetails = 60;

/// Details on a unit square, all in one patch.
struct Square {
  TriMesh mesh = shapes::square(4);
  DetailMesh details = build_detail_mesh(mesh, detail_scenes::even_details(mesh, kDetails, 1));
  AreaBudget budget{details, 100 * kDetails};
};

TEST(DetailStep, FadingDetailsReturnLargestWeightFirst) {
  Square s;
  ASSERT_EQ(s.budget.patch_count(), 1);
  const std::vector<std::pair<int, double>> fading{{3, 0.2}, {17, 0.8}, {40, 0.5}};
  for (const auto& [site, weight] : fading) {
    s.details.site[site].weight = weight;
    fade_detail(s.details, site, s.budget);
  }
  EXPECT_DOUBLE_EQ(s.budget.deficit(0), 3);
  // A patch that lacks 3 acts until it lacks less than 1.5.
  EXPECT_EQ(revive_details(s.details, s.budget, 1.5), 2);
  EXPECT_EQ(s.details.site[17].target_weight, 1);
  EXPECT_EQ(s.details.site[40].target_weight, 1);
  EXPECT_EQ(s.details.site[3].target_weight, 0);
  EXPECT_DOUBLE_EQ(s.budget.deficit(0), 1);
}

TEST(DetailStep, BudgetsAskAheadByWhatADetailTakesToAppearAndToFade) {
  const AreaBudget::Lead lead = lead_of(true, 0.1);
  EXPECT_DOUBLE_EQ(lead.growing, 2.5);
  EXPECT_DOUBLE_EQ(lead.shrinking, 7.5);
  EXPECT_EQ(lead_of(false, 0.1).growing, 0);
  EXPECT_EQ(lead_of(false, 0.1).shrinking, 0);
}

TEST(DetailStep, MovesChangesAndThenWeighs) {
  struct Log final : RunContext {
    std::vector<std::string> phases;
    void begin_phase(std::string_view name) override { phases.emplace_back(name); }
  };
  Square s;
  Log context;
  s.details.site[5].weight = 0;
  const Eigen::MatrixX3d V = 2 * s.mesh.V;
  const Eigen::Vector3d before = s.details.position[7];
  const StepReport report = step_details(s.details, V, LengthRule::chord, 0.1, context, [&] {
    context.phases.emplace_back("change");
    EXPECT_LT((s.details.position[7] - 2 * before).norm(), 1e-12);
    EXPECT_EQ(s.details.site[5].weight, 0);
  });
  EXPECT_EQ(context.phases, (std::vector<std::string>{"move", "change", "weights"}));
  EXPECT_EQ(s.details.site[5].weight, 0.1);
  EXPECT_EQ(report.max_weight_change, 0.1);
}

}  // namespace
}  // namespace geoprior::details
