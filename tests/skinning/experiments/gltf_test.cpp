#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "experiments/skinning/scene/characters.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/gltf/reader.h"
#include "testbed/formats/gltf/writer.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using test::error_of;
using test::GltfSample;
using test::skinned_square;
using testing::HasSubstr;

GltfCharacter read(const GltfSample& sample, const GltfReadOptions& options = {}) {
  return read_gltf_bytes(sample.bytes(), "sample.glb", options);
}

std::string error_of(const GltfSample& sample) {
  return error_of([&] { read(sample); });
}

std::string error_of_model(const std::string& file) {
  return error_of([&] { read_gltf(test_models_folder() / file); });
}

TEST(Gltf, ReadsASkinnedSquare) {
  const GltfCharacter c = read(skinned_square());
  ASSERT_TRUE(c.skeleton);
  ASSERT_EQ(c.skeleton->size(), 2);
  EXPECT_EQ(c.skeleton->joints[1].name, "knee");
  EXPECT_EQ(c.skeleton->joints[1].parent, 0);
  EXPECT_EQ(c.skeleton->joints[1].head, Eigen::Vector3d(0, 1, 0));
  ASSERT_TRUE(c.skeleton->joints[0].tail);
  EXPECT_EQ(*c.skeleton->joints[0].tail, Eigen::Vector3d(0, 1, 0));
  EXPECT_FALSE(c.skeleton->joints[1].tail);  // a leaf has none
  EXPECT_EQ(c.mesh.V.row(2), Eigen::RowVector3d(1, 1, 0));
  EXPECT_EQ(c.mesh.triangle_count(), 2);
  EXPECT_EQ(c.weights.coeff(0, 0), 1);
  EXPECT_EQ(c.weights.coeff(2, 1), 1);
  EXPECT_TRUE(c.warnings.empty());
}

TEST(Gltf, ClipAtItsMiddleTurnsByHalfTheAngle) {
  const GltfCharacter c = read(skinned_square());
  ASSERT_EQ(c.clips.size(), 1U);
  EXPECT_EQ(c.clips[0].end_s, 1);
  const Pose pose = clip_pose(c, c.clips[0], 0.5);
  EXPECT_TRUE(pose[0].isApprox(Eigen::Affine3d::Identity(), 1e-12));
  // (1, 1, 0) turns about (0, 1, 0) by 45 degrees; float quaternions are good to 1e-7.
  const Eigen::Vector3d moved = pose[1] * Eigen::Vector3d(1, 1, 0);
  EXPECT_NEAR((moved - Eigen::Vector3d(std::sqrt(0.5), 1 + std::sqrt(0.5), 0)).norm(), 0, 1e-6);
}

TEST(Gltf, StepHoldsAndCubicSplineWithFlatTangentsEases) {
  GltfSample step = skinned_square();
  step.json["animations"][0]["samplers"][0]["interpolation"] = "STEP";
  const GltfCharacter s = read(step);
  EXPECT_TRUE(clip_pose(s, s.clips[0], 0.99)[1].isApprox(Eigen::Affine3d::Identity(), 1e-12));

  GltfSample cubic = skinned_square();
  // Translation of the knee from y = 1 to y = 3, tangents zero: Hermite weight at 1/4 is 5/32.
  const auto out = cubic.accessor<float>({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0},
                                         "VEC3", 3, 5126);
  cubic.json["animations"][0]["samplers"][0]["output"] = out;
  cubic.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  cubic.json["animations"][0]["channels"][0]["target"]["path"] = "translation";
  const GltfCharacter c = read(cubic);
  EXPECT_NEAR(clip_pose(c, c.clips[0], 0.25)[1].translation().y(), 2 * 5.0 / 32, 1e-12);
}

