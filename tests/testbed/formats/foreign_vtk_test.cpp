#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include "core/error.h"
#include "core/random.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/formats/vtk/part_bytes.h"
#include "tests/testbed/formats/part_samples.h"
#include "tests/testbed/run_fixture.h"

// Files that VTK's readers and filters do not survive, or answer with gigabytes.

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string cells(const std::string& kind, const std::string& connectivity,
                  const std::string& offsets) {
  return "<" + kind + R"(><DataArray type="Int64" Name="connectivity" format="ascii">)" +
         connectivity + R"(</DataArray><DataArray type="Int64" Name="offsets" format="ascii">)" +
         offsets + "</DataArray></" + kind + ">";
}

/// Four points of a unit square, with further elements inside the piece.
std::string square(const std::string& counts, const std::string& inside) {
  return R"(<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="4" )" +
         counts + R"(><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 1 1 0</DataArray></Points>)" +
         inside + "</Piece></PolyData></VTKFile>";
}

std::string image(const std::string& whole, const std::string& piece) {
  return R"(<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian"><ImageData WholeExtent=")" +
         whole + R"(" Origin="0 0 0" Spacing="1 1 1"><Piece Extent=")" + piece +
         R"("><PointData><DataArray type="Float64" Name="a" format="ascii">1 2 3 4 5 6 7 8</DataArray>
</PointData></Piece></ImageData></VTKFile>)";
}

std::string strip(const std::string& connectivity, const std::string& offsets) {
  return square(R"(NumberOfStrips="1")", cells("Strips", connectivity, offsets));
}

std::string polygons(const std::string& connectivity, const std::string& offsets) {
  return square(R"(NumberOfPolys="2")", cells("Polys", connectivity, offsets));
}

std::string base64(const std::vector<std::uint32_t>& words) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes(4 * words.size(), '\0');
  std::memcpy(bytes.data(), words.data(), bytes.size());
  std::string out;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 6) {
    unsigned digit = 0;
    for (std::size_t b = bit; b < bit + 6; ++b) {
      const unsigned byte = b / 8 < bytes.size() ? static_cast<unsigned char>(bytes[b / 8]) : 0U;
      digit = 2 * digit + (byte >> (7 - b % 8) & 1U);
    }
    out.push_back(kDigits[digit]);
  }
  return out;
}

/// A compressed array that begins with this text, inline or appended.
std::string compressed(const std::string& begin, bool inline_data) {
  const std::string array = R"(<DataArray type="Float64" NumberOfComponents="3" )" +
                            (inline_data ? "format=\"binary\">" + begin + "</DataArray>"
                                         : std::string("format=\"ascii\" offset=\"0\"/>"));
  return R"(<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" compressor="vtkZLibDataCompressor"><PolyData>
<Piece NumberOfPoints="1"><Points>)" +
         array + "</Points></Piece></PolyData>" +
         (inline_data ? "" : R"(<AppendedData encoding="base64">_)" + begin + "</AppendedData>") +
         "</VTKFile>";
}

class ForeignVtk : public RunTest {
 protected:
  [[nodiscard]] std::filesystem::path write(const std::string& name,
                                            const std::string& text) const {
    std::ofstream(folder() / name, std::ios::binary) << text;
    return folder() / name;
  }
  [[nodiscard]] Part read(const std::string& text, const std::string& extension = ".vtp") const {
    std::optional<double> time;
    return read_foreign_vtk_part(write("foreign" + extension, text), time);
  }
  /// What reading says; it names the file, and neither an address nor a crash.
  [[nodiscard]] std::string refusal(const std::string& text,
                                    const std::string& extension = ".vtp") const {
    const std::string message = error_of([&] { (void)read(text, extension); });
    EXPECT_THAT(message, AllOf(StartsWith((folder() / ("foreign" + extension)).string()),
                               Not(HasSubstr("(0x")), Not(HasSubstr("is damaged, or made to"))));
    return message;
  }
};

