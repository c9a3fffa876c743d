// Every reader of text of the testbed takes byte order marks and line ends as editors leave them.

#include "tests/support/text_forms.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "testbed/formats/gltf/reader.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/sequence/pvd.h"
#include "testbed/formats/sequence/sidecar.h"
#include "testbed/formats/svg/document.h"
#include "testbed/formats/text/csv_table.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/spec/toml_tree.h"
#include "tests/testbed/formats/octahedron.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::expect_error;
namespace fs = std::filesystem;

TEST(PlainText, HasNoMarkAndOneKindOfLineEnd) {
  const std::string text = "a\n\nb c\nd";
  for (const test::TextForm& form : test::text_forms(text))
    EXPECT_EQ(plain_text(form.bytes, "f"), text) << form.name;
  EXPECT_EQ(plain_text("a\r\rb\r\n\nc\r", "f"), "a\n\nb\n\nc\n");
  EXPECT_EQ(plain_text("", "f"), "");
}

TEST(PlainText, OfWideCharactersIsRefusedWithAWayOut) {
  using namespace std::string_literals;
  for (const std::string& bytes :
       {test::in_utf16("v 0 0 0"), "\xFE\xFF\0v\0 "s, "v\0 \0000\0"s, "\0v\0 \0000"s}) {
    expect_error([&] { plain_text(bytes, "a.obj"); }, {"a.obj", "UTF-16", "UTF-8", "iconv"});
  }
  for (const std::string& bytes : {"\xFF\xFE\0\0v\0\0\0"s, "\0\0\xFE\xFF\0\0\0v"s, "v\0\0\0"s})
    expect_error([&] { plain_text(bytes, "a.obj"); }, {"UTF-32"});
}

/// What a reader makes of a file, as a text.
using Reader = std::function<std::string(const fs::path&)>;

std::string mesh_text(const fs::path& file) {
  const MeshFile read = read_mesh_file(file);
  std::ostringstream out;
  out << read.mesh.V << "\n" << read.mesh.F << "\n" << read.notes.size();
  return out.str();
}

std::string sets_text(const std::vector<PvdDataSet>& sets) {
  std::ostringstream out;
  for (const PvdDataSet& set : sets)
    out << set.time << " " << set.part << " " << set.name << " " << set.file << "\n";
  return out.str();
}

std::string table_text(const fs::path& file) {
  const CsvTable table(file, {"x"}, {"y"});
  std::ostringstream out;
  for (const CsvTable::Row& row : table.rows())
    out << *table.number(row, "x") << " " << table.number(row, "y").value_or(7) << " " << row.place
        << "\n";
  return out.str();
}

std::string toml_text(const TomlNode& node) {
  std::ostringstream out;
  out << static_cast<int>(node.kind) << " " << node.integer << " " << node.real << " " << node.text
      << " " << node.place << "\n";
  for (std::size_t i = 0; i < node.items.size(); ++i)
    out << (i < node.keys.size() ? node.keys[i] : "-") << toml_text(node.items[i]);
  return out.str();
}

std::string svg_text(const fs::path& file) {
  std::ostringstream out;
  const SvgDocument document = read_svg_document(file, {});
  out << document.width_m << " " << document.shapes.size() << " " << document.notes.size();
  for (const SvgShape& shape : document.shapes) out << "\n" << document.place("path", shape.tags);
  return out.str();
}

std::string gltf_text(const fs::path& file) {
  const GltfCharacter read = read_gltf(file);
  std::ostringstream out;
  out << read.mesh.V << "\n" << read.mesh.F;
  return out.str();
}

class TextForms : public test::ScratchFolder {
 protected:
  /// The reader sees the same in every form of the text, and refuses UTF-16.
  void expect_equal(const std::string& name, const std::string& text, const Reader& read) const {
    std::string plain;
    for (const test::TextForm& form : test::text_forms(text)) {
      const fs::path file = write(name, form.bytes);
      try {
        const std::string seen = read(file);
        EXPECT_GT(seen.size(), 3U);
        if (plain.empty()) plain = seen;
        EXPECT_EQ(seen, plain) << name << ", " << form.name;
      } catch (const Error& error) {
        ADD_FAILURE() << name << ", " << form.name << ": " << error.what();
      }
    }
    const fs::path wide = write(name, test::in_utf16(text));
    expect_error([&] { read(wide); }, {name, "UTF-16", "iconv"});
  }
};

