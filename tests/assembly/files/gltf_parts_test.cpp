#include "experiments/assembly/files/gltf_parts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/reader.h"
#include "tests/assembly/files/gltf_scenes.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

using nlohmann::json;
using test::GltfToyScene;
using test::ToyTrain;

const Eigen::Vector3d kGltfX = Eigen::Vector3d::UnitX(), kGltfY = Eigen::Vector3d::UnitY(),
                      kGltfZ = Eigen::Vector3d::UnitZ();

std::vector<std::byte> glb_as_bytes(const std::string& text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

GltfParts read_gltf_toy(const GltfToyScene& scene) {
  return read_gltf_parts_bytes(scene.bytes(), "toy.glb");
}

void expect_gltf_refused(const GltfToyScene& scene, std::initializer_list<std::string> parts) {
  test::expect_error([&] { read_gltf_toy(scene); }, parts);
}

void expect_in_text(const std::string& text, const std::vector<std::string>& pieces) {
  for (const std::string& piece : pieces)
    EXPECT_NE(text.find(piece), std::string::npos) << "'" << piece << "' in:\n" << text;
}

std::string all_gltf_warnings(const GltfParts& parts) {
  std::string all;
  for (const std::string& warning : parts.read.warnings) all += warning + "\n";
  return all;
}

json gltf_document_of(const std::vector<std::byte>& bytes) {
  return json::parse(gltf::split_container(bytes, "toy.glb").json);
}

std::vector<std::string> joints_by_name(const GltfParts& parts, const Assembly& model) {
  std::vector<std::string> joints;
  const auto& types = parts.read.set.types;
  for (const Connection& c : model.connections) {
    std::string text;
    for (const PortRef& end : {c.a, c.b}) {
      const PartType& type = types[model.parts[end.part].type];
      text += (text.empty() ? "" : " - ") + std::to_string(end.part) + " " + type.label + "." +
              type.ports[end.port].name;
    }
    joints.push_back(text);
  }
  std::sort(joints.begin(), joints.end());
  return joints;
}

/// Two bricks that meet at x = 0.1: "brick" (at the origin, port out along x) and "block".
struct TouchingBricks : GltfToyScene {
  int brick = -1, block = -1, brick_port = -1, block_port = -1;
  TouchingBricks() {
    const int mesh = add_box("box", {0, 0, 0}, {.1, .1, .1}, add_material("grey", {.5, .5, .5}));
    brick = add_node("brick", -1, {0, 0, 0}, mesh);
    block = add_node("block", -1, {.2, 0, 0}, mesh);
    brick_port = add_port("port.a", brick, {.1, 0, 0}, kGltfX, kGltfZ);
    block_port = add_port("port.b", block, {-.1, 0, 0}, -kGltfX, kGltfZ);
  }
};

TEST(GltfParts, LabelsAreNamesWithoutTheNumberOfACopy) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  std::vector<std::string> labels;
  for (const PartType& type : train.read.set.types) labels.push_back(type.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"engine", "wagon", "crate", "barrel"}));
  const Assembly& model = train.read.set.models.at(0);
  EXPECT_EQ(model.name, "toy");
  std::vector<int> types;
  for (const PlacedPart& part : model.parts) types.push_back(part.type);
  EXPECT_EQ(types, (std::vector<int>{0, 1, 1, 1, 2, 2, 3}));
}

TEST(GltfParts, PortsAreOrderedByTheirNames) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  std::vector<std::string> names;
  for (const PortType& port : train.read.set.types[1].ports) names.push_back(port.name);
  EXPECT_EQ(names, (std::vector<std::string>{"back", "front", "top"}));
}

