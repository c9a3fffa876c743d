// The assembly format: what it says, what it refuses and where, and the models that come with it.

#include "experiments/assembly/files/assembly_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using geoprior::test::expect_error;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A rod of 2 m with a port at each end; lines 1 to 6 of a file.
const std::string kRodText =
    "[[part]]\n"
    "label = 'rod'\n"
    "ports = [\n"
    "  { name = 'a', at = [0, 0, 0], out = [-1, 0, 0] },\n"
    "  { name = 'b', at = [2, 0, 0], out = [1, 0, 0] },\n"
    "]\n";

std::string model_text(const std::string& parts, const std::string& joints,
                       const std::string& more = "") {
  return "[[model]]\nname = 'm'\nparts = [" + parts + "]\njoints = [" + joints + "]\n" + more;
}

const std::string kTwoRods = "{ id = 'p', part = 'rod' }, { id = 'q', part = 'rod' }";

ReadAssemblies parse_assembly(const std::string& text) {
  return parse_assembly_file(text, "f.toml", ".", false);
}

void refuse_assembly(const std::string& text, std::initializer_list<std::string> parts) {
  expect_error([&] { parse_assembly(text); }, parts);
}

/// A part whose body is one solid.
PartType part_of_solid(const std::string& solid) {
  return parse_assembly(kRodText + "solids = [{ " + solid + " }]\n").set.types.at(0);
}

/// Whether every edge is crossed once in each direction, corners in one place being one.
bool is_closed_body(const TriMesh& mesh) {
  std::map<std::array<long long, 3>, int> places;
  std::vector<int> place(mesh.vertex_count());
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    std::array<long long, 3> key{};
    for (int k = 0; k < 3; ++k) key[k] = std::llround(mesh.V(i, k) * 1e9);
    place[i] = places.emplace(key, static_cast<int>(places.size())).first->second;
  }
  std::map<std::pair<int, int>, int> edges;
  for (int f = 0; f < mesh.triangle_count(); ++f)
    for (int k = 0; k < 3; ++k) ++edges[{place[mesh.F(f, k)], place[mesh.F(f, (k + 1) % 3)]}];
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto back = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != edges.end() && back->second == 1;
  });
}

double body_volume(const TriMesh& mesh) { return signed_volume(mesh.V, mesh.F); }

TEST(AssemblyFile, PlacesPartsByTheirJoints) {
  const ReadAssemblies read = parse_assembly(
      kRodText +
      model_text(kTwoRods, "'p.b q.a'", "place = [{ part = 'q', at = [0, 0, 3], turn_deg = 90 }]"));
  const Assembly& m = read.set.models.at(0);
  EXPECT_EQ(m.name, "m");
  ASSERT_THAT(m.parts, SizeIs(2));
  EXPECT_LT((m.parts[1].pose * Vector3d(1, 0, 0) - Vector3d(0, 1, 3)).norm(), 1e-12);
  EXPECT_LT((m.parts[0].pose.translation() - Vector3d(0, -2, 3)).norm(), 1e-12);
  for (const Misfit& misfit : joint_misfits(m, read.set.types)) {
    EXPECT_LT(misfit.translation, 1e-12);
    EXPECT_LT(misfit.angle, 1e-12);
  }
}

