#include "experiments/grammar/files/imported.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "models/grammar/record.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using nlohmann::json;
using test::GltfSample;

/// A tetrahedron with its right angle at `corner` and legs along the axes (glTF's: y up).
int add_tetrahedron(GltfSample& sample, const std::string& name, const Eigen::Vector3f& corner) {
  const float x = corner.x(), y = corner.y(), z = corner.z();
  const auto positions =
      sample.accessor<float>({x, y, z, x + 1, y, z, x, y + 2, z, x, y, z + 3}, "VEC3", 3, 5126);
  const auto corners =
      sample.accessor<std::uint16_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", 1, 5123);
  const json primitive{{"attributes", {{"POSITION", positions}}}, {"indices", corners}};
  sample.json["meshes"].push_back({{"name", name}, {"primitives", json::array({primitive})}});
  return static_cast<int>(sample.json["meshes"].size()) - 1;
}

/// The sample with these nodes, all roots in the scene that no node has as child.
ImportedScene imported_of(GltfSample sample, json nodes, double unit = 1) {
  std::set<int> roots;
  for (int i = 0; i < std::ssize(nodes); ++i) roots.insert(i);
  for (const json& node : nodes)
    if (node.contains("children"))
      for (const json& child : node["children"]) roots.erase(child.get<int>());
  sample.json["nodes"] = std::move(nodes);
  sample.json["scenes"] = json::array({{{"nodes", roots}}});
  return import_gltf_bytes(sample.bytes(), "machine.glb", unit);
}

ImportedScene imported_of(const std::string& nodes, const Eigen::Vector3f& corner = {0, 0, 0},
                          double unit = 1) {
  GltfSample sample;
  add_tetrahedron(sample, "wedge", corner);
  return imported_of(std::move(sample), json::parse(nodes), unit);
}

std::vector<std::string> types_of(const Hierarchy& h) {
  std::vector<std::string> names;
  for (int e = 0; e < h.size(); ++e) names.push_back(h.type(e).name);
  return names;
}

std::vector<std::string> labels_of(const Hierarchy& h) {
  std::vector<std::string> names;
  for (int e = 0; e < h.size(); ++e) names.push_back(h.label(e));
  return names;
}

TEST(GrammarImported, NodesAreElementsNamedByThem) {
  const Hierarchy h = imported_of(R"([
    {"name": "arm", "children": [1, 2, 3, 4, 5, 6]},
    {"name": "Bolt", "mesh": 0}, {"name": "Bolt.003", "mesh": 0}, {"name": "bolt_12", "mesh": 0},
    {"mesh": 0}, {}, {"name": "Bolt", "mesh": 0}])")
                          .hierarchy;
  EXPECT_EQ(types_of(h),
            (std::vector<std::string>{"arm", "Bolt", "Bolt", "bolt", "wedge", "node", "Bolt"}));
  EXPECT_EQ(labels_of(h), (std::vector<std::string>{"arm", "Bolt", "Bolt.003", "bolt_12", "wedge",
                                                    "node", "Bolt-2"}));
  for (int e = 1; e < h.size(); ++e) EXPECT_EQ(h.parent(e), 0);
}

TEST(GrammarImported, SeveralRootsHangOnOne) {
  const Hierarchy h = imported_of(R"([{"name": "a", "children": [2]}, {"name": "b"},
                                      {"name": "c"}])")
                          .hierarchy;
  EXPECT_EQ(types_of(h)[0], "scene");
  ASSERT_EQ(h.size(), 4);
  EXPECT_EQ(h.parent(h.find("a", "test")), 0);
  EXPECT_EQ(h.parent(h.find("b", "test")), 0);
  EXPECT_EQ(h.parent(h.find("c", "test")), h.find("a", "test"));
}

TEST(GrammarImported, ZIsUpAndLengthsAreInMetres) {
  const Hierarchy h =
      imported_of(R"([{"name": "a", "mesh": 0, "translation": [100, 200, 300]}])", {0, 0, 0}, .01)
          .hierarchy;
  EXPECT_LT((h.position(0) - Eigen::Vector3d(1, -3, 2)).norm(), 1e-12);
  EXPECT_LT(h.turn(0).angularDistance(Eigen::Quaterniond::Identity()), 1e-7);
  const Geometry g = geometry_of(h, true);
  EXPECT_LT((g.keys.row(0) - Eigen::RowVector3d(1, -3.03, 2)).norm(), 1e-9);
  EXPECT_LT((g.keys.row(6) - Eigen::RowVector3d(1.01, -3, 2.02)).norm(), 1e-9);
  EXPECT_NEAR(signed_volume(g.surface.V, g.surface.F), 1e-6, 1e-12);
}

