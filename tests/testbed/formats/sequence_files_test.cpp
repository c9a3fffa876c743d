// Sequences of meshes from files: what is found, what is repaired, what is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "core/geometry/topology.h"
#include "testbed/formats/sequence/files.h"
#include "testbed/formats/sequence/mesh_sequence.h"
#include "testbed/formats/sequence/repair.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/options/toml.h"
#include "testbed/view/mesh_text.h"
#include "tests/testbed/formats/octahedron.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::expect_error;
using test::octahedron;

Part part_of(const TriMesh& mesh) {
  Part part;
  part.points = mesh.V;
  part.triangles = mesh.F;
  return part;
}

std::string numbered(const char* pattern, int number) {
  std::array<char, 64> name{};
  std::snprintf(name.data(), name.size(), pattern, number);
  return name.data();
}

class SequenceFiles : public test::ScratchFolder {
 protected:
  void write_obj(const std::string& name, const TriMesh& mesh) const {
    write(name, part_to_obj(part_of(mesh), "test"));
  }
  void write_vtp(const std::string& name, const TriMesh& mesh, double time) const {
    write(name, part_to_vtk_xml(part_of(mesh), time));
  }
  /// Octahedra of radius 1, 2, … under these numbers.
  void write_objs(const char* pattern, const std::vector<int>& numbers) const {
    double radius = 1;
    for (const int n : numbers) write_obj(numbered(pattern, n), octahedron(radius++));
  }
  std::shared_ptr<SurfaceSequence> open(const std::string& path) {
    SequenceOptions options;
    options.path = path;
    return open(options);
  }
  std::shared_ptr<SurfaceSequence> open(const SequenceOptions& options) {
    warnings.clear();
    inputs.clear();
    return open_sequence(options, folder(), warnings, inputs);
  }
  [[nodiscard]] bool warned(const std::string& part) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
      return warning.find(part) != std::string::npos;
    });
  }

  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> inputs;
};

TEST_F(SequenceFiles, NumberedFilesAreFramesAtTheRate) {
  write_objs("drop_%04d.obj", {1, 2, 3});
  write("drop_0001.mtl", "");
  write_obj("drop_00004.obj", octahedron());  // five digits with a leading zero: another sequence
  SequenceOptions options;
  options.path = "drop_%04d.obj";
  options.frames_per_second = 50;
  options.start = 2;
  const auto sequence = open(options);
  ASSERT_EQ(sequence->frame_count(), 3);
  EXPECT_DOUBLE_EQ(sequence->time(0), 2);
  EXPECT_DOUBLE_EQ(sequence->time(2), 2.04);
  EXPECT_NEAR(signed_volume(sequence->frame(1).mesh.V, sequence->frame(1).mesh.F), 4. / 3 * 8,
              1e-12);
  EXPECT_EQ(sequence->frame(2).time, sequence->time(2));
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  EXPECT_EQ(inputs.size(), 3U);
}

TEST_F(SequenceFiles, NumbersMayStartAtZeroAndTopologyMayChange) {
  write_obj("a_0000.obj", octahedron());
  TriMesh triangle{Eigen::MatrixX3d(3, 3), Eigen::MatrixX3i(1, 3)};
  triangle.V << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  triangle.F << 0, 1, 2;
  write_obj("a_0001.obj", triangle);
  const auto sequence = open("a_%04d.obj");
  EXPECT_DOUBLE_EQ(sequence->time(0), 0);
  EXPECT_DOUBLE_EQ(sequence->time(1), 0.04);
  EXPECT_TRUE(warned("25 frames a second are assumed"));
  EXPECT_EQ(sequence->frame(0).mesh.vertex_count(), 6);
  EXPECT_EQ(sequence->frame(1).mesh.vertex_count(), 3);
}