TEST_F(ForeignVtk, OfEveryKindIsReadAsInThisProcess) {
  for (const Part& part : part_samples()) {
    const auto file = write("part" + part_extension(part), part_to_vtk_xml(part, 1.0 / 3));
    std::optional<double> time;
    expect_equal(read_foreign_vtk_part(file, time), read_vtk_part(file));
    EXPECT_EQ(time, 1.0 / 3);
  }
  for (const auto kind : {Part::Kind::triangles, Part::Kind::lines, Part::Kind::points}) {
    Part empty;
    empty.kind = kind;
    expect_equal(read(part_to_vtk_xml(empty, 0)), empty);
  }
}

TEST_F(ForeignVtk, OfOtherProgramsIsReadAsInThisProcess) {
  std::optional<double> time = 1;
  const auto file = write("strip.vtp", strip("0 1 2 3", "4"));
  const Part part = read_foreign_vtk_part(file, time);
  EXPECT_EQ(time, std::nullopt);
  EXPECT_EQ(part.triangles.rows(), 2);
  expect_equal(part, read_vtk_part(file));
  const Part quadrilateral = read(polygons("0 1 3 2 0 1 2", "4 7"));
  EXPECT_EQ(quadrilateral.triangles.rows(), 3);
  expect_equal(quadrilateral, read_vtk_part(folder() / "foreign.vtp"));
  const Part grid = read(image("3 4 0 1 0 1", "3 4 0 1 0 1"), ".vti");
  EXPECT_EQ(grid.grid_origin, Eigen::Vector3d(3, 0, 0));
  expect_equal(grid, read_vtk_part(folder() / "foreign.vti"));
}

// A cube of four quadrilaterals and two strips, as VTK's own writer encodes it.
TEST_F(ForeignVtk, IsTheSameInEveryEncodingOfVtk) {
  const auto corpus = std::filesystem::path(GEOPRIOR_SOURCE_DIR) / "tests" / "fuzz" / "corpus";
  std::optional<double> time;
  const Part text = read_foreign_vtk_part(corpus / "cube-text.vtp", time);
  EXPECT_EQ(text.points.rows(), 8);
  EXPECT_EQ(text.triangles.rows(), 12);
  EXPECT_EQ(text.require_array("velocity", NamedArray::On::points, 3).values(7, 2), -7);
  for (const char* name : {"cube-zlib.vtp", "cube-raw.vtp", "cube-lz4.vtp", "cube-lzma.vtp"}) {
    expect_equal(read_foreign_vtk_part(corpus / name, time), text);
  }
}

// Raw data may hold anything that looks like an element.
TEST_F(ForeignVtk, WithRawAppendedDataIsReadAsWell) {
  const std::array<float, 12> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::array<std::int32_t, 3> triangle{0, 1, 2};
  const std::int32_t end = 3;
  std::string raw;
  const auto append = [&](const void* data, std::uint32_t size) {
    raw.append(reinterpret_cast<const char*>(&size), sizeof size);
    raw.append(static_cast<const char*>(data), size);
  };
  append(points.data(), sizeof points);
  append(triangle.data(), sizeof triangle);
  append(&end, sizeof end);
  const std::string text =
      R"(<?xml version="1.0"?><!-- < > -->
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian" header_type="UInt32"><PolyData>
<Piece NumberOfPoints="4" NumberOfPolys="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="appended" offset="0"/></Points>
<Polys><DataArray type="Int32" Name="connectivity" format="appended" offset="52"/>
<DataArray type="Int32" Name="offsets" format="appended" offset="68"/></Polys>
</Piece></PolyData><AppendedData encoding="raw">_)" +
      raw + "<<<!DOCTYPE<a<a</AppendedData></VTKFile>";
  const Part part = read(text);
  EXPECT_EQ(part.points(3, 1), 1);
  EXPECT_EQ(part.triangles, Eigen::RowVector3i(0, 1, 2));
}