TEST(GrammarImported, ScaleShearAndMirrorAreOfTheMesh) {
  const Hierarchy h = imported_of(R"([{"name": "a", "scale": [2, 1, -1], "children": [1]},
      {"name": "b", "mesh": 0, "rotation": [0, 0, 0.6, 0.8]}])")
                          .hierarchy;
  EXPECT_NEAR(h.turn(1).norm(), 1, 1e-12);
  const Geometry g = geometry_of(h, true);
  EXPECT_NEAR(signed_volume(g.surface.V, g.surface.F), 2, 1e-5);
  // The leg along glTF's x, turned to (0.28, 0.96, 0), then scaled.
  EXPECT_LT((g.surface.V.row(1) - g.surface.V.row(0) - Eigen::RowVector3d(.56, 0, .96)).norm(),
            1e-6);
  EXPECT_LT((g.surface.V.row(3) - g.surface.V.row(0) - Eigen::RowVector3d(0, 3, 0)).norm(), 1e-6);
}

TEST(GrammarImported, StretchesScaleTheMeshAndItsBox) {
  Hierarchy h = imported_of(R"([{"name": "a", "mesh": 0}])").hierarchy;
  h.set_parameter(0, h.type(0).parameter("stretch_z"), 3);
  const Geometry g = geometry_of(h, true);
  EXPECT_NEAR(g.surface.V.col(2).maxCoeff(), 6, 1e-9);
  EXPECT_NEAR(g.keys.col(2).maxCoeff(), 6, 1e-9);
  EXPECT_NEAR(g.surface.V.col(0).maxCoeff(), 1, 1e-9);
}

TEST(GrammarImported, OriginsFarFromTheMeshMoveToItsMiddle) {
  const Hierarchy h =
      imported_of(R"([{"name": "a", "mesh": 0, "translation": [1, 0, 0]}])", {10, 20, 30})
          .hierarchy;
  EXPECT_LT((h.position(0) - Eigen::Vector3d(11.5, -31.5, 21)).norm(), 1e-6);
  const Geometry g = geometry_of(h, true);
  EXPECT_LT((g.surface.V.row(0) - Eigen::RowVector3d(11, -30, 20)).norm(), 1e-6);
}

TEST(GrammarImported, MeshesOfOneNameAreVariantsOfOneType) {
  GltfSample sample;
  add_tetrahedron(sample, "one", {0, 0, 0});
  add_tetrahedron(sample, "two", {5, 0, 0});
  const Hierarchy h = imported_of(std::move(sample), json::parse(R"([
    {"name": "part", "children": [1, 2, 3]}, {"name": "part.001", "mesh": 0},
    {"name": "part.002", "mesh": 1}, {"name": "part.003", "mesh": 0, "scale": [2, 2, 2]}])"))
                          .hierarchy;
  ASSERT_EQ(h.types().size(), 1U);
  const int variant = h.type(0).parameter("variant");
  EXPECT_EQ(h.parameter(1, variant), 0);
  EXPECT_EQ(h.parameter(2, variant), 1);
  EXPECT_EQ(h.parameter(3, variant), 2);
  EXPECT_EQ(h.parameter(0, variant), 3);  // no mesh
  const Geometry g = geometry_of(h, true);
  EXPECT_EQ(g.surface.triangle_count(), 12);
  EXPECT_EQ(g.keys.rows(), 32);
  EXPECT_EQ(g.keys.row(0), g.keys.row(7));
}

TEST(GrammarImported, SkinsAndAnimationsAreLeftOutWithAWarning) {
  const ImportedScene scene = import_gltf_bytes(test::skinned_square().bytes(), "square.glb", 1);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("1 skins, 1 animations"), std::string::npos);
  EXPECT_EQ(labels_of(scene.hierarchy), (std::vector<std::string>{"scene", "body", "hip", "knee"}));
}

TEST(GrammarImported, RefusesWhatIsNoScene) {
  const auto refused = [](const std::string& nodes, std::initializer_list<std::string> parts) {
    test::expect_error([&] { imported_of(nodes); }, parts);
  };
  refused("[]", {"machine.glb", "no nodes"});
  refused(R"([{"mesh": 0, "scale": [1e300, 1, 1]}])", {"machine.glb", "/nodes/0", "far away"});
  test::expect_error(
      [] {
        imported_of(R"([{"mesh": 0}])", {NAN, 0, 0});
      },
      {"/meshes/0/primitives/0", "not finite"});
  test::expect_error([] { imported_of(R"([{"mesh": 0}])", {0, 0, 0}, 0); }, {"unit", "above 0"});
  GltfSample cyclic;
  cyclic.json["nodes"] = json::parse(R"([{"children": [1]}, {"children": [0]}])");
  test::expect_error([&] { import_gltf_bytes(cyclic.bytes(), "machine.glb", 1); },
                     {"machine.glb", "cyclic"});
}

}  // namespace
}  // namespace geoprior::grammar
