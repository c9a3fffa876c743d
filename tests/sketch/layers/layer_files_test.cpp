#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/sketch/drawing/drawing_file.h"
#include "experiments/sketch/fabrication/fabrication.h"
#include "solvers/sketch/layers/articulated_layers.h"
#include "solvers/sketch/layers/pattern.h"
#include "testbed/formats/gltf/model.h"
#include "testbed/formats/gltf/writer.h"

namespace geoprior::sketch {
namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

/// Overlaps that are given: choosing them takes longer, and files do not differ by how they came.
LayerOptions given_overlaps() {
  LayerOptions options;
  options.overlap = 0.4;
  return options;
}

View drawn_view(const std::string& name) {
  const std::string file = std::string(GEOPRIOR_SOURCE_DIR) + "/experiments/sketch/" + name;
  return read_drawing(file, {}).drawing.views.at(0);
}

// Ten edges bound nine bands, seven edges six segments; a layer is called by its rear edge.
TEST(LayerDrawings, HaveTheirArcsInOrderWithNames) {
  for (const auto& [name, arcs] : {std::pair{"armadillo.svg", 10U}, {"lobster.svg", 7U}}) {
    const View view = drawn_view(name);
    EXPECT_EQ(strokes_of(view, StrokeKind::arc).size(), arcs) << name;
    const ArticulatedLayers layers = build_layers(view, given_overlaps());
    EXPECT_EQ(layers.bands.size(), arcs - 1);
    EXPECT_EQ(layers.hinges.size(), arcs - 2);
    for (const ArcCircle& circle : layers.circles) {
      EXPECT_FALSE(circle.name.empty());
      // Of two readings one is clearly meant.
      EXPECT_LT(circle.kept_sine, 0.05) << circle.id;
      EXPECT_GT(circle.other_sine, 0.3) << circle.id;
    }
  }
}

// Four holes a joint: two on each of its layers; a placement line on every layer but the first.
TEST(LayerFiles, HaveHolesAndPlacementsInTheirOwnLayers) {
  const LayerOptions options = given_overlaps();
  const ArticulatedLayers layers = build_layers(drawn_view("lobster.svg"), options);
  const Pattern pattern = layer_pattern(layers, options, 0.02);
  FabricationOptions fabrication;
  fabrication.sheet.allowance_mm = fabrication.sheet.hem_mm = 0;
  for (const FabricationFile& file : fabrication_files(pattern, fabrication)) {
    if (file.name == "pattern.svg") {
      EXPECT_EQ(occurrences(file.bytes, "data-hole="), 4 * layers.hinges.size());
      EXPECT_EQ(occurrences(file.bytes, "data-place="), layers.hinges.size());
      EXPECT_EQ(occurrences(file.bytes, "id=\"drill\""), 1U);
    } else if (file.name == "pattern.dxf") {
      EXPECT_EQ(occurrences(file.bytes, "POINT\n8\n13\n"), 4 * layers.hinges.size());
    } else if (file.name == "pattern.json") {
      const auto json = nlohmann::json::parse(file.bytes);
      ASSERT_EQ(json["pieces"].size(), layers.bands.size());
      EXPECT_EQ(json["pieces"][0]["holes"].size(), 2U);
      EXPECT_EQ(json["pieces"][1]["holes"].size(), 4U);
      EXPECT_NEAR(json["pieces"][1]["holes"][0]["radius_mm"].get<double>(),
                  1000 * options.rivet_radius * layers.unit, 1e-9);
    }
  }
}

// The names of a drawing's arcs are on the pieces of every file.
TEST(LayerFiles, PiecesHaveTheNamesOfTheirRearEdges) {
  const ArticulatedLayers layers = build_layers(drawn_view("lobster.svg"), given_overlaps());
  const Pattern pattern = layer_pattern(layers, given_overlaps(), 0.02);
  for (std::size_t j = 0; j < pattern.pieces.size(); ++j)
    EXPECT_EQ(pattern.pieces[j].name, "segment " + std::to_string(j + 1));
  for (const FabricationFile& file : fabrication_files(pattern, {})) {
    if (file.name == "pattern.svg") {
      EXPECT_GE(occurrences(file.bytes, "segment 3"), 1U);
    } else if (file.name == "pattern.dxf") {
      EXPECT_GE(occurrences(file.bytes, "PIECE NAME: "), layers.bands.size());
    } else if (file.name == "pattern.json") {
      EXPECT_EQ(nlohmann::json::parse(file.bytes)["pieces"][2]["name"], "segment 3");
    }
  }
}

/// A pattern without rivets is written as before there were any.
TEST(LayerFiles, PatternsWithoutHolesHaveNoSuchLayers) {
  const LayerOptions options = given_overlaps();
  Pattern pattern = layer_pattern(build_layers(drawn_view("lobster.svg"), options), options, 0.02);
  for (PatternPiece& piece : pattern.pieces) {
    piece.holes.clear();
    piece.placements.clear();
  }
  for (const FabricationFile& file : fabrication_files(pattern, {})) {
    EXPECT_EQ(occurrences(file.bytes, "drill"), 0U) << file.name;
    EXPECT_EQ(occurrences(file.bytes, "holes"), 0U) << file.name;
  }
}

GltfLink triangle_link(const std::string& name, const Eigen::Vector3d& pivot,
                       const std::vector<double>& angles) {
  GltfLink link;
  link.name = name;
  link.mesh.V = Eigen::Matrix3d::Identity();
  link.mesh.F.resize(1, 3);
  link.mesh.F << 0, 1, 2;
  link.pivot = pivot;
  link.axis = {0, 0, 1};
  link.angles = angles;
  return link;
}

// Node by node, key by key as the file has it: a point turned by its own hinge and by the one
// before lies where plane trigonometry puts it.
TEST(RigidChain, IsReadBackWithItsMotion) {
  const double half_pi = std::acos(0.0);
  const std::vector<GltfLink> links{triangle_link("one", {0, 0, 0}, {0, 0}),
                                    triangle_link("two", {1, 0, 0}, {0, half_pi}),
                                    triangle_link("three", {2, 0, 0}, {0, half_pi})};
  const std::string bytes = rigid_chain_glb(links, {0, 1}, "chain");
  EXPECT_EQ(bytes, rigid_chain_glb(links, {0, 1}, "chain"));
  std::vector<std::byte> raw(bytes.size());
  std::memcpy(raw.data(), bytes.data(), bytes.size());
  const gltf::Model model = gltf::parse_gltf(raw, "chain.glb", false);
  ASSERT_EQ(model.nodes.size(), 3U);
  ASSERT_EQ(model.animations.size(), 1U);
  ASSERT_EQ(model.animations[0].channels.size(), 2U);
  std::vector<Eigen::Quaterniond> turn(3, Eigen::Quaterniond::Identity());
  for (const gltf::Channel& channel : model.animations[0].channels) {
    EXPECT_EQ(channel.path, "rotation");
    const gltf::Sampler& sampler = model.animations[0].samplers.at(channel.sampler);
    const Eigen::MatrixXd keys = gltf::decode(model, sampler.output);
    ASSERT_EQ(keys.rows(), 2);
    EXPECT_EQ(gltf::decode(model, sampler.input)(1, 0), 1);
    turn[*channel.node] = Eigen::Quaterniond(keys(1, 3), keys(1, 0), keys(1, 1), keys(1, 2));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(model.nodes[i].name, links[i].name);
    EXPECT_EQ(model.nodes[i].parent.has_value(), i > 0);
    pose = pose * Eigen::Translation3d(model.nodes[i].translation) * turn[i];
  }
  // Vertex (1, 0, 0) of link three lies at (-1, 0, 0) from its hinge. Two quarter turns make that
  // (1, 0, 0) from where the first of them takes the hinge, (1, 1, 0).
  const std::size_t positions = model.meshes[2].primitives[0].attributes.at("POSITION");
  const Eigen::Vector3d vertex = gltf::decode(model, positions).row(0).transpose();
  EXPECT_NEAR((pose * vertex - Eigen::Vector3d(2, 1, 0)).norm(), 0, 1e-6);
}

TEST(RigidChain, RefusesWhatIsNoMotion) {
  EXPECT_THROW(rigid_chain_glb({}, {0}, "chain"), Error);
  EXPECT_THROW(rigid_chain_glb({triangle_link("one", {0, 0, 0}, {0})}, {0, 1}, "chain"), Error);
  EXPECT_THROW(rigid_chain_glb({triangle_link("one", {0, 0, 0}, {0, 0})}, {1, 1}, "chain"), Error);
}

}  // namespace
}  // namespace geoprior::sketch