TEST(Gltf, NormalisedIntegersAndSeveralSetsGiveTheSameWeights) {
  GltfSample s = skinned_square();
  // Vertex 2: 3/5 in set 0, 2/5 in set 1, as bytes of 255.
  s.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = s.accessor<std::uint8_t>(
      {255, 0, 0, 0, 255, 0, 0, 0, 153, 0, 0, 0, 255, 0, 0, 0}, "VEC4", 4, 5121, true);
  s.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_1"] =
      s.accessor<std::uint16_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4, 5123);
  s.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_1"] = s.accessor<std::uint16_t>(
      {0, 0, 0, 0, 0, 0, 0, 0, 26214, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4, 5123, true);
  const GltfCharacter c = read(s);
  EXPECT_NEAR(c.weights.coeff(2, 1), 0.6, 1e-12);
  EXPECT_NEAR(c.weights.coeff(2, 0), 0.4, 1e-12);
}

TEST(Gltf, SparseAndStridedAccessorsAreResolved) {
  GltfSample s = skinned_square();
  // Positions interleaved with 4 bytes of padding, and vertex 3 replaced by a sparse value.
  const float x = 99;
  s.json["accessors"][0]["bufferView"] =
      s.view<float>({0, 0, 0, x, 1, 0, 0, x, 1, 1, 0, x, 7, 7, 7});
  s.json["bufferViews"].back()["byteStride"] = 16;
  const auto index = s.view<std::uint8_t>({3});
  const auto value = s.view<float>({0, 1, 0.25F});
  s.json["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", index}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", value}}}};
  const GltfCharacter c = read(s);
  EXPECT_EQ(c.mesh.V.row(1), Eigen::RowVector3d(1, 0, 0));
  EXPECT_EQ(c.mesh.V.row(3), Eigen::RowVector3d(0, 1, 0.25));
}

TEST(Gltf, SeveralPrimitivesStripsAndFansJoin) {
  GltfSample s = skinned_square();
  auto& primitives = s.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives.push_back(primitives[0]);
  const auto strip = s.accessor<std::uint32_t>({0, 1, 3, 2}, "SCALAR", 1, 5125);
  const auto fan = s.accessor<std::uint8_t>({0, 1, 2, 3}, "SCALAR", 1, 5121);
  primitives[1]["indices"] = strip;
  primitives[1]["mode"] = 5;
  primitives[2]["indices"] = fan;
  primitives[2]["mode"] = 6;
  const GltfCharacter c = read(s);
  EXPECT_EQ(c.mesh.vertex_count(), 12);
  ASSERT_EQ(c.mesh.triangle_count(), 6);
  const Eigen::MatrixX3d normals = triangle_normals(c.mesh);
  for (int f = 0; f < 6; ++f)  // all keep their orientation
    EXPECT_EQ(normals.row(f), Eigen::RowVector3d(0, 0, 1)) << f;
  EXPECT_EQ(weld_by_position(c.mesh).mesh.vertex_count(), 4);
}

TEST(Gltf, WithoutSkinNodesPlaceTheMeshAndMirrorsKeepTheOutsideOut) {
  GltfSample s = skinned_square();
  s.json.erase("skins");
  s.json.erase("animations");
  s.json["nodes"][0] = {{"mesh", 0}, {"matrix", {-2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 0, 0, 1}}};
  const GltfCharacter c = read(s);
  EXPECT_FALSE(c.skeleton);
  EXPECT_EQ(c.mesh.V.row(1), Eigen::RowVector3d(3, 0, 0));
  EXPECT_EQ(triangle_normals(c.mesh).row(0), Eigen::RowVector3d(0, 0, 1));
}

TEST(Gltf, RestIsTheBindPosePlacedByTheRootJoint) {
  GltfSample s = skinned_square();
  s.json["nodes"][1]["translation"] = {0, 0, 4};  // the hip stands elsewhere than when bound
  s.json["nodes"][1]["scale"] = {2, 2, 2};
  const GltfCharacter c = read(s);
  EXPECT_EQ(c.mesh.V.row(2), Eigen::RowVector3d(2, 2, 4));
  EXPECT_EQ(c.skeleton->joints[1].head, Eigen::Vector3d(0, 2, 4));
  for (const Eigen::Affine3d& t : clip_pose(c, c.clips[0], 0))
    EXPECT_TRUE(t.isApprox(Eigen::Affine3d::Identity(), 1e-12));
}