// C's "%04d" counts the sign, Blender does not; "-" alone is a hyphen.
TEST_F(SequenceFiles, NumbersMayBeBelowZero) {
  write_objs("a_%d.obj", {-2, -1, 0, 1, 2});
  const auto sequence = open("a_%d.obj");
  ASSERT_EQ(sequence->frame_count(), 5);
  EXPECT_NEAR(sequence->frame(0).mesh.V.maxCoeff(), 1, 1e-12) << "-2 comes first";
  EXPECT_NEAR(sequence->time(4), 4 / 25.0, 1e-15);
  SequenceOptions options;
  options.path = "a_%d.obj";
  options.first = -1;
  options.last = 0;
  EXPECT_EQ(open(options)->frame_count(), 2);
  write_objs("in/b_%04d.obj", {-12, 0, 1});
  EXPECT_EQ(open("in/b_%04d.obj")->frame_count(), 3);
  EXPECT_EQ(open("in")->frame_count(), 3);
  write_obj("blender/c_-0001.obj", octahedron(1));
  write_obj("blender/c_0000.obj", octahedron(2));
  EXPECT_EQ(open("blender/c_%04d.obj")->frame_count(), 2);
  EXPECT_NEAR(open("blender")->frame(0).mesh.V.maxCoeff(), 1, 1e-12);
  write_obj("blender/c_-001.obj", octahedron(3));
  expect_error([&] { open("blender/c_%04d.obj"); }, {"c_-001.obj", "same number as c_-0001.obj"});
  write_objs("hyphen/d-%d.obj", {1, 2, 3});
  EXPECT_NEAR(open("hyphen")->frame(0).mesh.V.maxCoeff(), 1, 1e-12) << "1 comes first";
}

TEST_F(SequenceFiles, MissingFramesLeaveAGapInTimeAndAreReported) {
  write_objs("a_%d.obj", {1, 2, 4, 8, 9});
  const auto sequence = open("a_%d.obj");
  ASSERT_EQ(sequence->frame_count(), 5);
  EXPECT_NEAR(sequence->time(3), 7 / 25.0, 1e-15);
  EXPECT_TRUE(warned("frames are missing: 3, 5 to 7"));
}

TEST_F(SequenceFiles, NumbersInStepsMissNothing) {
  write_objs("a_%03d.obj", {0, 5, 10, 15});
  EXPECT_NEAR(open("a_%03d.obj")->time(3), 15 / 25.0, 1e-15);
  EXPECT_FALSE(warned("missing"));
}

TEST_F(SequenceFiles, FirstAndLastCutTheSequence) {
  write_objs("a_%04d.obj", {1, 2, 3, 4, 5});
  SequenceOptions options;
  options.path = "a_%04d.obj";
  options.first = 2;
  options.last = 3;
  const auto sequence = open(options);
  ASSERT_EQ(sequence->frame_count(), 2);
  EXPECT_EQ(sequence->time(0), 0);
  options.first = 9;
  options.last = 12;
  expect_error([&] { open(options); }, {"no frame between first and last", "1 to 5"});
}

TEST_F(SequenceFiles, SidecarSaysRateAxisScaleAndStart) {
  TriMesh mesh = octahedron(1, {0, 100, 0});  // y up, centimetres
  mesh.V(2, 1) += 50;
  write_obj("a_0001.obj", mesh);
  write_obj("a_0002.obj", mesh);
  write("a_%04d.obj.json", R"({"frames_per_second": 10, "up": "y", "scale": 0.01, "start": 1.5})");
  const auto sequence = open("a_%04d.obj");
  EXPECT_DOUBLE_EQ(sequence->time(1), 1.6);
  const SurfaceFrame frame = sequence->frame(0);
  EXPECT_NEAR(frame.mesh.V(2, 2), 1.51, 1e-12);   // the highest point
  EXPECT_NEAR(frame.mesh.V(4, 1), -0.01, 1e-12);  // z of the file is -y
  EXPECT_GT(signed_volume(frame.mesh.V, frame.mesh.F), 0);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(inputs.size(), 3U);
  SequenceOptions own;  // options come before the sidecar
  own.path = "a_%04d.obj";
  own.up = UpAxis::z;
  own.scale = 1;
  own.frames_per_second = 100;
  EXPECT_DOUBLE_EQ(open(own)->time(1), 1.51);
  EXPECT_EQ(open(own)->frame(0).mesh.V, mesh.V);
}

