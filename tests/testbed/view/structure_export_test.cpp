// Structures of a run in glTF: named nodes, colours of kinds, meshes that are switched by time.
#include "testbed/view/structure_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/model.h"
#include "testbed/formats/gltf/reader.h"
#include "testbed/formats/gltf/switched_meshes.h"
#include "testbed/view/export.h"
#include "testbed/view/figure/colors.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/view/organ_parts.h"

namespace geoprior {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::byte> to_bytes(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

gltf::Model model_of(const std::string& glb) {
  return gltf::parse_gltf(to_bytes(glb), "organs.glb", false);
}

const gltf::Node& node_of(const gltf::Model& model, const std::string& name) {
  for (const gltf::Node& node : model.nodes) {
    if (node.name == name) return node;
  }
  throw Error("no node '" + name + "'");
}

/// Whether the animation shows a node at a time: the last key that is not later.
bool is_shown(const gltf::Model& model, const std::string& name, double time) {
  const gltf::Animation& animation = model.animations.at(0);
  for (const gltf::Channel& channel : animation.channels) {
    if (model.nodes[*channel.node].name != name || channel.path != "scale") continue;
    const gltf::Sampler& sampler = animation.samplers[channel.sampler];
    EXPECT_EQ(sampler.interpolation, "STEP");
    const Eigen::MatrixXd times = decode(model, sampler.input),
                          scales = decode(model, sampler.output);
    Eigen::Index key = 0;
    while (key + 1 < times.rows() && times(key + 1, 0) <= time) ++key;
    EXPECT_TRUE(scales.row(key).isConstant(scales(key, 0)));
    return scales(key, 0) == 1;
  }
  throw Error("no channel of '" + name + "'");
}

TEST(StructureExport, OfOneFrameIsANamedMeshAStructure) {
  const Part part = organ_boxes({"kidney", "ureter", "left kidney"});
  ASSERT_TRUE(have_structures({part}));
  const gltf::Model model = model_of(structures_glb({part}, {0}, "organs"));
  ASSERT_EQ(model.nodes.size(), 3u);
  EXPECT_TRUE(model.animations.empty());
  const gltf::Mesh& ureter = model.meshes.at(*node_of(model, "ureter").mesh);
  EXPECT_EQ(ureter.name, "ureter");
  ASSERT_EQ(ureter.primitives.size(), 1u);
  const Eigen::MatrixXd V = decode(model, ureter.primitives[0].attributes.at("POSITION"));
  ASSERT_EQ(V.rows(), 8) << "the vertices of its own triangles";
  EXPECT_EQ(V.col(0).minCoeff(), 1.5);
  EXPECT_EQ(V.col(0).maxCoeff(), 2.5);
  EXPECT_EQ(decode_indices(model, *ureter.primitives[0].indices).size(), 36u);
  const Eigen::MatrixXd N = decode(model, ureter.primitives[0].attributes.at("NORMAL"));
  EXPECT_NEAR((N.rowwise().norm().array() - 1).abs().maxCoeff(), 0, 1e-6);
}

TEST(StructureExport, HasTheColoursOfKindsAsMaterials) {
  const std::string glb = structures_glb({organ_boxes({"kidney", "ureter"})}, {0}, "organs");
  const auto json = nlohmann::json::parse(gltf::split_container(to_bytes(glb), "organs.glb").json);
  ASSERT_EQ(json.at("materials").size(), 2u);
  EXPECT_EQ(json.at("meshes").at(1).at("primitives").at(0).at("material"), 1);
  EXPECT_EQ(json.at("materials").at(1).at("name"), "duct");
  const auto color = json.at("materials").at(1).at("pbrMetallicRoughness").at("baseColorFactor");
  for (std::size_t c = 0; c < 3; ++c) {  // sRGB of linear light, IEC 61966-2-1
    const double linear = color.at(c);
    EXPECT_NEAR(1.055 * std::pow(linear, 1 / 2.4) - 0.055, class_palette(2, false)[1][c], 1e-6);
  }
}

// The duct comes late, the kidney becomes another mesh and goes.
TEST(StructureExport, ShowsTheMeshOfEachFrameFromItsTimeToTheNext) {
  Part grown = organ_boxes({"kidney", "ureter"});
  Part gone = organ_boxes({"cyst", "ureter"});
  const Part first = organ_boxes({"kidney"});
  const std::string glb = structures_glb({first, grown, gone}, {0, 0.5, 2}, "organs");
  const gltf::Model model = model_of(glb);
  const gltf::Node& kidney = node_of(model, "kidney");
  EXPECT_FALSE(kidney.mesh);
  EXPECT_EQ(kidney.children.size(), 2u);
  EXPECT_EQ(node_of(model, "ureter").children.size(), 2u);
  EXPECT_EQ(node_of(model, "cyst").children.size(), 1u);
  EXPECT_EQ(model.nodes[*node_of(model, "kidney 0001").parent].name, "kidney");
  ASSERT_EQ(model.animations.size(), 1u);
  EXPECT_EQ(model.animations[0].channels.size(), 5u);
  const auto shown = [&](double time) {
    std::vector<std::string> names;
    for (const char* name :
         {"kidney 0000", "kidney 0001", "ureter 0001", "ureter 0002", "cyst 0002"}) {
      if (is_shown(model, name, time)) names.emplace_back(name);
    }
    return names;
  };
  EXPECT_THAT(shown(0), ElementsAre("kidney 0000"));
  EXPECT_THAT(shown(0.49), ElementsAre("kidney 0000"));
  EXPECT_THAT(shown(0.5), ElementsAre("kidney 0001", "ureter 0001"));
  EXPECT_THAT(shown(1.99), ElementsAre("kidney 0001", "ureter 0001"));
  EXPECT_THAT(shown(2), ElementsAre("ureter 0002", "cyst 0002"));
  EXPECT_EQ(node_of(model, "kidney 0000").scale, Eigen::Vector3d::Ones());
  EXPECT_EQ(node_of(model, "ureter 0001").scale, Eigen::Vector3d::Zero()) << "without animation";
}

TEST(StructureExport, IsReadBackAsTheClipThatItIs) {
  const std::string glb = structures_glb(
      {organ_boxes({"kidney"}), organ_boxes({"kidney", "ureter"})}, {0, 1}, "organs");
  const GltfCharacter read = read_gltf_bytes(to_bytes(glb), "organs.glb");
  EXPECT_EQ(read.mesh.F.rows(), 12 + 2 * 12);
  ASSERT_EQ(read.clips.size(), 1u);
  EXPECT_EQ(read.clips[0].end_s, 2) << "the last frame is seen as long as the one before it";
  EXPECT_EQ(read.clips[0].tracks.at(0).interpolation, GltfTrack::Interpolation::step);
  EXPECT_EQ(glb, structures_glb({organ_boxes({"kidney"}), organ_boxes({"kidney", "ureter"})},
                                {0, 1}, "organs"));
}

TEST(StructureExport, IsOfSurfacesWithNamedStructuresAlone) {
  const Part organs = organ_boxes({"kidney"});
  Part numbers = organs;
  numbers.arrays[0].names.clear();
  Part nothing;
  EXPECT_FALSE(have_structures({numbers}));
  EXPECT_FALSE(have_structures({organs, numbers}));
  EXPECT_FALSE(have_structures({nothing}));
  EXPECT_FALSE(have_structures({}));
  EXPECT_TRUE(have_structures({nothing, organs})) << "nothing is there yet";
  Part lines = organs;
  lines.kind = Part::Kind::lines;
  EXPECT_FALSE(have_structures({lines}));
  Part wrong = organs;
  wrong.arrays[0].values(3, 0) = 1;
  EXPECT_THAT(test::error_of([&] { structures_glb({wrong}, {0}, "organs"); }),
              HasSubstr("organs: array 'structure'"));
  EXPECT_THAT(test::error_of([&] {
                structures_glb({organs, organs}, {1, 1}, "organs");
              }),
              HasSubstr("time of frame 1"));
  EXPECT_THAT(test::error_of([&] {
                switched_meshes_glb({{"kidney", {{}}}}, {}, {0}, "organs");
              }),
              HasSubstr("no surface"));
}

// Days are the frames' parameter: an eighth of a second each.
TEST(StructureExport, OfARunIsOneFileAVariantWithADayAnEighthOfASecond) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  record.cases[0].parameter_unit = "d";
  VariantRecord& variant = record.cases[0].variants[0];
  variant.frames.clear();
  add_frame(variant, folder.path, 40, organ_boxes({"kidney"}));
  add_frame(variant, folder.path, 44, organ_boxes({"kidney", "ureter"}));
  write_fake_run(record, folder.path);
  export_run(OpenedRun(folder.path), "glb", folder.path / "out");
  const gltf::Model model =
      gltf::parse_gltf(folder.path / "out/default" / variant.name / "surface.glb");
  EXPECT_TRUE(is_shown(model, "kidney 0000", 0.49));
  EXPECT_FALSE(is_shown(model, "kidney 0000", 0.5));
  EXPECT_TRUE(is_shown(model, "ureter 0001", 0.5));
}

}  // namespace
}  // namespace geoprior
