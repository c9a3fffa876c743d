// Characters of several parts, of several skins and of several skeletons; parts that lie in one
// another or touch.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/topology.h"
#include "experiments/skinning/topic.h"
#include "tests/skinning/experiments/made_character.h"
#include "tests/testbed/runner/metric_table.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class PartsOfACharacter : public MadeCharacterTest {
 protected:
  const RiggedMesh tube = made_tube();
};

TEST_F(PartsOfACharacter, OfTwoSkinsOnTheSameJointsRunThroughEveryMethod) {
  // A smaller tube beside the body, of a skin that lists the joints the other way round.
  write_character(made_character(
      tube.skeleton, {part_of(tube, "body"), part_of(tube, "coat", 0.5, {0, 0, 0.4}, 1)}, 2));
  const auto scene = load("");
  EXPECT_EQ(scene->rig.skeleton.size(), 2);
  EXPECT_EQ(scene->rig.mesh.vertex_count(), 2 * tube.mesh.vertex_count());
  const CaseRecord record = run_all("");
  EXPECT_THAT(record.warnings, IsEmpty());
  for (const VariantRecord& variant : record.variants) {
    EXPECT_EQ(variant.status, "done") << variant.error;
    EXPECT_EQ(variant.frames.size(), 2U);
  }
  // Both follow the joints by one set of weights: the coat's vertices are the body's, halved.
  const Eigen::VectorXd upper = scene->rig.weights.col(1);
  const int n = tube.mesh.vertex_count();
  EXPECT_TRUE(upper.head(n).isApprox(upper.tail(n), 1e-6));
}

TEST_F(PartsOfACharacter, OfTwoSkeletonsBelowOneNodeAreOneCharacter) {
  test::GltfSample s = made_character(
      tube.skeleton, {part_of(tube, "body"), part_of(tube, "dog", 0.5, {0, 0, 0.6}, 1)}, 2);
  const auto nodes = s.json["nodes"].size();
  s.json["nodes"].push_back({{"name", "dog-lower"}, {"children", {nodes + 1}}});
  s.json["nodes"].push_back({{"name", "dog-upper"}});
  s.json["skins"][1]["joints"] = {nodes + 1, nodes};
  s.json["scenes"][0]["nodes"].push_back(nodes);
  write_character(s);
  const std::string error = refusal("");
  EXPECT_THAT(error, AllOf(HasSubstr("my.glb: skin 0 'skin-0' of mesh 'body' and skin 1 'skin-1' "
                                     "of mesh 'dog' share no joint"),
                           HasSubstr("mesh = \"…\"")));
  EXPECT_EQ(load("mesh = \"body\"\n")->rig.skeleton.size(), 2);

  s.json["nodes"].push_back({{"name", "armature"}, {"children", s.json["scenes"][0]["nodes"]}});
  s.json["scenes"][0]["nodes"] = {nodes + 2};
  write_character(s);
  const auto both = load("");
  EXPECT_EQ(both->rig.skeleton.size(), 4);
  EXPECT_THAT(both->load_warnings,
              ElementsAre(HasSubstr("skins 0 and 1 share no joint: they are read as one character, "
                                    "as their joints hang on node 'armature'")));
  EXPECT_EQ(both->rig.mesh.vertex_count(), 2 * tube.mesh.vertex_count());
}

// A difference alone would say that a pose which takes parts apart overlaps by less than nothing,
// or by nothing.
TEST_F(PartsOfACharacter, ThatLieInOneAnotherShowBothOverlaps) {
  MadePart inner = part_of(tube, "inner", 0.5);
  write_character(made_character(tube.skeleton, {part_of(tube, "body"), inner}));
  const auto scene = load("");
  const double inside = signed_volume(scene->rig.mesh.V, scene->rig.mesh.F) / 9;  // of 1 + 1/8
  Frame apart = posed(*scene, "linear-blend");
  Eigen::MatrixX3d& points = apart.parts["surface"].points;
  points.topRows(tube.mesh.vertex_count()) = tube.mesh.V;
  points.bottomRows(tube.mesh.vertex_count()) = 0.5 * tube.mesh.V;
  points.bottomRows(tube.mesh.vertex_count()).col(2).array() += 1;
  const test::MetricTable table(metrics());
  const auto value = [&](const char* name) { return table.of_frame(name, *scene, apart).value(); };
  EXPECT_NEAR(value("overlap_at_rest_body"), inside, 0.02 * inside);
  EXPECT_EQ(value("overlap_posed_body"), 0);
  EXPECT_EQ(value("overlap_excess_raw_body"), -value("overlap_at_rest_body"));
  EXPECT_EQ(value("overlap_excess_body"), 0);
  for (const char* name : {"overlap_at_rest", "overlap_posed"}) EXPECT_GE(value(name), 0) << name;
}