TEST_F(SequenceFiles, SidecarMistakesAreNamed) {
  write_objs("a_%04d.obj", {1, 2});
  const auto refused = [&](const std::string& sidecar, std::initializer_list<std::string> parts) {
    write("a_%04d.obj.json", sidecar);
    expect_error([&] { open("a_%04d.obj"); }, parts);
  };
  refused("{\"fps\": 24}", {"a_%04d.obj.json", "\"fps\"", "frames_per_second"});
  refused("{\"frames_per_second\": -1}", {"frames_per_second", "positive"});
  refused("{\"up\": \"x\"}", {"up", "\"y\", \"z\""});
  refused("{\"scale\": \"cm\"}", {"scale"});
  refused("{\"scale\": 1", {"byte", "no valid JSON"});
  refused("[1]", {"no JSON object"});
}

TEST_F(SequenceFiles, VelocitiesFollowAxisAndScale) {
  Part part = part_of(octahedron());
  part.arrays.push_back(
      {"velocity", "m/s", NamedArray::On::points, Eigen::RowVector3d(1, 2, 3).replicate(6, 1)});
  write("a_0001.ply", part_to_ply(part, ""));
  SequenceOptions options;
  options.path = "a_%04d.ply";
  options.up = UpAxis::y;
  options.scale = 10;
  const SurfaceFrame frame = open(options)->frame(0);
  ASSERT_EQ(frame.velocity.rows(), 6);
  EXPECT_EQ(frame.velocity.row(5), Eigen::RowVector3d(10, -30, 20));
}

TEST_F(SequenceFiles, FolderOfARunTakesItsPartAndTimes) {
  for (int i = 0; i < 3; ++i) {
    write_vtp(numbered("run/flip/surface_%04d.vtp", i), octahedron(1 + i), 0.1 * i);
    write_vtp(numbered("run/flip/solids_%04d.vtp", i), octahedron(9), 0.1 * i);
  }
  const auto by_time_value = open("run/flip");
  ASSERT_EQ(by_time_value->frame_count(), 3);
  EXPECT_DOUBLE_EQ(by_time_value->time(2), 0.2);
  EXPECT_NEAR(by_time_value->frame(2).mesh.V.maxCoeff(), 3, 1e-12);
  EXPECT_TRUE(warnings.empty());
  std::vector<PvdEntry> entries;
  for (int i = 0; i < 3; ++i) {
    entries.push_back({0.5 * i, numbered("flip/surface_%04d.vtp", i), "surface"});
    entries.push_back({0.5 * i, numbered("flip/solids_%04d.vtp", i), "solids"});
  }
  write("run/flip.pvd", pvd_text(entries));
  EXPECT_DOUBLE_EQ(open("run/flip")->time(2), 1);
  EXPECT_DOUBLE_EQ(open((folder() / "run/flip/").string())->time(2), 1);
  SequenceOptions options;
  options.path = "run/flip";
  options.part = "solids";
  EXPECT_NEAR(open(options)->frame(0).mesh.V.maxCoeff(), 9, 1e-12);
  options.part = "foam";
  expect_error([&] { open(options); }, {"run/flip", "'foam'", "surface_%04d.vtp"});
  options.part = "surface";
  options.path = "run/flip.pvd";
  EXPECT_EQ(open(options)->frame_count(), 3);
  EXPECT_NEAR(open(options)->frame(1).mesh.V.maxCoeff(), 2, 1e-12);
}

