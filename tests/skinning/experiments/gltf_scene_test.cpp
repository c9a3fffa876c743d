// What of a glTF file belongs to the character: scenes, several skins and meshes, morph targets,
// extensions; and what is said of the rest.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/topology.h"
#include "testbed/formats/gltf/reader.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using nlohmann::json;
using test::GltfSample;
using test::skinned_square;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

GltfCharacter read_scene(const GltfSample& sample, const GltfReadOptions& options = {}) {
  return read_gltf_bytes(sample.bytes(), "sample.glb", options);
}

std::string scene_error(const GltfSample& sample) {
  return test::error_of([&] { read_scene(sample); });
}

/// Adds the square again as mesh 1, without a node.
GltfSample with_second_mesh(const std::string& name) {
  GltfSample s = skinned_square();
  s.json["meshes"].push_back(s.json["meshes"][0]);
  s.json["meshes"][1]["name"] = name;
  return s;
}

/// Adds a triangle without skin, 1 wide, in the plane z = 0, as mesh 1.
GltfSample with_rigid_mesh() {
  GltfSample s = skinned_square();
  const auto positions = s.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3, 5126);
  s.json["meshes"].push_back(
      {{"name", "eye"}, {"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  return s;
}

TEST(GltfScene, NodesOutsideOfItAreNamedAndNotRead) {
  GltfSample s = with_second_mesh("low");
  s.json["nodes"].push_back({{"name", "lod1"}, {"mesh", 1}, {"skin", 0}});
  s.json["scenes"][0]["name"] = "street";
  for (const bool named : {false, true}) {
    if (named) s.json["scene"] = 0;
    const GltfCharacter c = read_scene(s);
    EXPECT_EQ(c.mesh.vertex_count(), 4);
    EXPECT_THAT(c.warnings,
                Contains(AllOf(HasSubstr("sample.glb: left out, as scene 0 'street'"),
                               HasSubstr("mesh 'low' at node 'lod1' of skin 0, 4 vertices"))));
  }
  // Whoever names it, gets it.
  EXPECT_THAT(read_scene(s, {"low"}).warnings,
              Contains(HasSubstr("mesh 'low' is read as it is asked for")));
  s.json.erase("scenes");
  s.json.erase("scene");
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 8) << "a library has no scene";
}

TEST(GltfScene, IsTheOneThatTheFileNamesElseTheFirst) {
  GltfSample s = with_rigid_mesh();
  s.json["nodes"].push_back({{"name", "prop"}, {"mesh", 1}});
  s.json["scenes"].push_back({{"nodes", {3}}});
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4);
  EXPECT_THAT(read_scene(s).warnings, Contains(HasSubstr("scene 0, the first of 2")));
  s.json["scene"] = 1;
  const GltfCharacter second = read_scene(s);
  EXPECT_EQ(second.mesh.vertex_count(), 3);
  EXPECT_FALSE(second.skeleton);
  s.json["scenes"][1] = json::object();
  EXPECT_THAT(scene_error(s), AllOf(HasSubstr("no node of scene 1 has a mesh"),
                                    HasSubstr("mesh = \"…\" for one beyond it: mesh 'square'")));
}

TEST(GltfScene, HiddenNodesAreLeftOut) {
  GltfSample s = with_rigid_mesh();
  s.json["nodes"].push_back({{"name", "helper"},
                             {"children", {4}},
                             {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  s.json["nodes"].push_back({{"mesh", 1}});
  s.json["nodes"][2]["children"] = {3};
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4);
  EXPECT_THAT(read_scene(s).warnings, Contains(HasSubstr("mesh 'eye', 3 vertices")));
  s.json.erase("scenes");
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4);
  s.json["nodes"][3]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 7);
}

TEST(GltfMorph, DefaultWeightsMoveTheRestPose) {
  GltfSample s = skinned_square();
  auto& mesh = s.json["meshes"][0];
  const auto up = s.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3, 5126);
  const auto right = s.accessor<float>({4, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0}, "VEC3", 3, 5126);
  mesh["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"NORMAL", up}}, {{"POSITION", right}}};
  EXPECT_EQ(read_scene(s).mesh.V.row(2), Eigen::RowVector3d(1, 1, 0));
  mesh["weights"] = {1, 1, 0.25};
  EXPECT_EQ(read_scene(s).mesh.V.row(2), Eigen::RowVector3d(2, 1, 1));
  EXPECT_THAT(read_scene(s).warnings,
              Contains(HasSubstr("morph targets of mesh 'square' are added with their default "
                                 "weights 1, 1, 0.25")));
  s.json["nodes"][0]["weights"] = {0.5, 0, 0};  // of the node, before those of the mesh
  EXPECT_EQ(read_scene(s).mesh.V.row(2), Eigen::RowVector3d(1, 1, 0.5));
  s.json["nodes"][0]["weights"] = {0.5};
  EXPECT_THAT(scene_error(s), HasSubstr("1 default weights for 3 morph targets"));
}