TEST_F(TextForms, OfMeshesAreReadAlike) {
  expect_equal("a.obj", "# three\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n", mesh_text);
  expect_equal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2\n", mesh_text);
  expect_equal("a.stl",
               "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
               "endloop\nendfacet\nendsolid a\n",
               mesh_text);
  expect_equal("a.ply",
               "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\n"
               "property float y\nproperty float z\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
               mesh_text);
}

TEST_F(TextForms, OfVtkFilesAreReadAlike) {
  Part part;
  part.points = test::octahedron().V;
  part.triangles = test::octahedron().F;
  expect_equal("a.vtp", part_to_vtk_xml(part, 1), mesh_text);
  write("piece.vtp", part_to_vtk_xml(part, 1));
  expect_equal("b.pvtp",
               "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\">\n<PPolyData>\n"
               "<Piece Source=\"piece.vtp\"/>\n</PPolyData>\n</VTKFile>\n",
               mesh_text);
  expect_equal("a.pvd", pvd_text({{0, "a.vtp", "p"}, {1, "b.vtp", "p"}}),
               [](const fs::path& file) { return sets_text(read_pvd(file)); });
  expect_equal("a.vtp.series",
               "{\n\"files\": [\n{\"name\": \"a.vtp\", \"time\": 0},\n"
               "{\"name\": \"b.vtp\", \"time\": 2}]\n}\n",
               [](const fs::path& file) { return sets_text(read_series(file)); });
}

TEST_F(TextForms, OfTheOthersAreReadAlike) {
  expect_equal("a.json", "{\n\"frames_per_second\": 24,\n\"up\": \"y\"\n}\n",
               [](const fs::path& file) {
                 const SequenceSidecar read = read_sidecar(file);
                 return std::to_string(*read.frames_per_second) + (*read.y_up ? " y" : " z");
               });
  expect_equal("a.csv", "# a table\nx,\"y\"\n1,2\n\n3,\n", table_text);
  expect_equal("a.toml", "title = \"t\" # c\n\n[scene]\nn = 3\nlist = [\n1.5,\n2]\n",
               [](const fs::path& file) { return toml_text(parse_toml_file(file)); });
  expect_equal("a.svg",
               "<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"10mm\"\n"
               "height=\"10mm\" viewBox=\"0 0 10 10\">\n<path id=\"a\"\nd=\"M 0 0\nL 5 0 5 5 Z\" "
               "stroke=\"black\"/>\n</svg>\n",
               svg_text);
  // Three corners of a triangle, then their indices, in base64.
  expect_equal(
      "a.gltf",
      "{\n\"asset\": {\"version\": \"2.0\"},\n\"scene\": 0, \"scenes\": [{\"nodes\": [0]}],\n"
      "\"nodes\": [{\"mesh\": 0}],\n"
      "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}],\n"
      "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, "
      "\"type\": \"VEC3\", \"min\": [0, 0, 0], \"max\": [1, 1, 0]}],\n"
      "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}],\n"
      "\"buffers\": [{\"byteLength\": 36, \"uri\": \"data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]\n}\n",
      gltf_text);
}

// Binary data behind a head of other line ends begin where they do, whatever their first byte is.
TEST_F(TextForms, OfTheHeadOfABinaryPlyLeaveItsDataAlone) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar "
      "y\nproperty uchar z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  for (const char first : {'\n', '\r', '\1'}) {
    const std::string data{first, 0, 0, 13, 10, 13, 0, 10, 13, 3, 0, 1, 2};
    for (const test::TextForm& form : test::text_forms(head)) {
      const MeshFile read = read_mesh_file(write("a.ply", form.bytes + data));
      EXPECT_EQ(read.mesh.V(0, 0), first) << form.name;
      EXPECT_EQ(read.mesh.V.row(1), Eigen::RowVector3d(13, 10, 13)) << form.name;
      EXPECT_EQ(read.mesh.V.row(2), Eigen::RowVector3d(0, 10, 13)) << form.name;
    }
  }
}

}  // namespace
}  // namespace geoprior