TEST_F(SequenceFiles, CollectionsWithTwoRatesOrLostFilesAreReported) {
  std::vector<PvdEntry> entries;
  const std::vector<double> times{0, 0.04, 0.08, 0.08 + 1 / 30.0, 0.08 + 2 / 30.0};
  for (int i = 0; i < 5; ++i) {
    write_vtp(numbered("s_%d.vtp", i), octahedron(), 0);
    entries.push_back({times[i], numbered("s_%d.vtp", i), ""});
  }
  write("s.pvd", pvd_text(entries));
  const auto sequence = open("s.pvd");
  EXPECT_TRUE(warned("more than one frame rate: 0.04 s between frames, but 0.0333333 s"));
  EXPECT_DOUBLE_EQ(sequence->time(4), times[4]);
  SequenceOptions options;
  options.path = "s.pvd";
  options.start = 10;
  EXPECT_DOUBLE_EQ(open(options)->time(4), 10 + times[4]);
  options.frames_per_second = 5;
  EXPECT_DOUBLE_EQ(open(options)->time(4), 10.8);
  EXPECT_TRUE(warnings.empty());
  std::filesystem::remove(folder() / "s_3.vtp");
  EXPECT_EQ(open("s.pvd")->frame_count(), 4);
  EXPECT_TRUE(warned("1 of 5 files are missing: s_3.vtp"));
}

TEST_F(SequenceFiles, FilesOfOneTimeAreOneFrame) {
  std::string text = "<VTKFile type=\"Collection\"><Collection>";
  for (int i = 0; i < 3; ++i) {
    for (int part = 1; part >= 0; --part) {
      const std::string file = numbered(part == 0 ? "a%d.vtp" : "sub/b%d.vtp", i);
      write_vtp(file, octahedron(1, {5.0 * part, 0, 0}), 0);
      std::string name = file;
      std::replace(name.begin(), name.end(), '/', '\\');
      text += "<DataSet timestep=\"" + std::to_string(i) + "\" part=\"" + std::to_string(part) +
              "\" file=\".\\" + name + "\"/>";
    }
  }
  write("s.pvd", text + "</Collection></VTKFile>");
  const auto sequence = open("s.pvd");
  ASSERT_EQ(sequence->frame_count(), 3);
  const SurfaceFrame frame = sequence->frame(1);
  EXPECT_EQ(frame.mesh.triangle_count(), 16);
  EXPECT_NEAR(signed_volume(frame.mesh.V, frame.mesh.F), 2 * 4. / 3, 1e-12);
  EXPECT_EQ(frame.mesh.V(0, 0), 1) << "part 0 comes first";
  EXPECT_TRUE(warned("files of one time are parts of one frame"));
  EXPECT_EQ(inputs.size(), 7U);
  std::filesystem::remove(folder() / "sub/b1.vtp");
  EXPECT_EQ(open("s.pvd")->frame_count(), 2);
  EXPECT_TRUE(warned("1 of 6 files are missing: b1.vtp; frames that lack a part are left out"));
}

TEST_F(SequenceFiles, SeriesAndPiecesAreRead) {
  for (int i = 0; i < 2; ++i) {
    for (int p = 0; p < 2; ++p)
      write_vtp(numbered("p_%d", i) + numbered("_%d.vtp", p), octahedron(1, {4.0 * p, 0, 0}), 0);
    write(numbered("p_%d.pvtp", i), "<VTKFile type=\"PPolyData\"><PPolyData><Piece Source=\"" +
                                        numbered("p_%d_0.vtp", i) + "\"/><Piece Source=\".\\" +
                                        numbered("p_%d_1.vtp", i) + "\"/></PPolyData></VTKFile>");
  }
  write("p.pvtp.series",
        R"({"files": [{"name": "p_1.pvtp", "time": 2.5}, {"name": "p_0.pvtp", "time": 2}]})");
  const auto sequence = open("p.pvtp.series");
  ASSERT_EQ(sequence->frame_count(), 2);
  EXPECT_EQ(sequence->time(1), 2.5);
  EXPECT_EQ(sequence->frame(1).mesh.triangle_count(), 16);
  EXPECT_EQ(inputs.size(), 7U) << "the series, two frames, their pieces";
  const auto refused = [&](const std::string& text, std::initializer_list<std::string> parts) {
    write("s.vtp.series", text);
    expect_error([&] { open("s.vtp.series"); }, parts);
  };
  refused("{", {"s.vtp.series, byte", "JSON"});
  refused("[]", {"no file series"});
  refused(R"({"files": [{"time": 1}]})", {"file 0", "no name"});
  refused(R"({"files": [{"name": "p_0.pvtp"}]})", {"file 0", "no time"});
  write("q.pvtp",
        "<VTKFile type=\"PPolyData\"><PPolyData><Piece Source=\"none.vtp\"/></PPolyData>"
        "</VTKFile>");
  expect_error([&] { open("q.pvtp"); }, {"q.pvtp", "not there", "none.vtp"});
}