TEST(GltfMorph, TargetsFitTheirPositions) {
  GltfSample s = skinned_square();
  auto& mesh = s.json["meshes"][0];
  mesh["primitives"][0]["targets"] = {{{"POSITION", 3}}};
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4) << "weight 0";
  mesh["weights"] = {1};
  EXPECT_THAT(scene_error(s), HasSubstr("POSITION of morph target 0 does not fit the positions"));
  mesh["weights"] = {"one"};
  EXPECT_THAT(scene_error(s), HasSubstr("/meshes/0/weights/0: is not a number"));
}

TEST(GltfSkins, OnTheSameJointsMakeOneSkeleton) {
  // A coat, first in the file, whose skin lists the joints the other way round and whose own
  // coordinates lie 5 along x from those of the body.
  GltfSample s = with_second_mesh("coat");
  std::vector<float> bind(32, 0);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = bind[16 + 5 * i] = 1;
  bind[12] = bind[28] = -5;
  bind[13] = -1;
  const auto inverse = s.accessor<float>(bind, "MAT4", 16, 5126);
  s.json["skins"].push_back({{"joints", {2, 1}}, {"inverseBindMatrices", inverse}});
  s.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] =
      s.accessor<float>({5, 0, 1, 6, 0, 1, 6, 1, 1, 5, 1, 1}, "VEC3", 3, 5126);
  s.json["nodes"].push_back({{"name", "coat"}, {"mesh", 1}, {"skin", 1}});
  s.json["scenes"][0]["nodes"] = {3, 0, 1};
  const GltfCharacter c = read_scene(s);
  ASSERT_EQ(c.mesh.vertex_count(), 8);
  EXPECT_EQ(c.skeleton->size(), 2);
  // The file's order of nodes: the body, then the coat.
  EXPECT_EQ(c.mesh.V.row(2), Eigen::RowVector3d(1, 1, 0));
  EXPECT_NEAR((c.mesh.V.row(6) - Eigen::RowVector3d(1, 1, 1)).norm(), 0, 1e-12);
  EXPECT_EQ(c.weights.coeff(2, 1), 1);
  EXPECT_EQ(c.weights.coeff(6, 0), 1) << "the coat's second entry is the hip";
  EXPECT_EQ(c.weights.coeff(4, 1), 1);
  EXPECT_THAT(c.warnings, IsEmpty());
}

