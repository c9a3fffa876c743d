#include "testbed/formats/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/geometry/topology.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/off_reader.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/mesh/polygon_soup.h"
#include "testbed/formats/mesh/stl_reader.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/view/mesh_text.h"
#include "tests/testbed/formats/octahedron.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::expect_error;

/// A unit cube of quads, counter-clockwise from outside, indices from `base`.
std::string cube_faces(const std::string& prefix, int base) {
  constexpr std::array<std::array<int, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::string text;
  for (const auto& face : kFaces) {
    text += prefix;
    for (const int v : face) text += " " + std::to_string(v + base);
    text += "\n";
  }
  return text;
}

std::string cube_points(const std::string& prefix) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += prefix + std::to_string(i & 1) + " " + std::to_string((i >> 1) & 1) + " " +
            std::to_string((i >> 2) & 1) + "\n";
  }
  return text;
}

void expect_cube(const TriMesh& mesh) {
  EXPECT_EQ(mesh.vertex_count(), 8);
  EXPECT_EQ(mesh.triangle_count(), 12);
  EXPECT_NEAR(signed_volume(mesh.V, mesh.F), 1, 1e-15);
  EXPECT_NO_THROW(require_closed_manifold(mesh, "the test", "cube"));
}

TEST(ObjReader, ReadsQuadsAsAClosedSurface) {
  expect_cube(parse_obj("# cube\r\no box\n" + cube_points("v ") + "s off\n" + cube_faces("f", 1),
                        "cube.obj")
                  .mesh);
}

TEST(ObjReader, CornersMayNameTextureAndNormalAndCountFromTheEnd) {
  const MeshFile file = parse_obj(
      "v 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1\nf -3 -2 -1 # "
      "same\n",
      "a.obj");
  EXPECT_EQ(file.mesh.F, (Eigen::MatrixX3i(2, 3) << 0, 1, 2, 0, 1, 2).finished());
}

TEST(ObjReader, NamesTheLineOfAMistake) {
  expect_error([] { parse_obj("v 0 0 0\nv 1 nan 0\n", "a.obj"); }, {"a.obj:2", "'nan'"});
  expect_error([] { parse_obj("v 0 0 1e999\n", "a.obj"); }, {"a.obj:1", "1e999"});
  expect_error([] { parse_obj("v 0 0\n", "a.obj"); }, {"a.obj:1", "v x y z"});
  expect_error([] { parse_obj("v 0 0 0\nf 1 0 1\n", "a.obj"); }, {"a.obj:2", "vertex 0"});
  expect_error([] { parse_obj("v 0 0 0\nf 1 -2 1\n", "a.obj"); }, {"a.obj:2", "vertex -2"});
  expect_error([] { parse_obj("v 0 0 0\nf 1 x 1\n", "a.obj"); }, {"a.obj:2", "'x'"});
  expect_error([] { parse_obj("v 0 0 0\nf 1 2 3\n", "a.obj"); }, {"a.obj, face 0", "0 to 0"});
  EXPECT_EQ(parse_obj("v 1e-400 0 0\n", "a.obj").mesh.V(0, 0), 0);
}

// Blender and others go on behind a backslash; a path in a comment ends with one too.
TEST(ObjReader, LinesGoOnBehindABackslashAndCommentsDoNot) {
  const MeshFile file = parse_obj(
      "v 0 0 0\nv 1 \\\n 0\\\r\n0\nv 0 1 0 # in C:\\folder\\\nv 1 1 0\nf 1 2\\  \n3 \\\n# none\nf "
      "2 4 "
      "3\\",
      "a.obj");
  EXPECT_EQ(file.mesh.V.rows(), 4);
  EXPECT_EQ(file.mesh.V.row(1), Eigen::RowVector3d(1, 0, 0));
  EXPECT_EQ(file.mesh.F, (Eigen::MatrixX3i(2, 3) << 0, 1, 2, 1, 3, 2).finished());
  EXPECT_TRUE(file.notes.empty());
}

TEST(ObjReader, NotesNameWhatIsLeftOut) {
  const MeshFile file = parse_obj(
      "mtllib a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\nl 2 3\nvv 0 0 0\nusemtl b\n", "a.obj");
  ASSERT_EQ(file.notes.size(), 2U);
  EXPECT_EQ(file.notes[0],
            "2 lines 'l' left out (the first is line 6): the surface is made of faces alone");
  EXPECT_EQ(file.notes[1], "1 line 'vv' left out (the first is line 8): OBJ has no such statement");
}