TEST_F(ForeignVtk, CellsAreCheckedBeforeTheyAreFollowed) {
  EXPECT_THAT(refusal(strip("0 1 2 700000000", "4")), HasSubstr("strip 0 refers to point 7"));
  EXPECT_THAT(refusal(strip("0 1 -2 3", "4")), HasSubstr("strip 0 refers to point -2"));
  EXPECT_THAT(refusal(strip("0 1", "2")), HasSubstr("strip 0 has 2 points"));
  EXPECT_THAT(refusal(polygons("0 1 2 3 4294967296 1", "3 6")),  // 0 in 32 bits
              HasSubstr("polygon 1 refers to point 4294967296"));
  EXPECT_THAT(refusal(polygons("0 1 2 1 2 3", "4 6")), HasSubstr("polygon 1 has 2 points"));
  EXPECT_THAT(refusal(polygons("0 1 2 1 2 3", "-3 6")), HasSubstr("offset"));
  EXPECT_THAT(refusal(polygons("0 1 2 1 2 3", "8 6")), HasSubstr("offset"));
  EXPECT_THAT(refusal(square(R"(NumberOfLines="1")", cells("Lines", "3", "1"))),
              HasSubstr("line 0 has 1 points"));
  EXPECT_THAT(refusal(square(R"(NumberOfVerts="1")", cells("Verts", "9", "1"))),
              HasSubstr("point 9"));
}

TEST_F(ForeignVtk, ThatDeclaresMoreThanItHoldsIsRefused) {
  const auto declares = HasSubstr("can hold");
  for (const char* name : {"Points", "Verts", "Lines", "Strips", "Polys"}) {
    const std::string count = std::string("NumberOf") + name + R"(="4000000000")";
    EXPECT_THAT(refusal("<VTKFile type=\"PolyData\"><PolyData><Piece " + count +
                        "></Piece></PolyData></VTKFile>"),
                declares);
  }
  const auto array = [](const std::string& attributes) {
    return square("", "<PointData><DataArray type=\"Int8\" Name=\"a\" format=\"ascii\" " +
                          attributes + ">1</DataArray></PointData>");
  };
  EXPECT_THAT(refusal(array(R"(NumberOfComponents="2000000000")")), declares);
  EXPECT_THAT(refusal(array(R"(NumberOfTuples="18446744073709551615")")), declares);
  EXPECT_THAT(refusal(array(R"(NumberOfTuples="-1")")), HasSubstr("a whole number"));
  EXPECT_THAT(refusal(image("0 2147483647 0 2147483647 0 1", "0 1 0 1 0 1"), ".vti"), declares);
  EXPECT_THAT(refusal(image("0 1 0 1 0 1", "-2147483648 2147483647 0 1 0 1"), ".vti"), declares);
  EXPECT_THAT(refusal(image("0 1 0 1 0 99999999999", "0 1 0 1 0 1"), ".vti"), HasSubstr("32 bits"));
  EXPECT_THAT(refusal(image("0 1 1 0 0 1", "0 1 0 1 0 1"), ".vti"), HasSubstr("before it begins"));
}

// VTK divides by the size of a block, and takes the number of whole blocks for one less.
TEST_F(ForeignVtk, WithBlocksThatContradictEachOtherIsRefused) {
  for (const bool inline_data : {true, false}) {
    const auto of = [&](const std::vector<std::uint32_t>& header) {
      return refusal(compressed(base64(header), inline_data));
    };
    EXPECT_THAT(of({1, 0, 24, 10}), HasSubstr("1 compressed blocks of 0 bytes"));
    EXPECT_THAT(of({0, 32768, 24}), HasSubstr("0 compressed blocks"));
    EXPECT_THAT(of({1, 32768, 32769, 10}), HasSubstr("the last of 32769"));
    EXPECT_THAT(of({4000000000, 32768, 0}), HasSubstr("can hold"));
    EXPECT_THAT(of({1, 4000000000, 0, 10}), HasSubstr("can hold"));
    EXPECT_THAT(of({1, 32768, 24, 4000000000}), HasSubstr("block has 4000000000 bytes"));
    EXPECT_THAT(refusal(compressed("AAAA==AQAAAAAAAAAAAA", inline_data)), HasSubstr("base64"));
  }
}