TEST(Gltf, EverythingElseIsIgnoredWithOneWarningThatNamesIt) {
  GltfSample s = skinned_square();
  s.json["cameras"] = {{{"type", "perspective"}}};
  s.json["materials"] = {{{"name", "skin"}}};
  s.json["extensionsUsed"] = {"KHR_lights_punctual"};
  s.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  s.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 0;
  const GltfCharacter c = read(s);
  ASSERT_EQ(c.warnings.size(), 1U);
  for (const char* what : {"sample.glb", "1 cameras", "1 materials", "KHR_lights_punctual",
                           "morph targets, of default weight 0", "NORMAL"})
    EXPECT_THAT(c.warnings[0], HasSubstr(what));
}

TEST(Gltf, TruncationAtAnyByteIsAnError) {
  const std::vector<std::byte> bytes = skinned_square().bytes();
  for (std::size_t n = 0; n < bytes.size(); n += 7) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + n);
    EXPECT_THROW(read_gltf_bytes(cut, "cut.glb"), Error) << n;
  }
  const std::vector<std::byte> cut(bytes.begin(), bytes.end() - 4);
  EXPECT_THAT(error_of([&] { read_gltf_bytes(cut, "cut.glb"); }),
              testing::AllOf(HasSubstr("cut.glb"), HasSubstr("truncated")));
}