TEST(GltfParts, ThePortsFrameIsArrowAndLocalYOfBlender) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  const auto& ports = train.read.set.types[1].ports;
  EXPECT_LT((ports[1].frame.linear().col(0) - kGltfX).norm(), 1e-6);
  EXPECT_LT((ports[1].frame.linear().col(2) - kGltfZ).norm(), 1e-6);
  EXPECT_LT((ports[1].frame.translation() - Eigen::Vector3d(.07, 0, .03)).norm(), 1e-6);
  EXPECT_LT((ports[2].frame.linear().col(0) - kGltfZ).norm(), 1e-6);
  EXPECT_LT((ports[2].frame.linear().col(2) - kGltfX).norm(), 1e-6);
  EXPECT_NEAR(ports[2].frame.linear().determinant(), 1, 1e-9);
}

TEST(GltfParts, PosesAreThoseOfTheNodesInTheWorldOfBlender) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  const Pose& pose = train.read.set.models[0].parts[1].pose;
  const Eigen::Vector3d along(std::cos(.4), std::sin(.4), 0);
  EXPECT_LT((pose.translation() - (Eigen::Vector3d(.3, .2, .1) - .15 * along)).norm(), 1e-9);
  EXPECT_LT((pose.linear().col(0) - along).norm(), 1e-9);
  EXPECT_LT((pose.linear().col(2) - kGltfZ).norm(), 1e-9);
}

TEST(GltfParts, PortsThatMeetAreJoined) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  EXPECT_EQ(
      joints_by_name(train, train.read.set.models[0]),
      (std::vector<std::string>{"0 engine.back - 1 wagon.front", "1 wagon.back - 2 wagon.front",
                                "1 wagon.top - 4 crate.bottom", "2 wagon.back - 3 wagon.front",
                                "2 wagon.top - 5 crate.bottom", "3 wagon.top - 6 barrel.bottom"}));
  for (const Misfit& misfit : joint_misfits(train.read.set.models[0], train.read.set.types)) {
    EXPECT_LT(misfit.translation, 1e-7);
    EXPECT_LT(misfit.angle, 1e-7);
  }
}

TEST(GltfParts, ThePartHasTheMeshesBelowItAndABoxForEach) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  const PartType& engine = train.read.set.types[0];
  EXPECT_EQ(engine.mesh.vertex_count(), 48);
  EXPECT_EQ(engine.mesh.triangle_count(), 24);
  // Chassis .14 x .06 x .04 and boiler .08 x .04 x .04, oriented outward.
  EXPECT_NEAR(signed_volume(engine.mesh.V, engine.mesh.F), 3.36e-4 + 1.28e-4, 1e-9);
  ASSERT_EQ(engine.boxes.size(), 2U);
  EXPECT_LT((engine.boxes[0].half - Eigen::Vector3d(.07, .03, .02)).norm(), 1e-6);
  EXPECT_LT((engine.boxes[1].pose.translation() - Eigen::Vector3d(.02, 0, .07)).norm(), 1e-6);
}

TEST(GltfParts, MeshesOfNoPartAreLeftOutWithAWarning) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  EXPECT_EQ(train.read.warnings.size(), 1U);
  expect_in_text(all_gltf_warnings(train), {"belong to no part: node 'ground'"});
}

TEST(GltfParts, PartsMayHangBelowOneAnother) {
  TouchingBricks scene;
  scene.sample.json["scenes"][0]["nodes"] = {scene.brick};
  scene.node(scene.brick)["children"].push_back(scene.block);
  const GltfParts parts = read_gltf_toy(scene);
  EXPECT_EQ(parts.read.set.models[0].connections.size(), 1U);
  EXPECT_EQ(parts.read.set.types[0].mesh.triangle_count(), 12);
}

TEST(GltfParts, AGroupOfPortsIsNoPart) {
  TouchingBricks scene;
  const int group = scene.add_node("couplers", scene.brick, {0, 0, 0});
  scene.add_port("port.c", group, {0, .1, 0}, kGltfY, kGltfZ);
  const GltfParts parts = read_gltf_toy(scene);
  EXPECT_EQ(parts.read.set.models[0].parts.size(), 2U);
  EXPECT_EQ(parts.read.set.types[0].ports.size(), 2U);
}