/// A box between x = from and to.
MadePart box(const std::string& name, double from, double to) {
  MadePart part{name, {}, SkinWeights(8, 2), 0};
  part.mesh.V.resize(8, 3);
  part.mesh.F.resize(12, 3);
  part.mesh.F << 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0,
      6, 4, 1, 5, 7, 1, 7, 3;
  for (int v = 0; v < 8; ++v) {
    part.mesh.V.row(v) << (v < 4 ? from : to), (v & 2) == 0 ? -0.1 : 0.1, (v & 1) == 0 ? -0.1 : 0.1;
    part.weights.insert(v, from < 0 ? 0 : 1) = 1;
  }
  return part;
}

// Welded, the four edges of the face between them would have four triangles each.
TEST_F(PartsOfACharacter, ThatTouchStayApart) {
  write_character(made_character(tube.skeleton, {box("a", -0.5, 0), box("b", 0, 0.5)}));
  const auto scene = load("");
  EXPECT_NO_THROW(require_closed_manifold(scene->rig.mesh, "test", ""));
  EXPECT_EQ(scene->rig.mesh.vertex_count(), 16);
  EXPECT_THAT(scene->load_warnings, ElementsAre(HasSubstr("its parts touch along")));
}

/// The clip of the file, in two frames.
constexpr const char* kClip = "motion = { kind = \"clip\", frames = 2 }\n";
constexpr const char* kStripped =
    "motion = { kind = \"clip\", frames = 2, joint_scale = \"strip\" }\n";

TEST_F(PartsOfACharacter, OfAJointThatIsScaledToZeroAreRefusedByItsName) {
  test::GltfSample clip = made_character(tube.skeleton, {part_of(tube, "body")});
  add_clip("scale", {1, 1, 1}, {1, 0, 1}, 1, clip);
  write_character(clip);
  EXPECT_THAT(refusal("", kClip),
              HasSubstr("my.glb: the clip 'clip' scales joint 'upper' to zero at 1 s"));
  EXPECT_THAT(load("", kStripped)->load_warnings, ElementsAre(HasSubstr("played without scale")));

  test::GltfSample infinite = made_character(tube.skeleton, {part_of(tube, "body")});
  add_clip("scale", {1, 1, 1}, {1, std::numeric_limits<float>::infinity(), 1}, 1, infinite);
  write_character(infinite);
  EXPECT_THAT(refusal("", kClip),
              AllOf(HasSubstr("a value is not finite at 1"), HasSubstr("scale of 'upper'")));

  test::GltfSample node = made_character(tube.skeleton, {part_of(tube, "body")});
  node.json["nodes"][1]["scale"] = {0, 0, 0};
  write_character(node);
  EXPECT_THAT(refusal(""), HasSubstr("my.glb: the file's scene scales joint 'upper' to zero"));
}

TEST_F(PartsOfACharacter, OfABindMatrixThatIsZeroAreRefusedByItsJoint) {
  for (const float x : {0.F, std::numeric_limits<float>::quiet_NaN()}) {
    test::GltfSample s = made_character(tube.skeleton, {part_of(tube, "body")});
    const std::size_t view = s.json["accessors"][0]["bufferView"];
    const std::size_t offset = s.json["bufferViews"][view]["byteOffset"];
    std::memcpy(s.binary.data() + offset + 64, &x, sizeof(x));
    write_character(s);
    EXPECT_THAT(refusal(""), AllOf(HasSubstr("bind matrix of joint 1"), HasSubstr("'upper'")));
  }
}

TEST_F(PartsOfACharacter, BoundWithAScaleThatDiffersByDirectionAreSaid) {
  test::GltfSample s = made_character(tube.skeleton, {part_of(tube, "body")});
  const std::size_t view = s.json["accessors"][0]["bufferView"];
  const std::size_t offset = s.json["bufferViews"][view]["byteOffset"];
  const float half = 0.5F;
  std::memcpy(s.binary.data() + offset + 64, &half, sizeof(half));
  write_character(s);
  EXPECT_THAT(
      load("")->load_warnings,
      ElementsAre(AllOf(HasSubstr("1 joint is bound with a scale that differs by direction"),
                        HasSubstr("'upper' by a factor of 2"))));
}

}  // namespace
}  // namespace geoprior::skinning