TEST(Gltf, BadIndicesNameTheirPlace) {
  GltfSample s = skinned_square();
  s.json["accessors"][1]["bufferView"] = s.view<std::uint16_t>({0, 1, 2, 0, 2, 4});
  EXPECT_THAT(error_of(s), HasSubstr("/meshes/0/primitives/0: index 4 at place 5"));
  GltfSample overflow = skinned_square();
  overflow.json["accessors"][1]["componentType"] = 5125;
  overflow.json["accessors"][1]["bufferView"] =
      overflow.view<std::uint32_t>({0, 1, 2, 0, 2, 0xFFFFFFFFU});
  EXPECT_THAT(error_of(overflow), HasSubstr("index 4294967295"));
  GltfSample node = skinned_square();
  node.json["nodes"][0]["mesh"] = 3;
  EXPECT_THAT(error_of(node), HasSubstr("/nodes/0/mesh: index 3 of meshes is out of range"));
  GltfSample joint = skinned_square();
  joint.json["accessors"][2]["bufferView"] =
      joint.view<std::uint8_t>({0, 0, 0, 0, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  EXPECT_THAT(error_of(joint), HasSubstr("vertex 1: joint index 9"));
}

TEST(Gltf, BadNumbersNameTheirVertex) {
  GltfSample nan = skinned_square();
  const float none = std::numeric_limits<float>::quiet_NaN();
  nan.json["accessors"][0]["bufferView"] = nan.view<float>({0, 0, 0, 1, 0, 0, 1, none, 0, 0, 1, 0});
  EXPECT_THAT(error_of(nan), HasSubstr("vertex 2: position is not finite"));
  GltfSample zero = skinned_square();
  zero.json["accessors"][3]["bufferView"] =
      zero.view<float>({1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  EXPECT_THAT(error_of(zero), HasSubstr("vertex 1: its weights sum to 0"));
  GltfSample negative = skinned_square();
  negative.json["accessors"][3]["bufferView"] =
      negative.view<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1, 2, 0, 0});
  EXPECT_THAT(error_of(negative), HasSubstr("vertex 3: weight -1"));
}

TEST(Gltf, SingularBindMatrixNamesTheJoint) {
  GltfSample s = skinned_square();
  std::vector<float> bind(32, 0);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = bind[16 + 5 * i] = 1;
  bind[16] = 0;
  s.json["accessors"][4]["bufferView"] = s.view(bind);
  EXPECT_THAT(error_of(s), HasSubstr("/skins/0, bind matrix of joint 1: singular"));
}

TEST(Gltf, BindMatrixOfAnyUnitIsNotSingular) {
  GltfSample s = skinned_square();
  std::vector<float> bind(32, 0);
  for (std::size_t i = 0; i < 3; ++i) bind[5 * i] = bind[16 + 5 * i] = 1e-4F;
  bind[15] = bind[31] = 1;
  s.json["accessors"][4]["bufferView"] = s.view(bind);
  EXPECT_NEAR(read(s).mesh.V(2, 0), 1e-4, 1e-10);
}

TEST(Gltf, HierarchyMustBeATree) {
  GltfSample cycle = skinned_square();
  cycle.json["nodes"][2]["children"] = {1};
  EXPECT_THAT(error_of(cycle), HasSubstr("/nodes: the hierarchy is cyclic"));
  GltfSample self = skinned_square();
  self.json["nodes"][0]["children"] = {0};
  EXPECT_THAT(error_of(self), HasSubstr("child of itself"));
  GltfSample two = skinned_square();
  two.json["nodes"][0]["children"] = {2};
  EXPECT_THAT(error_of(two), HasSubstr("node 2 is a child of nodes 0 and 1"));
}

TEST(Gltf, AccessorsStayInsideTheirBuffers) {
  GltfSample s = skinned_square();
  s.json["accessors"][0]["count"] = 5;
  EXPECT_THAT(error_of(s), HasSubstr("/accessors/0: 5 elements of 12 bytes"));
  GltfSample huge = skinned_square();
  huge.json["accessors"][0]["count"] = 1000000000000ULL;
  EXPECT_THAT(error_of(huge), HasSubstr("reach out of buffer view"));
  GltfSample zeros = skinned_square();  // would ask for 24 GB of zeros
  zeros.json["accessors"][0].erase("bufferView");
  zeros.json["accessors"][0]["count"] = 1000000000;
  EXPECT_THAT(error_of(zeros), HasSubstr("without a buffer view"));
  GltfSample view = skinned_square();
  view.json["bufferViews"][0]["byteLength"] = 1000000;
  EXPECT_THAT(error_of(view), HasSubstr("/bufferViews/0: ends at byte"));
  GltfSample offset = skinned_square();
  offset.json["bufferViews"][0]["byteOffset"] = 0xFFFFFFFFFFFFFFFFULL;
  EXPECT_THAT(error_of(offset), HasSubstr("/bufferViews/0/byteOffset"));
}

TEST(Gltf, PointsAndLinesAreNotASkin) {
  for (int mode = 0; mode < 4; ++mode) {
    GltfSample s = skinned_square();
    s.json["meshes"][0]["primitives"][0]["mode"] = mode;
    EXPECT_THAT(error_of(s), HasSubstr("primitive mode " + std::to_string(mode)));
  }
}

TEST(Gltf, UrisLeadNowhereButBeside) {
  for (const char* uri :
       {"../secret.bin", "/etc/passwd", "http://x/y.bin", "a/../../b.bin", "%2e%2e/secret.bin",
        "bad%zz.bin", "data:text/plain,xyz", "data:application/octet-stream;base64,????"}) {
    GltfSample s = skinned_square();
    s.json["buffers"] = nlohmann::json::array({{{"byteLength", s.binary.size()}, {"uri", uri}}});
    EXPECT_THAT(error_of(s), HasSubstr("/buffers/0/uri")) << uri;
  }
}

TEST(Gltf, DeepNestingIsRefusedWithoutRecursion) {
  const std::string deep(200000, '[');
  const std::string text =
      R"({"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "type": "VEC3",
      "count": )" +
      deep + std::string(deep.size(), ']') + "}]}";
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  EXPECT_THAT(error_of([&] { read_gltf_bytes(bytes, "deep.gltf"); }),
              HasSubstr("brackets are nested too deep"));
}

TEST(Gltf, RequiredExtensionsAreRefused) {
  GltfSample s = skinned_square();
  s.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(error_of(s), HasSubstr("KHR_draco_mesh_compression"));
}

TEST(Gltf, InvalidFilesOfTheTestModelsAreRefused) {
  EXPECT_THAT(error_of_model("glTF2/IndexOutOfRange/IndexOutOfRange.gltf"),
              HasSubstr("is out of range"));
  EXPECT_THAT(error_of_model("glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf"),
              HasSubstr("is out of range"));
  EXPECT_THAT(error_of_model("glTF2/MissingBin/BoxTextured.gltf"), HasSubstr("does not exist"));
  EXPECT_THAT(error_of_model("glTF2/RecursiveNodes/RecursiveNodes.gltf"), HasSubstr("/nodes"));
  EXPECT_THAT(error_of_model("glTF2/SchemaFailures/sceneWrongType.gltf"), HasSubstr("/scene"));
  EXPECT_THAT(error_of_model("glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb"),
              HasSubstr("not finite"));
  EXPECT_THAT(error_of_model("glTF2/draco/2CylinderEngine.gltf"), HasSubstr("draco"));
}

TEST(Gltf, SimpleSkinOfTheTestModelsMovesAsAuthored) {
  const GltfCharacter c = read_gltf(test_models_folder() / "glTF2/simple_skin/simple_skin.gltf");
  ASSERT_TRUE(c.skeleton);
  EXPECT_EQ(c.skeleton->size(), 2);
  EXPECT_EQ(c.mesh.vertex_count(), 10);
  ASSERT_EQ(c.clips.size(), 1U);
  // At 1.5 s the second joint is turned by 90 degrees about z (0.707 in the file).
  const Pose pose = clip_pose(c, c.clips[0], 1.5);
  const Eigen::Vector3d turned = pose[1].linear() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((turned - Eigen::Vector3d::UnitY()).norm(), 0, 1e-3);
}

TEST(GltfWriter, FramesComeBackAsMorphTargets) {
  TriMesh mesh = read(skinned_square()).mesh;
  Eigen::MatrixX3d moved = mesh.V;
  moved.col(2).array() += 0.5;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "geoprior-frames.glb";
  write_glb_animation(file, mesh, {mesh.V, moved}, {0, 1}, "square");
  const std::string text = read_whole_file(file);
  std::uint32_t length = 0;
  std::memcpy(&length, text.data() + 12, 4);
  const auto document = nlohmann::json::parse(text.substr(20, length));
  EXPECT_EQ(document["meshes"][0]["primitives"][0]["targets"].size(), 2U);
  EXPECT_EQ(document["meshes"][0]["weights"], nlohmann::json({0, 0}));
  const std::size_t target = document["meshes"][0]["primitives"][0]["targets"][1]["POSITION"];
  EXPECT_EQ(document["accessors"][target]["max"], nlohmann::json({0, 0, 0.5}));
  EXPECT_EQ(document["animations"][0]["channels"][0]["target"]["path"], "weights");
  EXPECT_EQ(text.size() % 4, 0U);
  const GltfCharacter back = read_gltf(file);  // what any reader sees: the base mesh
  EXPECT_EQ(back.mesh.V, mesh.V);
  EXPECT_EQ(back.mesh.F, mesh.F);
  std::filesystem::remove(file);
}

TEST(GltfWriter, RefusesWhatIsNoAnimationAndLeavesNothing) {
  const TriMesh mesh = read(skinned_square()).mesh;
  const auto folder = std::filesystem::temp_directory_path() / "geoprior-writer-test";
  std::filesystem::create_directories(folder);
  const auto file = folder / "x.glb";
  Eigen::MatrixX3d nan = mesh.V;
  nan(1, 1) = std::nan("");
  const auto write = [&](const std::vector<Eigen::MatrixX3d>& frames,
                         const std::vector<double>& times) {
    return error_of([&] { write_glb_animation(file, mesh, frames, times, "x"); });
  };
  EXPECT_THAT(write({mesh.V}, {0, 1}), HasSubstr("one a frame"));
  EXPECT_THAT(write({mesh.V, mesh.V}, {1, 1}), HasSubstr("time of frame 1"));
  EXPECT_THAT(write({nan}, {0}), HasSubstr("frame 0 is not finite"));
  EXPECT_THAT(write({mesh.V.topRows(3)}, {0}), HasSubstr("3 vertices"));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace geoprior::skinning