// A pentagon with a dent: a fan about any corner but two would leave it.
TEST(PolygonSoup, CutsConcaveFacesInside) {
  const std::vector<Eigen::Vector3d> points{
      {0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {2, 0.5, 0}, {0, 3, 0}};
  for (int turn = 0; turn < 5; ++turn) {
    std::vector<int> face{0, 1, 2, 3, 4};
    std::rotate(face.begin(), face.begin() + turn, face.end());
    std::vector<Eigen::Vector3i> triangles;
    triangulate_face(points, face, triangles);
    ASSERT_EQ(triangles.size(), 3U);
    double area = 0;
    for (const auto& t : triangles) {
      const auto at = [&](int k) { return points[t[k]]; };
      const double part = (at(1) - at(0)).cross(at(2) - at(0)).z() / 2;
      EXPECT_GT(part, 0);
      area += part;
    }
    EXPECT_NEAR(area, 12 - 4 * 2.5 / 2, 1e-12);  // 4 x 3 less the triangle of the dent
  }
}

std::string ply_text_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nproperty double vx\nproperty double vy\nproperty double vz\n"
         "property uchar red\nelement face 1\nproperty uchar flags\n"
         "property list uchar int vertex_indices\nelement note 1\nproperty list int short words\n"
         "end_header\n";
}

template <class T>
void put(std::string& out, T value, bool swapped) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

std::string binary_ply(bool big) {
  std::string out = ply_text_header(big ? "binary_big_endian" : "binary_little_endian");
  for (int v = 0; v < 3; ++v) {
    put(out, v == 1 ? 1.5F : 0.0F, big);
    put(out, v == 2 ? 1.0F : 0.0F, big);
    put(out, 0.25F, big);
    for (int c = 0; c < 3; ++c) put(out, 10.0 * v + c, big);
    put(out, std::uint8_t{200}, big);
  }
  put(out, std::uint8_t{7}, big);
  put(out, std::uint8_t{3}, big);
  for (const std::int32_t v : {0, 1, 2}) put(out, v, big);
  put(out, std::int32_t{2}, big);
  for (const int w : {5, 6}) put(out, static_cast<std::int16_t>(w), big);
  return out;
}

void expect_moving_triangle(const MeshFile& file) {
  EXPECT_EQ(file.mesh.V,
            (Eigen::MatrixX3d(3, 3) << 0, 0, 0.25, 1.5, 0, 0.25, 0, 1, 0.25).finished());
  EXPECT_EQ(file.mesh.F, (Eigen::MatrixX3i(1, 3) << 0, 1, 2).finished());
  EXPECT_EQ(file.velocity, (Eigen::MatrixX3d(3, 3) << 0, 1, 2, 10, 11, 12, 20, 21, 22).finished());
}

TEST(PlyReader, ReadsTextAndBothByteOrders) {
  expect_moving_triangle(parse_ply(ply_text_header("ascii") +
                                       "0 0 .25 0 1 2 200\n1.5 0 .25 10 11 12 200\n"
                                       "0 1 .25 20 21 22 200\n7 3 0 1 2\n2 5 6\n",
                                   "a.ply"));
  expect_moving_triangle(parse_ply(binary_ply(false), "little.ply"));
  expect_moving_triangle(parse_ply(binary_ply(true), "big.ply"));
}

TEST(PlyReader, ReadsWhatTheTestbedExports) {
  Part part;
  const TriMesh ball = test::octahedron(0.3);
  part.points = ball.V;
  part.triangles = ball.F;
  part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, -ball.V});
  const MeshFile file = parse_ply(part_to_ply(part, "ball"), "ball.ply");
  EXPECT_EQ(file.mesh.V, ball.V);
  EXPECT_EQ(file.mesh.F, ball.F);
  EXPECT_EQ(file.velocity, -ball.V);
}

// Strips of the Stanford models: (0 1 2), (2 1 3); a new strip; a vertex named twice joins two.
TEST(PlyReader, ReadsStrips) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float "
      "z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n";
  const MeshFile file = parse_ply(head + points + "8 0 1 2 3 -1 2 3 4\n", "a.ply");
  EXPECT_EQ(file.mesh.F, (Eigen::MatrixX3i(3, 3) << 0, 1, 2, 2, 1, 3, 2, 3, 4).finished());
  const MeshFile joined = parse_ply(head + points + "7 0 1 2 2 3 3 4\n", "a.ply");
  EXPECT_EQ(joined.mesh.F, (Eigen::MatrixX3i(1, 3) << 0, 1, 2).finished());
  expect_error([&] { parse_ply(head + points + "3 0 1 -2\n", "a.ply"); }, {"a.ply", "vertex -2"});
  expect_error([&] { parse_ply(head + points + "3 0 1 5\n", "a.ply"); }, {"a.ply", "vertex 5"});
}