TEST(AssemblyFile, GivesPortsFramesWithXOutAndZUp) {
  const ReadAssemblies read = parse_assembly(
      "[[part]]\nlabel = 's'\nports = [{ name = 'p', at = [1, 2, 3], out = [0, 0, -2], up = [3, 0, "
      "1] }]");
  const Pose& frame = read.set.types.at(0).ports.at(0).frame;
  EXPECT_LT((frame.translation() - Vector3d(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((frame.linear().col(0) - Vector3d(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((frame.linear().col(2) - Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(frame.linear().determinant(), 1, 1e-15);
}

TEST(AssemblyFile, ReadsJsonWithTheSameKeys) {
  const std::string text = R"({
    "part": [{"label": "rod", "ports": [
      {"name": "a", "at": [0, 0, 0], "out": [-1, 0, 0]},
      {"name": "b", "at": [2, 0, 0], "out": [1, 0, 0]}],
      "ways": [{"from": "a", "points": [[0, 0, 0], [1, 0, 0.5]]}]}],
    "model": [{"name": "m", "parts": [{"id": "p", "part": "rod"}, {"id": "q", "part": "rod"}],
               "joints": ["p.b q.a"]}]})";
  const ReadAssemblies read = parse_assembly_file(text, "f.json", ".", true);
  EXPECT_LT((read.set.models.at(0).parts[1].pose.translation() - Vector3d(2, 0, 0)).norm(), 1e-12);
  const Way& way = read.set.types.at(0).ways.at(0);
  EXPECT_EQ(way.from, 0);
  EXPECT_EQ(way.to, Way::kInside);
  EXPECT_EQ(way.points.at(1), Vector3d(1, 0, 0.5));
}

TEST(AssemblyFile, NamesThePointerOfAJsonValue) {
  const auto json = [](const std::string& text) { parse_assembly_file(text, "f.json", ".", true); };
  expect_error([&] { json(R"({"part": [{"label": "x", "ports": [{"name": 3}]}]})"); },
               {"f.json: /part/0/ports/0/name"});
  expect_error([&] { json(R"({"a/b~": null})"); }, {"f.json: /a~1b~0", "is null"});
  expect_error([&] { json("[1"); }, {"f.json, byte", "no valid JSON"});
}

TEST(AssemblyFile, AllowsAModelInPiecesThatHavePlaces) {
  const std::string places =
      "place = [{ part = 'q', at = [0, 5, 0] }, { part = 'p', at = [1, 0, 0] }]";
  const ReadAssemblies read = parse_assembly(kRodText + model_text(kTwoRods, "", places));
  EXPECT_EQ(components(read.set.models[0]).count, 2);
  EXPECT_EQ(read.set.models[0].parts[1].pose.translation(), Vector3d(0, 5, 0));
  refuse_assembly(kRodText + model_text(kTwoRods, ""),
                  {"f.toml:7:", "not in one piece", "'p'", "place"});
  refuse_assembly(kRodText + model_text(kTwoRods, "", "place = [{ part = 'p' }]"),
                  {"f.toml:11:1: place", "not in one piece", "'q'"});
  refuse_assembly(
      kRodText + model_text(kTwoRods, "'p.b q.a'", "place = [{ part = 'p' }, { part = 'q' }]"),
      {"f.toml:11:", "'q' hangs together with another part that has a place"});
}

TEST(AssemblyFile, RefusesALabelWithoutPorts) {
  refuse_assembly("[[part]]\nlabel = 'stone'\n", {"f.toml:1:", "'stone' is a label without ports"});
  refuse_assembly("[[part]]\nlabel = 'stone'\nports = []\n", {"f.toml:3:1", "without ports"});
}

TEST(AssemblyFile, RefusesJointsThatNameNothing) {
  refuse_assembly(kRodText + model_text(kTwoRods, "'p.b q.c'"),
                  {"f.toml:10:11", "part 'rod' has no port 'c'", "allowed: a, b"});
  refuse_assembly(kRodText + model_text(kTwoRods, "'p.b r.a'"),
                  {"f.toml:10:11", "no part 'r'", "allowed: p, q"});
  for (const char* joint : {"p.b", "p.b q.a q.b", "", "pb q.a", "p.b-q.a"})
    refuse_assembly(kRodText + model_text(kTwoRods, "'" + std::string(joint) + "'"),
                    {"f.toml:10:11", "id.port id.port"});
}

TEST(AssemblyFile, RefusesAPortThatIsUsedTwice) {
  const std::string three = kTwoRods + ", { id = 'r', part = 'rod' }";
  refuse_assembly(kRodText + model_text(three, "'p.b q.a', 'p.b r.a'"),
                  {"f.toml:10:22", "port 'p.b' is used twice", "p.b q.a"});
  refuse_assembly(kRodText + model_text(kTwoRods, "'p.b p.b'"),
                  {"f.toml:10:11", "port 'p.b' is used twice"});
}

TEST(AssemblyFile, RefusesTwoPartsOnOnePlace) {
  const std::string places = "place = [{ part = 'p' }, { part = 'q' }]";
  refuse_assembly(kRodText + model_text(kTwoRods, "", places),
                  {"f.toml:7:", "is on the place of", "part 1 'rod'"});
}

TEST(AssemblyFile, RefusesNamesThatAreTaken) {
  refuse_assembly(kRodText + kRodText,
                  {"f.toml:8:1", "'rod' is the label of another part", "f.toml:2:1"});
  refuse_assembly(
      kRodText + model_text("{ id = 'p', part = 'rod' }, { id = 'p', part = 'rod' }", ""),
      {"f.toml:9:", "'p' is the id of another part"});
  const std::string one = model_text("{ id = 'p', part = 'rod' }", "");
  refuse_assembly(kRodText + one + one,
                  {"f.toml:12:1", "'m' is the name of another model", "f.toml:8:1"});
  refuse_assembly(
      "[[part]]\nlabel = 'x'\nports = [{ name = 'a', at = [0, 0, 0], out = [1, 0, 0] },\n"
      "{ name = 'a', at = [0, 0, 1], out = [1, 0, 0] }]",
      {"f.toml:4:1", "'a' is the name of another port"});
}

TEST(AssemblyFile, RefusesNamesThatAreNone) {
  refuse_assembly("[[part]]\nlabel = 'a b'\nports = []\n", {"f.toml:2:1", "a b"});
  refuse_assembly(kRodText + model_text("{ id = 'p.q', part = 'rod' }", ""), {"f.toml:9:", "p.q"});
  refuse_assembly(kRodText + model_text("{ id = 'p', part = 'rods' }", ""),
                  {"f.toml:9:", "no part with the label 'rods'", "did you mean 'rod'?"});
}

TEST(AssemblyFile, RefusesUnknownKeysAndWrongValues) {
  refuse_assembly(kRodText + "colour = 'red'\n", {"f.toml:7:1: part.0.colour", "unknown key"});
  refuse_assembly("parts = 3\n", {"f.toml:1:1: parts", "unknown key", "did you mean 'part'?"});
  refuse_assembly("part = 3\n", {"f.toml:1:1: part", "is an integer"});
  refuse_assembly(
      "[[part]]\nlabel = 'x'\nports = [{ name = 'a', at = [0, nan, 0], out = [1, 0, 0] }]",
      {"f.toml:3:", "is not finite"});
  refuse_assembly(
      "[[part]]\nlabel = 'x'\nports = [{ name = 'a', at = [0, 0, 0], out = [0, 0, 1] }]",
      {"f.toml:3:", "port 'a' has no frame", "'out' and 'up'"});
  refuse_assembly(kRodText + "ways = [{ points = [[0, 0], [1, 0]] }]",
                  {"f.toml:7:", "no point", "[[x, y, z], …]"});
  refuse_assembly(kRodText + "ways = [{ points = [[0, 0, inf], [1, 0, 0]] }]",
                  {"f.toml:7:", "is not finite"});
  refuse_assembly(kRodText + "solids = [{ kind = 'cube' }]",
                  {"f.toml:7:", "unknown choice 'cube'", "box"});
  refuse_assembly(kRodText + model_text("", ""), {"f.toml:9:1", "'m' has no parts"});
  refuse_assembly("", {"f.toml", "has no parts"});
}

TEST(AssemblyFile, RefusesAWayBesideItsPort) {
  refuse_assembly(kRodText + "ways = [{ from = 'a', to = 'b', points = [[0, 0, 0], [1.9, 0, 0]] }]",
                  {"f.toml:7:", "0.1", "off its port 'b'"});
  refuse_assembly(kRodText + "ways = [{ from = 'c', points = [[0, 0, 0], [1, 0, 0]] }]",
                  {"no port 'c'"});
  refuse_assembly(kRodText + "ways = [{ points = [[0, 0, 0]] }]",
                  {"f.toml:7:", "a way of 1 points"});
}

TEST(AssemblyFile, ChecksSymmetries) {
  const ReadAssemblies read = parse_assembly(kRodText + "symmetries = ['b a']\n");
  const Symmetry& turn = read.set.types.at(0).symmetries.at(0);
  EXPECT_THAT(turn.ports, ElementsAre(1, 0));
  EXPECT_LT((turn.motion * Vector3d(0.5, 1, 1) - Vector3d(1.5, -1, 1)).norm(), 1e-12);
  EXPECT_THAT(parse_assembly(kRodText).set.types.at(0).symmetries, IsEmpty());
  refuse_assembly(kRodText + "symmetries = ['a b']\n", {"f.toml:7:15", "moves nothing"});
  refuse_assembly(kRodText + "symmetries = ['b b']\n", {"f.toml:7:15", "no permutation", "a b"});
  refuse_assembly(kRodText + "symmetries = ['b']\n", {"f.toml:7:15", "no permutation"});
  refuse_assembly(
      "[[part]]\nlabel = 'x'\nports = [{ name = 'a', at = [0, 0, 0], out = [-1, 0, 0] },\n"
      "{ name = 'b', at = [2, 0, 0], out = [0, 1, 0] }]\nsymmetries = ['b a']\n",
      {"f.toml:5:15", "no rigid motion"});
}

TEST(AssemblyFile, RefusesSymmetriesThatAreNoGroup) {
  const std::string star =
      "[[part]]\nlabel = 'x'\nports = [{ name = 'e', at = [1, 0, 0], out = [1, 0, 0] },\n"
      "{ name = 'n', at = [0, 1, 0], out = [0, 1, 0] }, { name = 'w', at = [-1, 0, 0], out = [-1, "
      "0, 0] },\n"
      "{ name = 's', at = [0, -1, 0], out = [0, -1, 0] }]\n";
  EXPECT_THAT(parse_assembly(star + "symmetries = ['n w s e', 'w s e n', 's e n w']")
                  .set.types[0]
                  .symmetries,
              SizeIs(3));
  refuse_assembly(star + "symmetries = ['w s e n', 'w s e n']", {"f.toml:6:1", "twice"});
  refuse_assembly(star + "symmetries = ['n w s e']", {"f.toml:6:1", "none of them", "w s e n"});
}

class AssemblyFiles : public geoprior::test::ScratchFolder {};

TEST_F(AssemblyFiles, AreIncludedOnce) {
  write("rod.toml", kRodText);
  write("more/more.toml", "include = ['../rod.toml']\n");
  const ReadAssemblies read = read_assembly_file(write(
      "m.toml", "include = ['rod.toml', 'more/more.toml']\n" + model_text(kTwoRods, "'p.b q.a'")));
  EXPECT_THAT(read.set.types, SizeIs(1));
  EXPECT_THAT(read.set.models, SizeIs(1));
  std::vector<std::string> names;
  for (const fs::path& file : read.files) names.push_back(file.filename().string());
  EXPECT_THAT(names, ElementsAre("m.toml", "rod.toml", "more.toml"));
}

TEST_F(AssemblyFiles, AreRefusedInACircle) {
  write("a.toml", "include = ['b.toml']\n" + kRodText);
  write("b.toml", "\ninclude = ['c.toml']\n");
  write("c.toml", "\n\ninclude = ['b.toml']\n");
  expect_error([&] { read_assembly_file(folder() / "a.toml"); },
               {"c.toml:3:12", "includes itself: b.toml -> c.toml -> b.toml"});
}

TEST_F(AssemblyFiles, ThatAreNotThereAreNamed) {
  const fs::path part = write("m.toml", kRodText + "mesh = 'none.ply'\n");
  expect_error([&] { read_assembly_file(part); }, {"m.toml:7:1: mesh", "none.ply"});
  const fs::path including = write("i.toml", "include = ['none.toml']\n");
  expect_error([&] { read_assembly_file(including); }, {"i.toml:1:12", "none.toml"});
  expect_error([&] { read_assembly_file(folder() / "m.ini"); }, {"m.ini", ".toml, .json"});
  const fs::path odd = write("o.toml", "include = ['" + std::string(5000, 'x') + ".toml']\n");
  expect_error([&] { read_assembly_file(odd); }, {"o.toml:1:12"});
}

TEST_F(AssemblyFiles, MayNameMeshes) {
  write("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 4 0\n3 0 1 2\n");
  const ReadAssemblies read = read_assembly_file(write(
      "m.toml", kRodText + "mesh = 't.off'\nsolids = [{ kind = 'box', size = [1, 1, 1] }]\n"));
  const PartType& type = read.set.types.at(0);
  EXPECT_EQ(type.mesh.triangle_count(), 1 + 12);
  ASSERT_THAT(type.boxes, SizeIs(2));
  EXPECT_LT((type.boxes[0].half - Vector3d(0.5, 2, 0)).norm(), 1e-15);
  EXPECT_THAT(read.files, SizeIs(2));
}

TEST(AssemblySolids, AreClosedAndOutward) {
  // Volumes of the polyhedra: a turned outline has 48 sides.
  const double sides = 24 * std::sin(2 * std::numbers::pi / 48);
  const std::vector<std::pair<std::string, double>> cases{
      {"kind = 'box', size = [1, 2, 3]", 6},
      {"kind = 'cylinder', radius = 2, length = 3", sides * 4 * 3},
      {"kind = 'cylinder', radius = 2, top_radius = 0, length = 3", sides * 4},
      {"kind = 'lathe', outline = [[1, 0], [1, 2], [2, 2], [2, 0]]", sides * (4 - 1) * 2},
      {"kind = 'prism', outline = [[0, 0], [2, 0], [0, 2]], height = 3, turn_deg = [20, 30, 40]",
       6},
      {"kind = 'prism', outline = [[0, 0], [0, 2], [1, 0.5], [2, 0]], height = 2", 3},
      {"kind = 'rail', width = 1, height = 2, points = [[0, 0, 0], [3, 0, 1]]", 6},
      {"kind = 'rail', width = 1, height = 1, points = [[0, 0, 0], [3, 0, 0], [3, 3, 0]]", 6}};
  for (const auto& [solid, expected] : cases) {
    const PartType part = part_of_solid(solid);
    EXPECT_TRUE(is_closed_body(part.mesh)) << solid;
    EXPECT_NEAR(body_volume(part.mesh), expected, 1e-9) << solid;
  }
}

TEST(AssemblySolids, AreClosedWhereTheyAreRound) {
  const double ball = 4 * std::numbers::pi / 3;
  const PartType sphere = part_of_solid("kind = 'sphere', radius = 1");
  EXPECT_TRUE(is_closed_body(sphere.mesh));
  EXPECT_NEAR(body_volume(sphere.mesh), ball, 0.01 * ball);
  for (const std::string solid :
       {"kind = 'box', size = [1, 2, 3], round = 0.1",
        "kind = 'cylinder', radius = 1, length = 2, round = 0.2",
        "kind = 'cylinder', radius = 1, top_radius = 0.5, length = 2, round = 0.2",
        "kind = 'prism', outline = [[0, 0], [2, 0], [0, 2]], height = 3, round = 0.2",
        "kind = 'rail', width = 1, height = 1, round = 0.1, points = [[0, 0, 0], [3, 0, 1]]",
        "kind = 'channel', width = 1, depth = 1, wall = 0.1, round = 0.02, points = [[0, 0, 0], "
        "[3, 0, 1]]",
        "kind = 'channel', width = 1, depth = 0.3, wall = 0.1, points = [[0, 0, 0], [3, 0, 0], [4, "
        "4, 0]]"}) {
    const PartType part = part_of_solid(solid);
    EXPECT_TRUE(is_closed_body(part.mesh)) << solid;
    EXPECT_GT(body_volume(part.mesh), 0) << solid;
  }
}

TEST(AssemblySolids, SplitVerticesAtSharpEdgesOnly) {
  const Eigen::MatrixX3d sphere_normals =
      vertex_normals(part_of_solid("kind = 'sphere', radius = 1").mesh);
  const TriMesh sphere = part_of_solid("kind = 'sphere', radius = 1").mesh;
  for (int i = 0; i < sphere.vertex_count(); ++i)
    EXPECT_GT(sphere_normals.row(i).dot(sphere.V.row(i)), 0.99);
  const TriMesh box = part_of_solid("kind = 'box', size = [1, 2, 3]").mesh;
  const Eigen::MatrixX3d normals = vertex_normals(box);
  for (int i = 0; i < box.vertex_count(); ++i)
    EXPECT_NEAR(normals.row(i).cwiseAbs().maxCoeff(), 1, 1e-12);
}

TEST(AssemblySolids, HaveABoxForEachStraightSegment) {
  const PartType rail = part_of_solid(
      "kind = 'rail', width = 2, height = 1, points = [[0, 0, 0], [2, 0, 0], [5, 0, 0], [5, 4, "
      "0]]");
  ASSERT_THAT(rail.boxes, SizeIs(2));
  // Mitred, the first segment reaches one half width beyond the corner.
  EXPECT_LT((rail.boxes[0].half - Vector3d(3, 1, 0.5)).norm(), 1e-12);
  EXPECT_LT((rail.boxes[0].pose.translation() - Vector3d(3, 0, 0.5)).norm(), 1e-12);
  const PartType steep =
      part_of_solid("kind = 'rail', width = 1, height = 0.1, points = [[0, 0, 0], [3, 0, 3]]");
  ASSERT_THAT(steep.boxes, SizeIs(1));
  EXPECT_LT(steep.boxes[0].half.z(), 0.05) << "along the slope";
  EXPECT_LT((part_of_solid("kind = 'cylinder', radius = 1, length = 4").boxes.at(0).half -
             Vector3d(1, 1, 2))
                .norm(),
            1e-12);
}

TEST(AssemblySolids, FollowTheWaysOfTheirPart) {
  const PartType part =
      parse_assembly(kRodText +
                     "ways = [{ from = 'a', to = 'b', points = [[0, 0, 0], [2, 0, 0]] }]\n"
                     "solids = [{ kind = 'rail', width = 0.5, height = 1, offset = 3 }]\n")
          .set.types.at(0);
  EXPECT_NEAR(body_volume(part.mesh), 1, 1e-12);
  EXPECT_NEAR(part.mesh.V.col(1).minCoeff(), 2.75, 1e-12);
  refuse_assembly(kRodText + "solids = [{ kind = 'rail', width = 0.5, height = 1 }]\n",
                  {"f.toml:7:", "'points'"});
}

TEST(AssemblySolids, AreRefusedWithSizesThatDoNotFit) {
  const auto refuse_solid = [](const std::string& solid, const std::string& problem) {
    refuse_assembly(kRodText + "solids = [{ " + solid + " }]\n", {"f.toml:7:", problem});
  };
  refuse_solid("kind = 'box', size = [1, 0, 1]", "has no size");
  refuse_solid("kind = 'box', size = [1, 2, 3], round = 0.5", "half of its smallest side");
  refuse_solid("kind = 'cylinder', radius = 1, length = 1, round = 0.6", "rounded by more");
  refuse_solid("kind = 'cylinder', radius = 1, length = 1, top_radius = 0, round = 0.1", "tip");
  refuse_solid("kind = 'sphere', radius = -1", "out of range");
  refuse_solid("kind = 'lathe', outline = [[-1, 0], [1, 0], [1, 1]]", "radii of at least 0");
  refuse_solid("kind = 'lathe', outline = [[0, 0], [1, 0]]", "encloses nothing");
  refuse_solid("kind = 'sphere', radius = 1e7", "out of range");
  refuse_solid("kind = 'prism', height = 1, outline = [[0, 0], [2, 2], [2, 0], [0, 1]]", "cross");
  refuse_solid("kind = 'rail', width = 1, height = 1, points = [[0, 0, 0]]", "two points");
  refuse_solid("kind = 'rail', width = 1, height = 1, points = [[0, 0, 0], [0, 0, 1]]", "upright");
  refuse_solid("kind = 'rail', width = 1, height = 1, points = [[0, 0, 0], [1, 0, 0], [0, 0.1, 0]]",
               "too sharp");
}

TEST(AssemblyFile, ListsItsKeys) {
  std::set<std::string> keys;
  for (const OptionRow& row : assembly_keys().keys) keys.insert(row.key);
  for (const char* key : {"include", "part[].ports[].up", "part[].solids[].wall", "part[].mesh",
                          "model[].joints", "model[].place[].turn_deg"})
    EXPECT_TRUE(keys.contains(key)) << key;
}

ReadAssemblies own_assembly_file(const std::string& name) {
  return read_assembly_file(fs::path(GEOPRIOR_SOURCE_DIR) / "experiments/assembly/models" /
                            (name + ".assembly.toml"));
}

double lowest_vertex(const PartType& type, const Pose& pose) {
  return (type.mesh.V * pose.linear().transpose()).col(2).minCoeff() + pose.translation().z();
}

struct OwnAssemblyModels {
  const char* file;
  std::vector<std::string> grounded;  ///< labels that stand on the floor
};

const std::vector<OwnAssemblyModels>& own_assembly_models() {
  static const std::vector<OwnAssemblyModels> kModels{
      {"marble-run",
       {"pillar-1", "pillar-2", "pillar-3", "pillar-4", "pillar-5", "pillar-6", "pillar-7",
        "pillar-8", "basin"}},
      {"rolling-toys", {"wheel-small", "wheel-big"}},
      {"playground", {"legs", "slide", "ladder", "gangway", "swing"}},
      {"brick-track", {"straight", "curve", "switch-left", "switch-right", "crossing"}}};
  return kModels;
}

TEST(AssemblyModels, CloseAndStandOnTheFloor) {
  for (const auto& [file, grounded] : own_assembly_models()) {
    const ReadAssemblies read = own_assembly_file(file);
    EXPECT_THAT(read.warnings, IsEmpty());
    for (const Assembly& m : read.set.models) {
      EXPECT_EQ(components(m).count, 1) << m.name;
      for (const Misfit& misfit : joint_misfits(m, read.set.types)) {
        EXPECT_LT(misfit.translation, 1e-9) << m.name;
        EXPECT_LT(misfit.angle, 1e-9) << m.name;
      }
      for (const PlacedPart& part : m.parts) {
        const PartType& type = read.set.types[part.type];
        const double z = lowest_vertex(type, part.pose);
        if (std::find(grounded.begin(), grounded.end(), type.label) != grounded.end()) {
          EXPECT_NEAR(z, 0, 1e-9) << m.name << " " << type.label;
        } else {
          EXPECT_GT(z, 1e-3) << m.name << " " << type.label;
        }
      }
    }
  }
}

TEST(AssemblyModels, OfTracksHaveLoops) {
  const std::map<std::string, int> loops{{"playground", 2}, {"brick-track", 3}, {"marble-run", 0}};
  for (const auto& [name, count] : loops) {
    const Assembly m = own_assembly_file(name).set.models.at(0);
    EXPECT_EQ(static_cast<int>(m.connections.size()) - static_cast<int>(m.parts.size()) + 1, count)
        << name;
  }
}

TEST(AssemblyModels, LetNoBallRise) {
  for (const PartType& type : own_assembly_file("marble-run").set.types)
    for (const Way& way : type.ways)
      for (std::size_t i = 0; i + 1 < way.points.size(); ++i)
        EXPECT_LE(way.points[i + 1].z(), way.points[i].z()) << type.label << " point " << i + 1;
}

}  // namespace
}  // namespace geoprior::assembly