TEST(GltfSkins, WithMoreJointsBelowBringThem) {
  // Hair on a joint of its own, 2 above the knee; its skin does not have the other joints.
  GltfSample s = with_second_mesh("hair");
  s.json["nodes"].push_back({{"name", "strand"}, {"translation", {0, 2, 0}}});
  s.json["nodes"][2]["children"] = {3};
  s.json["nodes"].push_back({{"name", "hair"}, {"mesh", 1}, {"skin", 1}});
  s.json["scenes"][0]["nodes"] = {4, 0, 1};
  std::vector<float> bind(16, 0);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = 1;
  bind[13] = -3;
  const auto inverse = s.accessor<float>(bind, "MAT4", 16, 5126);
  s.json["skins"].push_back({{"joints", {3}}, {"inverseBindMatrices", inverse}});
  s.json["meshes"][1]["primitives"][0]["attributes"]["JOINTS_0"] =
      s.accessor<std::uint8_t>(std::vector<std::uint8_t>(16, 0), "VEC4", 4, 5121);
  const GltfCharacter c = read_scene(s);
  ASSERT_TRUE(c.skeleton);
  ASSERT_EQ(c.skeleton->size(), 3);
  EXPECT_EQ(c.skeleton->joints[2].name, "strand");
  EXPECT_EQ(c.skeleton->joints[2].parent, 1);
  EXPECT_EQ(c.skeleton->joints[2].head, Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(c.mesh.vertex_count(), 8);
  EXPECT_EQ(c.weights.coeff(6, 2), 1);
  // The clip turns the knee by 90 degrees about (0, 1, 0), and the strand with it.
  const Eigen::Vector3d moved = clip_pose(c, c.clips[0], 1)[2] * Eigen::Vector3d(0, 3, 0);
  EXPECT_NEAR((moved - Eigen::Vector3d(-2, 1, 0)).norm(), 0, 1e-6);
}

TEST(GltfSkins, BoundInAnotherPoseAreCarriedByTheirWeights) {
  // The coat is bound with the knee 3 above the hip instead of 1: what belongs to the knee comes
  // down by 2.
  GltfSample s = with_second_mesh("coat");
  std::vector<float> bind(32, 0);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = bind[16 + 5 * i] = 1;
  bind[16 + 13] = -3;
  const auto inverse = s.accessor<float>(bind, "MAT4", 16, 5126);
  s.json["skins"].push_back({{"joints", {1, 2}}, {"inverseBindMatrices", inverse}});
  s.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] =
      s.accessor<float>({0, 0, 1, 1, 0, 1, 1, 3, 1, 0, 3, 1}, "VEC3", 3, 5126);
  s.json["nodes"].push_back({{"name", "coat"}, {"mesh", 1}, {"skin", 1}});
  s.json["scenes"][0]["nodes"] = {0, 1, 3};
  const GltfCharacter c = read_scene(s);
  EXPECT_NEAR((c.mesh.V.row(5) - Eigen::RowVector3d(1, 0, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR((c.mesh.V.row(6) - Eigen::RowVector3d(1, 1, 1)).norm(), 0, 1e-12);
  EXPECT_THAT(c.warnings, Contains(HasSubstr("skin 1 is bound in another pose than skin 0")));
}

TEST(GltfSkins, OfAnotherSkeletonAreNamedAndNotRead) {
  GltfSample s = with_second_mesh("dog");
  s.json["nodes"].push_back({{"name", "dog-hip"}, {"children", {4}}});
  s.json["nodes"].push_back({{"name", "dog-knee"}});
  s.json["nodes"].push_back({{"name", "dog-body"}, {"mesh", 1}, {"skin", 1}});
  s.json["skins"].push_back({{"joints", {3, 4}}});
  s.json["scenes"][0]["nodes"] = {0, 1, 3, 5};
  const GltfCharacter c = read_scene(s);
  EXPECT_EQ(c.mesh.vertex_count(), 4);
  EXPECT_THAT(c.warnings,
              Contains(AllOf(HasSubstr("their skins have joints of another skeleton than skin 0"),
                             HasSubstr("mesh 'dog' at node 'dog-body' of skin 1, 4 vertices"))));
  EXPECT_EQ(read_scene(s, {"dog"}).skeleton->joints[0].name, "dog-hip");
}

TEST(GltfSkins, MeshesOnAJointAreHeldToIt) {
  GltfSample s = with_rigid_mesh();
  s.json["nodes"][2]["children"] = {3};
  s.json["nodes"].push_back({{"name", "eye"}, {"mesh", 1}, {"translation", {0, 0, 2}}});
  const GltfCharacter c = read_scene(s);
  ASSERT_EQ(c.mesh.vertex_count(), 7);
  EXPECT_EQ(c.mesh.V.row(5), Eigen::RowVector3d(1, 1, 2)) << "on the knee, at (0, 1, 0)";
  EXPECT_EQ(c.weights.coeff(5, 1), 1);
  EXPECT_THAT(c.warnings, IsEmpty());

  s.json["animations"][0]["channels"].push_back(
      {{"sampler", 0}, {"target", {{"node", 3}, {"path", "rotation"}}}});
  EXPECT_THAT(read_scene(s).warnings,
              Contains(HasSubstr("mesh 'eye' has no skin and is held to joint 'knee'")));

  s.json["nodes"][2].erase("children");
  s.json["scenes"][0]["nodes"] = {0, 1, 3};
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4);
  EXPECT_THAT(read_scene(s).warnings,
              Contains(AllOf(HasSubstr("hang on no joint"), HasSubstr("mesh 'eye', 3 vertices"))));
}

TEST(GltfSkins, BindPoseCarriesWhatHangsOnAJoint) {
  // The knee stands at (0, 4, 0) in the file, and is bound at (0, 1, 0): the eye goes with it.
  GltfSample s = with_rigid_mesh();
  s.json["nodes"][2]["children"] = {3};
  s.json["nodes"][2]["translation"] = {0, 4, 0};
  s.json["nodes"].push_back({{"name", "eye"}, {"mesh", 1}, {"translation", {0, 0, 2}}});
  EXPECT_EQ(read_scene(s).mesh.V.row(5), Eigen::RowVector3d(1, 1, 2));
}

TEST(GltfScene, AMeshThatIsShownTwiceInOnePlaceIsReported) {
  GltfSample s = skinned_square();
  s.json["nodes"].push_back({{"name", "again"}, {"mesh", 0}, {"skin", 0}});
  s.json["scenes"][0]["nodes"] = {0, 1, 3};
  const GltfCharacter c = read_scene(s);
  EXPECT_EQ(c.mesh.vertex_count(), 8);
  EXPECT_THAT(c.warnings,
              Contains(AllOf(HasSubstr("mesh 'square', 4 vertices, is shown at the same place by "
                                       "nodes 'body' and 'again'"),
                             HasSubstr("area and volume count twice"))));
  EXPECT_EQ(read_scene(s, {"again"}).mesh.vertex_count(), 4);
  // Two wheels are no doubles.
  GltfSample wheels = with_rigid_mesh();
  wheels.json["nodes"] = json::parse(R"([{"mesh": 1}, {"mesh": 1, "translation": [3, 0, 0]}])");
  wheels.json.erase("skins");
  wheels.json.erase("animations");
  EXPECT_EQ(read_scene(wheels).mesh.vertex_count(), 6);
  EXPECT_THAT(read_scene(wheels).warnings, IsEmpty());
}

TEST(GltfPrimitives, LinesBesideTrianglesAreLeftOut) {
  GltfSample s = skinned_square();
  auto& primitives = s.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["mode"] = 1;
  const GltfCharacter c = read_scene(s);
  EXPECT_EQ(c.mesh.vertex_count(), 4);
  EXPECT_EQ(c.mesh.triangle_count(), 2);
  EXPECT_THAT(c.warnings, Contains(HasSubstr("/meshes/0/primitives/1: primitive mode 1 (lines) has "
                                             "no surface and is left out")));
}

TEST(GltfPrimitives, TrianglesThatNameAVertexTwiceAreCounted) {
  GltfSample s = skinned_square();
  s.json["meshes"][0]["primitives"][0]["indices"] =
      s.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3, 1, 1, 2}, "SCALAR", 1, 5123);
  EXPECT_EQ(read_scene(s).mesh.triangle_count(), 2);
  EXPECT_THAT(read_scene(s).warnings, Contains(HasSubstr("1 triangles that name a vertex twice")));
}

