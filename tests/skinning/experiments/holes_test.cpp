// Characters with holes: capped for what is computed, open in what is written back.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/topology.h"
#include "experiments/skinning/topic.h"
#include "tests/skinning/experiments/made_character.h"
#include "tests/testbed/runner/metric_table.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class OpenCharacter : public MadeCharacterTest {
 protected:
  void write_tube(const RiggedMesh& rig) const {
    write_character(made_character(rig.skeleton, {part_of(rig, "body")}));
  }
};

TEST_F(OpenCharacter, IsCappedForEveryMethodWithAWarningThatSaysWhere) {
  write_tube(open_tube());
  const CaseRecord record = run_all("");
  EXPECT_THAT(
      record.warnings,
      ElementsAre(AllOf(HasSubstr("my.glb: 1 hole of the skin with 4 boundary edges is "
                                  "closed by caps"),
                        HasSubstr("holes = \"keep\""), HasSubstr("4 edges at joint 'lower', 0."))));
  for (const VariantRecord& variant : record.variants) {
    EXPECT_EQ(variant.status, "done") << variant.error;
    EXPECT_EQ(variant.frames.size(), 2U);
    for (const char* name : {"overlap_excess", "overlap_excess_body", "volume_change_global"})
      EXPECT_FALSE(std::isnan(variant.metrics.at(name).values.at(1))) << variant.name << name;
  }
}

TEST_F(OpenCharacter, WhoseHolesAreKeptIsNoneForFieldsAndVolumesAndTheOthersRun) {
  write_tube(open_tube());
  const CaseRecord record = run_all("holes = \"keep\"\n");
  EXPECT_THAT(record.warnings, IsEmpty());
  for (const VariantRecord& variant : record.variants) {
    if (variant.method == "implicit") {
      EXPECT_THAT(variant.error, AllOf(HasSubstr("closed mesh; 4 boundary edges")));
      continue;
    }
    EXPECT_EQ(variant.frames.size(), 2U) << variant.error;
    EXPECT_FALSE(variant.metrics.contains("overlap_excess_body"));
  }
}

// What goes back to the program that the character came from has its triangles and no others, also
// where no seam splits a vertex.
TEST_F(OpenCharacter, StaysOpenInWhatIsWrittenBack) {
  const RiggedMesh rig = open_tube();
  write_tube(rig);
  const auto scene = load("");
  EXPECT_EQ(scene->cap_triangles, 2);
  EXPECT_TRUE(boundary_edges(scene->rig.mesh.F).empty());
  EXPECT_TRUE(same_triangles(scene->input_mesh.F, rig.mesh.F));
  const Frame frame = posed(*scene, "linear-blend");
  EXPECT_TRUE(same_triangles(frame.require_part("input").triangles, rig.mesh.F));
  EXPECT_EQ(frame.require_part("surface").triangles.rows(), rig.mesh.F.rows() + 2);
}

TEST_F(OpenCharacter, IsCappedAfterRefinementAndSimplification) {
  write_tube(open_tube());
  const auto refined = load("refine = [{ levels = 1 }]\n");
  EXPECT_TRUE(boundary_edges(refined->rig.mesh.F).empty());
  EXPECT_EQ(refined->cap_triangles, 6) << "eight edges around the hole";
  EXPECT_EQ(refined->input_mesh.F.rows(), refined->skin_triangles());
  EXPECT_EQ(boundary_edges(refined->input_mesh.F).size(), 8U);
  const auto simplified = load("simplify_to = 150\nweights = \"heat\"\n");
  EXPECT_TRUE(boundary_edges(simplified->rig.mesh.F).empty());
  EXPECT_GT(simplified->cap_triangles, 0);
}

// Folds and stretch are of the skin that is seen: a cap meets it at a sharp edge and is stretched
// as its border is.
TEST_F(OpenCharacter, HasTheRoughnessAndStretchOfItsOwnSkin) {
  RiggedMesh tube = made_tube();  // without its ends
  tube.mesh.F = Eigen::MatrixX3i(tube.mesh.F.middleRows(16, tube.mesh.F.rows() - 32));
  write_tube(tube);
  const auto capped = load(""), open = load("holes = \"keep\"\n");
  EXPECT_EQ(capped->cap_triangles, 28);
  const Frame with = posed(*capped, "linear-blend"), without = posed(*open, "linear-blend");
  const test::MetricTable table(metrics());
  for (const char* name : {"roughness_p50", "roughness_max", "lumps_max", "lumps_rms",
                           "area_ratio_p05", "singular_value_max", "symmetric_dirichlet"}) {
    EXPECT_EQ(table.of_frame(name, *capped, with), table.of_frame(name, *open, without)) << name;
  }
  EXPECT_TRUE(table.of_frame("overlap_excess_body", *capped, with).has_value());
  EXPECT_FALSE(table.of_frame("overlap_excess_body", *open, without).has_value());
}

TEST_F(OpenCharacter, KeepsSheetsOpenAndNamesThem) {
  const RiggedMesh rig = open_tube();
  MadePart card = part_of(rig, "card");
  card.mesh.V.resize(4, 3);
  card.mesh.V << 0.1, 0.3, 0, 0.2, 0.3, 0, 0.2, 0.4, 0, 0.1, 0.4, 0;
  card.mesh.F.resize(2, 3);
  card.mesh.F << 0, 1, 2, 0, 2, 3;
  card.weights = SkinWeights(4, 2);
  for (int v = 0; v < 4; ++v) card.weights.insert(v, 1) = 1;
  write_character(made_character(rig.skeleton, {part_of(rig, "body"), card}));
  EXPECT_THAT(load("")->load_warnings,
              ElementsAre(HasSubstr("1 hole of the skin"),
                          AllOf(HasSubstr("4 boundary edges of the skin in 1 loop stay open"),
                                HasSubstr("at joint 'upper'"), HasSubstr("outline of a sheet"),
                                HasSubstr("mesh = \"…\""))));
  EXPECT_THAT(load("mesh = \"body\"\n")->load_warnings,
              testing::Not(Contains(HasSubstr("stay open"))));
}

TEST_F(OpenCharacter, IsCappedBeforeItIsAskedWhichWayItFaces) {
  RiggedMesh rig = open_tube();
  rig.mesh.F.col(1).swap(rig.mesh.F.col(2));
  write_tube(rig);
  const auto scene = load("");
  EXPECT_GT(signed_volume(scene->rig.mesh.V, scene->rig.mesh.F), 0);
  EXPECT_THAT(scene->load_warnings, Contains(HasSubstr("faced inwards")));
}

}  // namespace
}  // namespace geoprior::skinning