// An inflow: the first frames have no surface yet. Times stay those of the files.
TEST_F(SequenceFiles, EmptyFramesAtTheBeginningAreLeftOut) {
  write_objs("a_%d.obj", {0, 1, 2, 3, 4});
  write("a_0.obj", "# nothing yet\n");
  write("a_1.obj", "v 0 0 0\n");
  SequenceOptions options;
  options.path = "a_%d.obj";
  options.frames_per_second = 10;
  const auto sequence = open(options);
  ASSERT_EQ(sequence->frame_count(), 3);
  EXPECT_DOUBLE_EQ(sequence->time(0), 0.2);
  EXPECT_TRUE(
      warned("a_0.obj to a_1.obj without a triangle: no surface yet; the sequence begins "
             "with a_2.obj, at 0.200000 s"));
  EXPECT_EQ(inputs.size(), 5U);
  for (int i = 2; i < 5; ++i) write(numbered("a_%d.obj", i), "");
  expect_error([&] { open(options); }, {"a_%d.obj", "no triangle in any frame"});
  write_objs("b_%d.obj", {0, 1, 2});
  write("b_2.obj", "");
  expect_error([&] { open("b_%d.obj"); }, {"b_2.obj", "empty frame", "first and last"});
}

TEST_F(SequenceFiles, NotesOfReadersAreWarnings) {
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n");
  open("a.obj");
  EXPECT_TRUE(warned("a.obj: 1 line 'l' left out"));
}

TEST_F(SequenceFiles, CollectionMistakesAreNamed) {
  write_vtp("a.vtp", octahedron(), 0);
  const auto refused = [&](const std::string& text, std::initializer_list<std::string> parts) {
    write("s.pvd", text);
    expect_error([&] { open("s.pvd"); }, parts);
  };
  refused("<VTKFile", {"s.pvd, byte", "no valid XML"});
  refused("<a/>", {"no ParaView collection"});
  refused(pvd_text({}), {"names no file"});
  refused(pvd_text({{0, "b.vtp", ""}}), {"none of its files is there", "b.vtp"});
  refused(pvd_text({{0, "a.vtu", ""}}), {"'.vtu'"});
  refused(pvd_text({{1, "a.vtp", "x"}, {1, "a.vtp", "y"}}), {"two files for the time"});
  refused("<VTKFile><Collection><DataSet timestep=\"soon\" file=\"a.vtp\"/></Collection></VTKFile>",
          {"s.pvd, byte", "timestep"});
  refused("<VTKFile><Collection><DataSet timestep=\"1\"/></Collection></VTKFile>",
          {"without a file"});
}