TEST(PlyReader, NotesOtherElements) {
  const std::string text =
      ply_text_header("ascii") +
      "0 0 .25 0 1 2 200\n1.5 0 .25 10 11 12 200\n0 1 .25 20 21 22 200\n7 3 0 1 "
      "2\n2 5 6\n";
  EXPECT_EQ(parse_ply(text, "a.ply").notes.at(0), "1 of its element 'note' left out");
}

TEST(StlReader, NamesWhatIsWrong) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const auto refused = [](const std::string& text, std::initializer_list<std::string> parts) {
    expect_error([&] { parse_stl(text, "a.stl"); }, parts);
  };
  refused("", {"a.stl", "no STL file"});
  refused("solid a\n" + facet, {"a.stl:8", "truncated", "endsolid"});
  refused("solid a\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", {"a.stl:5", "2 corners"});
  refused("solid a\nouter loop\nvertex 0 0 nan\n", {"a.stl:3", "'nan'"});
  refused("solid a\nbox 1 2 3\n", {"a.stl:2", "'box'"});
  std::string binary(84 + 50, '\0');
  binary[80] = 2;
  refused(binary, {"a.stl", "truncated", "134 bytes", "184", "2 triangles"});
  binary[80] = 1;
  for (const int at : {84 + 14, 84 + 15}) binary[at] = '\x7f';
  binary[84 + 14] = '\xc0';
  refused(binary, {"triangle 0", "not finite"});
  // Triangles that are points are left out, and so are bytes behind the last one.
  binary[84 + 14] = binary[84 + 15] = 0;
  const MeshFile points = parse_stl(binary + "##", "a.stl");
  EXPECT_EQ(points.mesh.F.rows(), 0);
  ASSERT_EQ(points.notes.size(), 2U);
  EXPECT_EQ(points.notes[0], "2 bytes behind the last of its 1 triangles left out");
  EXPECT_EQ(points.notes[1], "1 triangles with two corners in one place left out");
}

// Cut after every byte: whole, or an Error; never a mesh of less.
TEST(PlyReader, EveryTruncationIsAnError) {
  for (const bool big : {false, true}) {
    const std::string whole = binary_ply(big);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_THROW(parse_ply(whole.substr(0, size), "cut.ply"), Error) << size;
    }
  }
  expect_error([] { parse_ply(binary_ply(false).substr(0, 420), "cut.ply"); },
               {"cut.ply, byte", "is truncated", "vertex"});
  expect_error(
      [] { parse_ply(ply_text_header("ascii") + "0 0 .25 0 1 2 200\n1.5 0\n", "cut.ply"); },
      {"cut.ply:", "is truncated"});
}

TEST(PlyReader, NamesWhatIsWrong) {
  const std::string vertices = "element vertex 1\nproperty float x\nproperty float y\n";
  const auto header = [](const std::string& body) { return "ply\nformat ascii 1.0\n" + body; };
  const std::string end = "end_header\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_index\n";
  expect_error([&] { parse_ply("plyx\n", "a.ply"); }, {"a.ply", "no PLY file"});
  expect_error([&] { parse_ply(header(vertices), "a.ply"); }, {"header has no end"});
  expect_error([&] { parse_ply("ply\n" + end, "a.ply"); }, {"a.ply:2", "no format"});
  expect_error([&] { parse_ply(header("element vertex -1\n"), "a.ply"); }, {"a.ply:3", "count"});
  expect_error([&] { parse_ply(header("property float x\n"), "a.ply"); }, {"before any element"});
  expect_error([&] { parse_ply(header("element v 1\nproperty half x\n"), "a.ply"); }, {"'half'"});
  expect_error([&] { parse_ply(header(vertices + end) + "0 0\n", "a.ply"); }, {"'face'"});
  expect_error([&] { parse_ply(header(vertices + faces + end) + "0 0\n3 0 0 0", "a.ply"); },
               {"no x, y, z"});
  const std::string whole = header(vertices + "property float z\n" + faces + end);
  expect_error([&] { parse_ply(whole + "0 nan 0\n3 0 0 0\n", "a.ply"); }, {"a.ply:10", "'nan'"});
  expect_error([&] { parse_ply(whole + "0 0 0\n3 0 0 1\n", "a.ply"); }, {"face 0", "vertex 1"});
  expect_error([&] { parse_ply(whole + "0 0 0\n3 0 0 .5\n", "a.ply"); }, {"a.ply:11", "whole"});
  expect_error([&] { parse_ply(whole + "0 0 0\n2 0 0\n", "a.ply"); }, {"face 0", "2 corners"});
  std::string nan = binary_ply(false);
  const float bad = std::bit_cast<float>(0x7fc00000U);
  std::memcpy(nan.data() + nan.find("end_header\n") + 11, &bad, sizeof bad);
  expect_error([&] { parse_ply(nan, "b.ply"); }, {"b.ply, byte", "vertex 0", "not finite"});
  // A count that no such file can hold is refused before memory is asked for.
  std::string huge = binary_ply(false);
  huge.replace(huge.find("vertex 3"), 8, "vertex 2000000000");
  expect_error([&] { parse_ply(huge, "b.ply"); }, {"is truncated", "2000000000"});
}