TEST(GltfExtensions, ThatSayHowItLooksMayBeRequired) {
  for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp", "KHR_materials_unlit",
                           "KHR_materials_variants", "KHR_texture_transform", "KHR_lights_punctual",
                           "KHR_xmp_json_ld", "MSFT_texture_dds", "KHR_mesh_quantization"}) {
    GltfSample s = skinned_square();
    s.json["extensionsUsed"] = {name};
    s.json["extensionsRequired"] = {name};
    EXPECT_THAT(read_scene(s).warnings, Contains(HasSubstr(name)));
  }
}

TEST(GltfExtensions, ThatHoldTheShapeAreRefusedWithAWayOut) {
  const auto refused = [](const char* name) {
    GltfSample s = skinned_square();
    s.json["extensionsRequired"] = {name};
    return scene_error(s);
  };
  EXPECT_THAT(refused("KHR_draco_mesh_compression"),
              AllOf(HasSubstr("KHR_draco_mesh_compression"), HasSubstr("gltf-transform cp")));
  EXPECT_THAT(refused("EXT_meshopt_compression"), HasSubstr("gltf-transform cp"));
  EXPECT_THAT(refused("EXT_mesh_gpu_instancing"), HasSubstr("Blender"));
  EXPECT_THAT(refused("KHR_animation_pointer"),
              AllOf(HasSubstr("KHR_materials_…"), HasSubstr("KHR_mesh_quantization"),
                    HasSubstr("FB_ngon_encoding")));
}

TEST(GltfVersion, BeyondTwoIsRefusedWhereTheFileNeedsIt) {
  GltfSample s = skinned_square();
  s.json["asset"]["version"] = "2.1";
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4);
  s.json["asset"]["minVersion"] = "2.0";
  EXPECT_EQ(read_scene(s).mesh.vertex_count(), 4);
  s.json["asset"]["minVersion"] = "2.1";
  EXPECT_THAT(scene_error(s), HasSubstr("/asset/minVersion: the file needs a reader of glTF 2.1"));
  s.json["asset"] = {{"version", "1.0"}};
  EXPECT_THAT(scene_error(s), AllOf(HasSubstr("/asset/version"), HasSubstr("Blender")));
}

}  // namespace
}  // namespace geoprior::skinning