TEST_F(SequenceFiles, OneMeshIsAStill) {
  write_obj("bunny.obj", octahedron());
  const auto sequence = open("bunny.obj");
  EXPECT_EQ(sequence->frame_count(), 1);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(SequenceFiles, PathMistakesAreNamed) {
  write_objs("a_%04d.obj", {1});
  write("movie.mp4", "");
  expect_error([&] { open("b_%04d.obj"); }, {"b_%04d.obj", "matches no file", "a_0001.obj"});
  expect_error([&] { open("a_%04d.abc"); }, {"'.abc'", ".obj, .ply"});
  expect_error([&] { open("a_%x.obj"); }, {"'%'"});
  expect_error([&] { open("a_%04d_%d.obj"); }, {"not one number"});
  expect_error([&] { open("movie.mp4"); }, {"movie.mp4", "'.mp4'", ".pvd"});
  expect_error([&] { open("nowhere"); }, {"nowhere", "no file or folder"});
  std::filesystem::create_directory(folder() / "empty");
  expect_error([&] { open("empty"); }, {"empty", "no numbered meshes"});
}

TEST_F(SequenceFiles, UnreadableFramesAreNamed) {
  write_objs("a_%04d.obj", {1, 2, 3, 4, 5, 6, 7});
  const auto sequence = open("a_%04d.obj");
  expect_error([&] { (void)sequence->frame(7); }, {"a_%04d.obj", "no frame 7", "0 to 6"});
  expect_error([&] { (void)sequence->frame(-1); }, {"no frame -1"});
  expect_error([&] { (void)sequence->time(7); }, {"no frame 7"});
  // Frames are read when they are asked for: mistakes between the probed ones come up then.
  write("a_0002.obj", "v 0 0 0\n");
  expect_error([&] { (void)sequence->frame(1); }, {"a_0002.obj", "empty frame"});
  std::filesystem::remove(folder() / "a_0002.obj");
  expect_error([&] { (void)sequence->frame(1); }, {"a_0002.obj", "no file"});
  // Those at the ends when the sequence is opened.
  write("a_0007.obj", "v 0 0 nan\n");
  expect_error([&] { open("a_%04d.obj"); }, {"a_0007.obj:1", "'nan'"});
}

TEST_F(SequenceFiles, InsideOutMeshesAreTurnedOverAndReported) {
  for (const int n : {1, 2}) {
    TriMesh mesh = octahedron();
    mesh.F.col(0).swap(mesh.F.col(1));
    write_obj(numbered("a_%04d.obj", n), mesh);
  }
  const SurfaceFrame frame = open("a_%04d.obj")->frame(1);
  EXPECT_NEAR(signed_volume(frame.mesh.V, frame.mesh.F), 4. / 3, 1e-12);
  EXPECT_TRUE(warned("a_0001.obj: the mesh is inside out"));
}

TEST_F(SequenceFiles, OptionsAreReadFromToml) {
  SequenceOptions options;
  read_options(parse_toml_text("path = \"a.pvd\"\nup = \"y\"\nscale = 0.1\nlast = 3", "t"), "",
               options);
  EXPECT_EQ(options.up, UpAxis::y);
  EXPECT_EQ(options.last, 3);
  expect_error([&] { read_options(parse_toml_text("up = \"y\"", "t"), "", options); }, {"path"});
}

SurfaceFrame frame_of(TriMesh mesh) {
  SurfaceFrame frame;
  frame.mesh = std::move(mesh);
  return frame;
}

std::vector<std::string> repaired(SurfaceFrame& frame) {
  std::vector<std::string> notes;
  repair(frame, "frame", notes);
  return notes;
}

TEST(MeshRepair, LeavesGoodMeshesAsTheyAre) {
  SurfaceFrame frame = frame_of(octahedron());
  EXPECT_TRUE(repaired(frame).empty());
  EXPECT_EQ(frame.mesh.F, octahedron().F);
}

TEST(MeshRepair, WeldsTheCornersOfATriangleSoup) {
  const TriMesh whole = octahedron();
  SurfaceFrame frame;
  frame.mesh.V.resize(24, 3);
  frame.mesh.F.resize(8, 3);
  for (int t = 0; t < 8; ++t) {
    for (int k = 0; k < 3; ++k) {
      frame.mesh.V.row(3 * t + k) = whole.V.row(whole.F(t, k));
      frame.mesh.F(t, k) = 3 * t + k;
    }
  }
  frame.velocity = 2 * frame.mesh.V;
  const auto notes = repaired(frame);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("welded"), std::string::npos);
  EXPECT_EQ(frame.mesh.vertex_count(), 6);
  EXPECT_EQ(frame.velocity, 2 * frame.mesh.V);
  EXPECT_NO_THROW(require_closed_manifold(frame.mesh, "the test", "frame"));
}