TEST(OffReader, ReadsCubesWithAndWithoutColours) {
  expect_cube(
      parse_off("OFF\n# a cube\n8 6 0\n\n" + cube_points("") + cube_faces("4", 0), "a.off").mesh);
  const MeshFile coloured = parse_off(
      "COFF 3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2 255 0 0\n", "c.off");
  EXPECT_EQ(coloured.mesh.vertex_count(), 3);
  EXPECT_EQ(coloured.mesh.F, (Eigen::MatrixX3i(1, 3) << 0, 1, 2).finished());
}

void expect_two_triangles(const std::string& text) {
  const MeshFile file = parse_off(text, "a.off");
  EXPECT_EQ(file.mesh.V, (Eigen::MatrixX3d(4, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0).finished())
      << text;
  EXPECT_EQ(file.mesh.F, (Eigen::MatrixX3i(2, 3) << 0, 1, 2, 1, 3, 2).finished()) << text;
}

// ModelNet's files begin so.
TEST(OffReader, ReadsCountsThatAreGluedToTheHead) {
  expect_two_triangles("OFF4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n");
  expect_two_triangles("OFF4 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n");
}

TEST(OffReader, ReadsAnyLineBreaks) {
  expect_two_triangles("OFF 4 2 0 0 0 0 1 0 0 0 1 0 1 1 0 3 0 1 2 3 1 3 2");
  expect_two_triangles("OFF\n4\n2\n0\n0 0 0 1 0 0\n0 1 0 1 1 0\n3 0 1\n2 3 1 3 2\n");
  expect_two_triangles("4 2 0\n0 0 0 1 0\n0 0 1 0 1\n1 0\n3 0 1 2\n3 1 3 2\n");
  // Colours of vertices by the head, those of faces to the end of their line.
  expect_two_triangles(
      "COFF\n4 2 0\n0 0 0 9 9 9 9 1 0 0 9 9 9 9\n0 1 0 9 9 9 9 1 1 0 9 9 9 9\n3 0 1 2 0.5 1 0\n3 1 "
      "3 "
      "2 0.5 1 0\n");
}

TEST(OffReader, NotesWhatIsBehindTheLastFace) {
  EXPECT_EQ(parse_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n", "a.off").notes.at(0),
            "1 lines behind the last face left out: more than its counts say");
  expect_error([] { parse_off("OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2 3 0 1 2", "a.off"); },
               {"a.off:1", "more words than its counts need"});
}

TEST(OffReader, NamesWhatIsWrong) {
  expect_error([] { parse_off("", "a.off"); }, {"a.off", "empty"});
  expect_error([] { parse_off("4OFF\n1 0 0\n", "a.off"); }, {"a.off:1", "another kind"});
  expect_error([] { parse_off("OFF BINARY\n", "a.off"); }, {"another kind"});
  expect_error([] { parse_off("OFF\n3 1 0\n0 0 0\n", "a.off"); }, {"truncated", "vertex 1 of 3"});
  expect_error([] { parse_off("OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "a.off"); }, {"a.off:4", "vertex 1"});
  expect_error([] { parse_off("OFF\n1 1 0\n0 0 0\n3 0 0\n", "a.off"); }, {"a.off:4"});
  expect_error([] { parse_off("OFF\n-1 1 0\n", "a.off"); }, {"a.off:2", "count"});
}

using MeshFiles = test::ScratchFolder;

TEST_F(MeshFiles, AreReadByExtension) {
  expect_cube(read_mesh_file(write("a.OBJ", cube_points("v ") + cube_faces("f", 1))).mesh);
  Part part;
  const TriMesh ball = test::octahedron();
  part.points = ball.V;
  part.triangles = ball.F;
  part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, 2 * ball.V});
  const MeshFile file = read_mesh_file(write("a.VTP", part_to_vtk_xml(part, 0.75)));
  EXPECT_EQ(file.mesh.V, ball.V);
  EXPECT_EQ(file.velocity, 2 * ball.V);
  EXPECT_EQ(file.time, 0.75);
  expect_error([&] { read_mesh_file(write("a.3ds", "solid")); }, {"'.3ds'", ".obj, .ply"});
  expect_error([&] { read_mesh_file(folder() / "none.obj"); }, {"none.obj", "no file"});
  expect_error([&] { read_mesh_file(write("cut.vtp", "<VTKFile type=\"PolyData\">")); },
               {"cut.vtp", "no readable VTK file"});
}

}  // namespace
}  // namespace geoprior