TEST(GltfParts, AnEmptyWithMeshesBelowItIsAPart) {
  GltfToyScene scene;
  const int mesh =
      scene.add_box("box", {0, 0, 0}, {.1, .1, .1}, scene.add_material("m", {1, 1, 1}));
  const int part = scene.add_node("house.001", scene.add_node("village", -1, {0, 0, 0}), {1, 0, 0});
  scene.add_node("wall", part, {0, 0, .1}, mesh);
  scene.add_port("port", part, {.1, 0, 0}, kGltfX, kGltfZ);
  const GltfParts parts = read_gltf_toy(scene);
  EXPECT_EQ(parts.read.set.types[0].label, "house");
  EXPECT_EQ(parts.read.set.types[0].ports[0].name, "port");
}

TEST(GltfParts, PortsOfOneNameAreToldApartByTheirPlaces) {
  TouchingBricks scene;
  for (const int part : {scene.brick, scene.block}) scene.node(part)["name"] = "brick";
  scene.node(scene.block)["name"] = "brick.001";
  scene.node(scene.brick_port)["name"] = "port";
  scene.node(scene.block_port)["name"] = "port.002";
  scene.add_port("port.001", scene.brick, {-.1, 0, 0}, -kGltfX, kGltfZ);
  scene.add_port("port.003", scene.block, {.1, 0, 0}, kGltfX, kGltfZ);
  const GltfParts parts = read_gltf_toy(scene);
  EXPECT_EQ(joints_by_name(parts, parts.read.set.models[0]),
            (std::vector<std::string>{"0 brick.port - 1 brick.port-2"}));
}