// Welding would leave nothing.
TEST(MeshRepair, KeepsTrianglesThatArePoints) {
  SurfaceFrame frame = frame_of({Eigen::MatrixX3d::Zero(3, 3), Eigen::RowVector3i(0, 1, 2)});
  repaired(frame);
  EXPECT_EQ(frame.mesh.triangle_count(), 1);
}

TEST(MeshRepair, KeepsBubblesInward) {
  TriMesh both = octahedron(5);
  const TriMesh bubble = octahedron(1);
  both.V.conservativeResize(12, 3);
  both.V.bottomRows(6) = bubble.V;
  both.F.conservativeResize(16, 3);
  both.F.bottomRows(8) = bubble.F.array() + 6;
  both.F.bottomRows(8).col(0).swap(both.F.bottomRows(8).col(1));
  SurfaceFrame frame = frame_of(both);
  EXPECT_TRUE(repaired(frame).empty());
  EXPECT_NEAR(signed_volume(frame.mesh.V, frame.mesh.F), 4. / 3 * (125 - 1), 1e-9);
}

TEST(MeshRepair, OrientsTrianglesLikeMostOfTheirSurface) {
  TriMesh mesh = octahedron();
  std::swap(mesh.F(0, 1), mesh.F(0, 2));  // the first one: where the walk starts
  SurfaceFrame frame = frame_of(mesh);
  const auto notes = repaired(frame);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("disagreed"), std::string::npos);
  EXPECT_EQ(frame.mesh.F, octahedron().F);
}

TEST(MeshRepair, TurnsOpenSurfacesUp) {
  TriMesh square{Eigen::MatrixX3d(4, 3), Eigen::MatrixX3i(2, 3)};
  square.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  square.F << 0, 2, 1, 0, 3, 2;
  SurfaceFrame frame = frame_of(square);
  EXPECT_NE(repaired(frame).at(0).find("faces down"), std::string::npos);
  EXPECT_EQ(triangle_normals(frame.mesh).col(2).minCoeff(), 1);
}

TEST(MeshRepair, DropsLonelyVerticesAndDegenerateTriangles) {
  TriMesh mesh = octahedron();
  mesh.V.conservativeResize(8, 3);
  mesh.V.row(7) = mesh.V.row(5);
  mesh.V.row(6) << 9, 9, 9;
  for (Eigen::Index i = 0; i < mesh.F.size(); ++i) {
    if (mesh.F.data()[i] == 5) mesh.F.data()[i] = 7;
  }
  mesh.F.conservativeResize(9, 3);
  mesh.F.row(8) << 0, 0, 1;
  SurfaceFrame frame = frame_of(mesh);
  EXPECT_EQ(repaired(frame).size(), 2U);
  EXPECT_EQ(frame.mesh.V, octahedron().V);
  EXPECT_EQ(frame.mesh.F, octahedron().F);
}

TEST(MeshRepair, NamesTheNonManifoldEdge) {
  TriMesh mesh = octahedron();
  mesh.F.conservativeResize(9, 3);
  mesh.F.row(8) << 0, 2, 3;
  SurfaceFrame frame = frame_of(mesh);
  expect_error([&] { repaired(frame); }, {"frame", "not manifold", "edge 0-2", "3 triangles"});
}

TEST(MeshRepair, RefusesOneSidedSurfaces) {
  TriMesh band{Eigen::MatrixX3d(5, 3), Eigen::MatrixX3i(5, 3)};  // a Moebius band of five triangles
  band.V << 1, 0, 0, 0.3, 1, 0, -0.8, 0.6, 0.5, -0.8, -0.6, 0, 0.3, -1, -0.5;
  band.F << 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 0, 4, 0, 1;
  SurfaceFrame frame = frame_of(band);
  expect_error([&] { repaired(frame); }, {"cannot be oriented"});
}

TEST(MeshRepair, RefusesWhatIsNoSurface) {
  SurfaceFrame empty;
  expect_error([&] { repaired(empty); }, {"frame", "empty frame"});
  SurfaceFrame nan = frame_of(octahedron());
  nan.mesh.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { repaired(nan); }, {"position of vertex 3", "not finite"});
}

}  // namespace
}  // namespace geoprior