TEST_F(ForeignVtk, WhoseXmlIsMadeToHurtIsRefused) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(refusal("<VTKFile type=\"PolyData\"><PolyData>" + deep), HasSubstr("nested deeper"));
  EXPECT_THAT(refusal("<!DOCTYPE x [<!ENTITY a \"aaaa\">]>" + strip("0 1 2 3", "4")),
              HasSubstr("document type"));
  EXPECT_THAT(refusal(square("", R"(<PointData><DataArray type="Fl32" Name="a"/></PointData>)")),
              HasSubstr("has the type 'Fl32'"));
  EXPECT_THAT(refusal("<VTKFile type=\"PolyData\" header_type=\"&#85;Int64\"></VTKFile>"),
              HasSubstr("plain words"));
  EXPECT_THAT(refusal(std::string("<\0V\0T\0K\0", 8)), HasSubstr("UTF-8"));
  EXPECT_THAT(refusal(""), HasSubstr("no readable VTK file"));
  EXPECT_THAT(refusal("<VTKFile type=\"PolyData\"><PolyData></VTKFile>"),
              HasSubstr("no readable VTK file"));
}

TEST_F(ForeignVtk, WithPointsThatAreNotFiniteIsRefused) {
  Part part = sample_triangles();
  part.points(2, 1) = std::nan("");
  EXPECT_THAT(refusal(part_to_vtk_xml(part, 0)), HasSubstr("point 2 is not finite"));
  EXPECT_THAT(refusal(part_to_vtk_xml(sample_lines(), std::nan(""))), HasSubstr("TimeValue"));
}

TEST_F(ForeignVtk, CutAnywhereIsAnError) {
  for (const Part& part : part_samples()) {
    const std::string text = part_to_vtk_xml(part, 0), extension = part_extension(part);
    for (std::size_t i = 0; i < 50; ++i) {
      EXPECT_NE(refusal(text.substr(0, i * (text.size() - 2) / 49), extension), "") << i;
    }
  }
}

std::string with_flipped_bits(std::string text, RandomStream& random) {
  for (std::uint32_t left = 1 + random.below(3); left > 0; --left) {
    char& c = text[random.below(static_cast<std::uint32_t>(text.size()))];
    c = static_cast<char>(c ^ (1 << random.below(8)));
  }
  return text;
}

TEST_F(ForeignVtk, WithFlippedBitsIsReadOrAnError) {
  int read_anyway = 0, refused = 0;
  RandomStream random(1, "flipped bits");
  for (const Part& part : part_samples()) {
    const std::string text = part_to_vtk_xml(part, 0), extension = part_extension(part);
    for (int i = 0; i < 150; ++i) {
      try {
        (void)read(with_flipped_bits(text, random), extension);
        ++read_anyway;
      } catch (const Error& e) {
        ++refused;
        EXPECT_THAT(e.what(), AllOf(HasSubstr("foreign" + extension), Not(HasSubstr("(0x"))));
#ifndef __SANITIZE_ADDRESS__  // which ends the child where it has no memory
        EXPECT_THAT(e.what(), Not(HasSubstr("made to crash")));
#endif
      }
    }
  }
  RecordProperty("read_anyway", read_anyway);
  EXPECT_GT(refused, 300);
}

// A child may be made to reply anything.
TEST_F(ForeignVtk, RepliesThatDoNotFitTogetherAreRefused) {
  const auto refused = [](const Part& part) {
    std::optional<double> time;
    const State bytes = part_to_bytes(part, 1);
    return error_of([&] { (void)part_from_bytes(bytes, time, "f"); });
  };
  Part part = sample_triangles();
  part.triangles(1, 2) = 5;
  EXPECT_THAT(refused(part), HasSubstr("f: refers to point 5"));
  part = sample_lines();
  part.lines[2][0] = -1;
  EXPECT_THAT(refused(part), HasSubstr("f: refers to point -1"));
  part = sample_grid();
  part.grid_size = {2000000000, 2000000000, 2000000000};
  EXPECT_THAT(refused(part), HasSubstr("grid"));
  part = sample_points();
  part.arrays[0].values.conservativeResize(3, 1);
  EXPECT_THAT(refused(part), HasSubstr("'mass' has 3 rows"));
}

TEST_F(ForeignVtk, RepliesThatEndEarlyAreRefused) {
  for (const Part& part : part_samples()) {
    const State bytes = part_to_bytes(part, 1);
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
      std::optional<double> time;
      const State cut(bytes.begin(), bytes.begin() + size);
      EXPECT_NE(error_of([&] { (void)part_from_bytes(cut, time, "f"); }), "");
    }
  }
}

}  // namespace
}  // namespace geoprior::test