TEST(GltfParts, ScaleOfAPartBelongsToItsKind) {
  TouchingBricks scene;
  scene.node(scene.brick)["scale"] = {2, 1, .5};  // glTF's axes: y up
  const GltfParts parts = read_gltf_toy(scene);
  const PartType& brick = parts.read.set.types[0];
  EXPECT_LT((brick.boxes[0].half - Eigen::Vector3d(.2, .05, .1)).norm(), 1e-6);
  EXPECT_LT((brick.ports[0].frame.translation() - Eigen::Vector3d(.2, 0, 0)).norm(), 1e-6);
  const GltfParts again =
      read_gltf_parts_bytes(glb_as_bytes(assembly_glb(parts, parts.read.set.models[0])), "again");
  EXPECT_LT((again.read.set.types[0].mesh.V - brick.mesh.V).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(GltfParts, EmptiesThatAreAlmostPortsGetAWarning) {
  TouchingBricks scene;
  scene.add_node("Portal", scene.brick, {0, 0, 0});
  scene.add_node("port.arrow", scene.brick, {0, 0, 0}, 0);
  expect_in_text(all_gltf_warnings(read_gltf_toy(scene)),
                 {"taken for no ports", "node 'Portal', node 'port.arrow'"});
}

TEST(GltfParts, LampsAndHiddenNodesAreNoPorts) {
  TouchingBricks scene;
  const int lamp = scene.add_port("port side light", scene.block, {0, .1, 0}, kGltfY, kGltfZ);
  scene.node(lamp)["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const int hidden = scene.add_port("port.hidden", scene.block, {0, -.1, 0}, -kGltfY, kGltfZ);
  scene.node(hidden)["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_EQ(read_gltf_toy(scene).read.set.types[1].ports.size(), 1U);
}

TEST(GltfParts, PortsThatTouchAndAreNotOpposedGetAWarning) {
  TouchingBricks scene;
  scene.add_port("port.c", scene.block, {-.1, 0, 0}, kGltfY, kGltfZ);
  const GltfParts parts = read_gltf_toy(scene);
  EXPECT_EQ(parts.read.set.models[0].connections.size(), 1U);
  expect_in_text(all_gltf_warnings(parts), {"touch, but their arrows are not opposed", "port 'c'"});
}

TEST(GltfParts, PortsAreJoinedWithinHalfAPercentOfTheSceneAndWarnedOfBeyond) {
  // The box around both bricks has the diagonal sqrt(.4^2 + .2^2 + .2^2) = 0.49 m: 2.45 mm.
  TouchingBricks near;
  near.node(near.block)["translation"] = {.202, 0, 0};
  EXPECT_EQ(read_gltf_toy(near).read.set.models[0].connections.size(), 1U);
  TouchingBricks far;
  far.node(far.block)["translation"] = {.203, 0, 0};
  const GltfParts parts = read_gltf_toy(far);
  EXPECT_TRUE(parts.read.set.models[0].connections.empty());
  expect_in_text(all_gltf_warnings(parts), {"are opposed and over 2.4", "port 'a'", "port 'b'"});
}

TEST(GltfParts, AMeshThatDiffersWithinALabelGetsAWarning) {
  ToyTrain train;
  train.node(train.parts[2])["mesh"] = train.node(train.parts[4])["mesh"];
  expect_in_text(all_gltf_warnings(read_gltf_toy(train)),
                 {"differ within a label", "node 'wagon.001' as node 'wagon'"});
}

TEST(GltfParts, RefusesASceneWithoutParts) {
  GltfToyScene scene;
  scene.add_node("box", -1, {0, 0, 0},
                 scene.add_box("box", {0, 0, 0}, {1, 1, 1}, scene.add_material("m", {1, 1, 1})));
  expect_gltf_refused(scene, {"toy.glb", "no parts", "begin with \"port\""});
}

TEST(GltfParts, RefusesAPortBelowNoPart) {
  TouchingBricks scene;
  scene.add_port("port.lost", -1, {1, 0, 0}, kGltfX, kGltfZ);
  expect_gltf_refused(scene, {"node 'port.lost'", "belongs to no part", "Ctrl+P"});
}

TEST(GltfParts, RefusesAPartWithoutName) {
  TouchingBricks scene;
  scene.node(scene.brick).erase("name");
  expect_gltf_refused(scene, {"node 0", "no name"});
}

TEST(GltfParts, RefusesNodesOfOneLabelWithOtherPorts) {
  ToyTrain moved;
  const int port = moved.node(moved.parts[2])["children"][1];
  moved.node(port)["translation"][0] = .071;
  expect_gltf_refused(
      moved, {"node 'wagon.001'", "its port 'front' is 1 mm and 0 degrees", "node 'wagon'"});
  ToyTrain turned;
  const double half_turn = .5 * std::numbers::pi / 180;
  turned.node(turned.node(turned.parts[5])["children"][0])["rotation"] =
      json({0, std::sin(half_turn), 0, std::cos(half_turn)});
  expect_gltf_refused(turned, {"node 'crate.001'", "degrees from where node 'crate' has it"});
  ToyTrain renamed;
  renamed.node(port)["name"] = "port.prow";
  expect_gltf_refused(renamed, {"node 'wagon.001'", "no port 'front'", "node 'wagon'"});
  ToyTrain more;
  more.add_port("port.side", more.parts[3], {0, .03, .03}, kGltfY, kGltfZ);
  expect_gltf_refused(more, {"node 'wagon.002'", "has 4 ports", "node 'wagon' has 3"});
}

TEST(GltfParts, RefusesNodesOfOneLabelAndTwoScales) {
  ToyTrain train;
  train.node(train.parts[2])["scale"] = {1.1, 1.1, 1.1};
  expect_gltf_refused(train, {"node 'wagon.001'", "another scale than node 'wagon'"});
}

TEST(GltfParts, RefusesMirroredAndShearedParts) {
  TouchingBricks mirrored;
  mirrored.node(mirrored.brick)["scale"] = {-1, 1, 1};
  expect_gltf_refused(mirrored, {"node 'brick'", "mirrored", "Apply, Scale"});
  TouchingBricks flat;
  flat.node(flat.brick)["scale"] = {0, 1, 1};
  expect_gltf_refused(flat, {"node 'brick'", "scaled to nothing"});
  TouchingBricks sheared;
  const int root = sheared.add_node("root", -1, {0, 0, 0});
  sheared.node(root)["scale"] = {2, 1, 1};
  sheared.node(root)["children"] = {sheared.brick};
  sheared.node(sheared.brick)["rotation"] = {0, std::sqrt(.2), 0, std::sqrt(.8)};
  sheared.sample.json["scenes"][0]["nodes"] = {root, sheared.block};
  expect_gltf_refused(sheared, {"node 'brick'", "sheared"});
}

TEST(GltfParts, RefusesThreePortsAtOnePlace) {
  TouchingBricks scene;
  scene.add_port("port.c", scene.add_node("beam", -1, {.1, 0, .5}, 0), {0, 0, -.5}, -kGltfX,
                 kGltfZ);
  expect_gltf_refused(scene, {"three ports meet", "port 'a'", "port 'b'", "port 'c'"});
}

TEST(GltfParts, RefusesJoinedPortsWhoseRollDiffers) {
  for (const Eigen::Vector3d& up : {Eigen::Vector3d(kGltfY), Eigen::Vector3d(-kGltfZ)}) {
    TouchingBricks scene;
    scene.node(scene.block)["children"] = {
        scene.add_port("port.rolled", scene.brick, {-.1, 0, 0}, -kGltfX, up)};
    scene.node(scene.brick)["children"] = {scene.brick_port};
    expect_gltf_refused(scene, {"port 'rolled'", "port 'a'", up.y() > 0 ? "by 90" : "by 180",
                                "arrows' roll", "local Y axes"});
  }
}

TEST(GltfParts, RefusesTwoPartsAtOnePlace) {
  TouchingBricks scene;
  scene.add_port("port.a.001", scene.add_node("brick.001", -1, {0, 0, 0}, 0), {.1, 0, 0}, kGltfX,
                 kGltfZ);
  expect_gltf_refused(scene, {"node 'brick.001'", "at the place of node 'brick'"});
}

TEST(GltfParts, RefusesAPortWithoutDirection) {
  TouchingBricks scene;
  scene.node(scene.brick_port)["scale"] = {0, 0, 0};
  expect_gltf_refused(scene, {"node 'port.a'", "no direction"});
}

TEST(GltfParts, RefusesRequiredCompressionWithTheWayOut) {
  TouchingBricks scene;
  for (const char* key : {"extensionsUsed", "extensionsRequired"})
    scene.sample.json[key] = {"KHR_draco_mesh_compression"};
  expect_gltf_refused(scene, {"KHR_draco_mesh_compression", "gltf-transform"});
}

TEST(GltfParts, RefusesImagesThatAreNotThere) {
  TouchingBricks other;
  other.sample.json["images"] = json::parse(R"([{"uri": "wood.png"}])");
  expect_gltf_refused(other, {"/images/0/uri", "wood.png"});
  TouchingBricks no_image;
  no_image.sample.json["images"] = json::parse(R"([{"uri": "data:image/png;base64,AAAA"}])");
  expect_gltf_refused(no_image, {"/images/0", "no image of a known kind", "PNG"});
  TouchingBricks number;
  number.sample.json["images"] = json::parse(R"([3])");
  expect_gltf_refused(number, {"/images/0", "object"});
}

TEST(GltfParts, TruncatedFilesAreRefused) {
  const std::vector<std::byte> bytes = ToyTrain().bytes();
  for (std::size_t length = 0; length < bytes.size(); length += 64) {
    const std::vector<std::byte> part(bytes.begin(),
                                      bytes.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(read_gltf_parts_bytes(part, "toy.glb"), Error) << length;
  }
}

TEST(GltfScene, AWrittenModelIsReadAsTheSameGraph) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  const Assembly& model = train.read.set.models[0];
  const GltfParts again =
      read_gltf_parts_bytes(glb_as_bytes(assembly_glb(train, model)), "again.glb");
  const Assembly& back = again.read.set.models[0];
  EXPECT_TRUE(again.read.warnings.empty());
  EXPECT_EQ(joints_by_name(again, back), joints_by_name(train, model));
  ASSERT_EQ(back.parts.size(), model.parts.size());
  for (std::size_t i = 0; i < model.parts.size(); ++i)
    EXPECT_LT((back.parts[i].pose.matrix() - model.parts[i].pose.matrix()).norm(), 1e-6);
  for (std::size_t k = 0; k < train.read.set.types.size(); ++k)
    EXPECT_LT((again.read.set.types[k].mesh.V - train.read.set.types[k].mesh.V).norm(), 1e-6);
}

TEST(GltfScene, AVariationHasItsOwnPartsAndGraph) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  Assembly longer = train.read.set.models[0];  // a fourth wagon behind the third, with a crate
  longer.name = "longer";
  longer.parts.insert(longer.parts.end(), {PlacedPart{1}, PlacedPart{2}});
  longer.connections.push_back({{3, 0}, {7, 1}});
  longer.connections.push_back({{7, 2}, {8, 0}});
  place_parts(longer, train.read.set.types);
  const auto bytes = glb_as_bytes(assembly_glb(train, longer));
  const GltfParts again = read_gltf_parts_bytes(bytes, "again.glb");
  EXPECT_EQ(joints_by_name(again, again.read.set.models[0]), joints_by_name(train, longer));
  const GltfCharacter shown = read_gltf_bytes(bytes, "again.glb");
  EXPECT_EQ(shown.mesh.triangle_count(), 12 * (2 + 4 + 3 + 1));
  const json document = gltf_document_of(bytes);
  EXPECT_EQ(document["scenes"][0]["name"], "longer");
  EXPECT_EQ(document["nodes"][static_cast<int>(document["scenes"][0]["nodes"][7])]["name"],
            "wagon.003");
}

TEST(GltfScene, MeshesMaterialsAndTexturesAreThoseOfTheSource) {
  ToyTrain train;
  json& source = train.sample.json;
  source["materials"][1]["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] = .7;
  source["materials"][1]["extras"]["shelf"] = "A3";
  source["extensionsUsed"] = {"KHR_materials_clearcoat"};
  source["samplers"] = json::parse(R"([{"wrapS": 33071}])");
  source["textures"] = json::parse(R"([{"source": 0, "sampler": 0}])");
  source["images"] =
      json::parse(R"([{"name": "grain", "uri": "data:image/png;base64,iVBORw0KGgo="}])");
  const GltfParts parts = read_gltf_toy(train);
  const auto bytes = glb_as_bytes(assembly_glb(parts, parts.read.set.models[0]));
  const json written = gltf_document_of(bytes);
  for (const char* key :
       {"materials", "meshes", "accessors", "textures", "samplers", "extensionsUsed"})
    EXPECT_EQ(written[key], source[key]) << key;
  const json& image = written["images"][0];
  EXPECT_EQ(image["name"], "grain");
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_FALSE(image.contains("uri"));
  const json& view = written["bufferViews"][static_cast<int>(image["bufferView"])];
  const gltf::Container container = gltf::split_container(bytes, "toy.glb");
  EXPECT_EQ(view["byteLength"], 8);
  EXPECT_EQ(container.binary.at(view["byteOffset"].get<std::size_t>() + 1), std::byte{'P'});
  EXPECT_EQ(container.binary.size() % 4, 0U);
}

TEST(GltfScene, NodesOfAPartKeepTheirMeshesAndNames) {
  const ToyTrain train;
  const GltfParts parts = read_gltf_toy(train);
  const json written =
      gltf_document_of(glb_as_bytes(assembly_glb(parts, parts.read.set.models[0])));
  const json& engine = written["nodes"][0];
  EXPECT_EQ(engine["name"], "engine");
  EXPECT_EQ(engine["mesh"], 0);
  ASSERT_EQ(engine["children"].size(), 2U);
  const json& boiler = written["nodes"][static_cast<int>(engine["children"][0])];
  EXPECT_EQ(boiler["name"], "boiler");
  EXPECT_EQ(boiler["mesh"], 1);
  EXPECT_EQ(boiler["translation"], train.sample.json["nodes"][1]["translation"]);
  for (const json& node : written["nodes"]) EXPECT_NE(node["name"], "ground");
}

TEST(GltfScene, WhatMovesOrRefersToNodesIsLeftOutWithAWarning) {
  TouchingBricks scene;
  json& source = scene.sample.json;
  source["cameras"] = json::parse(R"([{"type": "perspective"}])");
  source["skins"] = json::parse(R"([{"joints": [0]}])");
  source["animations"] = json::parse(R"([{"samplers": [], "channels": []}])");
  scene.node(scene.brick)["skin"] = 0;
  scene.node(scene.brick)["extensions"]["MSFT_lod"]["ids"] = {1};
  scene.node(scene.add_node("eye", scene.block, {0, 0, 0}))["camera"] = 0;
  source["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 1;
  const GltfParts parts = read_gltf_toy(scene);
  expect_in_text(all_gltf_warnings(parts), {"left out of what is written", "1 animations",
                                            "1 skins", "1 cameras", "MSFT_lod"});
  const std::string text =
      gltf_document_of(glb_as_bytes(assembly_glb(parts, parts.read.set.models[0]))).dump();
  for (const char* gone : {"\"skin\"", "\"skins\"", "camera\"", "animations", "MSFT_lod", "JOINTS"})
    EXPECT_EQ(text.find(gone), std::string::npos) << gone;
}

class GltfSceneFiles : public test::ScratchFolder {};

TEST_F(GltfSceneFiles, BuffersAndImagesComeIntoTheOneChunk) {
  ToyTrain train;
  json document = train.sample.json;
  document["buffers"] =
      json::array({{{"byteLength", 3}, {"uri", "data:application/octet-stream;base64,AAAA"}},
                   {{"byteLength", train.sample.binary.size()}, {"uri", "train.bin"}}});
  for (json& view : document["bufferViews"]) view["buffer"] = 1;
  document["images"] = json::parse(R"([{"uri": "grain.png"}])");
  write("train.bin", test::text_of(train.sample.binary));
  write("grain.png", "\x89PNG\r\n");
  const GltfParts parts = read_gltf_parts(write("train.gltf", document.dump()));
  EXPECT_EQ(parts.read.files.size(), 3U);
  EXPECT_EQ(parts.read.set.models[0].name, "train");
  const auto bytes = glb_as_bytes(assembly_glb(parts, parts.read.set.models[0]));
  const json written = gltf_document_of(bytes);
  EXPECT_EQ(written["buffers"].size(), 1U);
  EXPECT_FALSE(written["buffers"][0].contains("uri"));
  EXPECT_EQ(read_gltf_parts_bytes(bytes, "a").read.set.models[0].connections.size(), 6U);
}

TEST(GltfScene, RefusesAssembliesThatAreNotOfTheSource) {
  const GltfParts train = read_gltf_toy(ToyTrain());
  Assembly model = train.read.set.models[0];
  model.parts[3].type = 4;
  EXPECT_THROW(assembly_glb(train, model), Error);
  model.parts[3] = {1, Pose(Eigen::Translation3d(std::nan(""), 0, 0))};
  EXPECT_THROW(assembly_glb(train, model), Error);
  EXPECT_THROW(assembly_glb(train, Assembly{}), Error);
}

}  // namespace
}  // namespace geoprior::assembly
