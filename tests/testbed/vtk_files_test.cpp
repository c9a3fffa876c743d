#include "testbed/formats/vtk_files.h"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::HasSubstr;

Eigen::MatrixXd noise(Eigen::Index rows, Eigen::Index columns, std::string_view purpose) {
  RandomStream random(1, purpose);
  Eigen::MatrixXd values(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) values(i, j) = random.normal() * 1e-3;
  }
  return values;
}

Part triangles() {
  Part part;
  part.points = noise(5, 3, "points");
  part.triangles.resize(3, 3);
  part.triangles << 0, 1, 2, 2, 3, 4, 4, 0, 2;
  part.arrays = {{"normal", "1", NamedArray::On::points, noise(5, 3, "normal")},
                 {"strain", "1/s", NamedArray::On::cells, noise(3, 1, "strain")},
                 {"no unit", "", NamedArray::On::cells, noise(3, 4, "other")}};
  part.arrays[0].values(1, 2) = std::numeric_limits<double>::quiet_NaN();
  return part;
}

Part lines() {
  Part part;
  part.kind = Part::Kind::lines;
  part.points = noise(6, 3, "points");
  part.lines = {{0, 1, 2}, {5, 3}, {4, 0, 4}};
  part.arrays = {{"width", "m", NamedArray::On::cells, noise(3, 1, "width")}};
  return part;
}

Part points() {
  Part part;
  part.kind = Part::Kind::points;
  part.points = noise(4, 3, "points");
  part.arrays = {{"mass", "kg", NamedArray::On::points, noise(4, 1, "mass")}};
  return part;
}

Part grid() {
  Part part;
  part.kind = Part::Kind::grid;
  part.grid_size = {4, 3, 2};
  part.grid_origin = {-0.1, 0.2, 1.0 / 3};
  part.grid_spacing = {0.1, 0.3, 0.7};
  part.arrays = {{"density", "kg/m^3", NamedArray::On::points, noise(24, 1, "density")},
                 {"flux", "m/s", NamedArray::On::cells, noise(6, 3, "flux")}};
  return part;
}

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double x = a(i % a.rows(), i / a.rows());
    const double y = b(i % a.rows(), i / a.rows());
    if (std::memcmp(&x, &y, sizeof x) != 0) return false;
  }
  return true;
}

void expect_equal(const Part& a, const Part& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_TRUE(same_bits(a.points, b.points));
  EXPECT_TRUE(a.triangles.rows() == b.triangles.rows() && a.triangles == b.triangles);
  EXPECT_EQ(a.lines, b.lines);
  EXPECT_EQ(a.grid_size, b.grid_size);
  EXPECT_EQ(a.grid_origin, b.grid_origin);
  EXPECT_EQ(a.grid_spacing, b.grid_spacing);
  ASSERT_EQ(a.arrays.size(), b.arrays.size());
  for (std::size_t i = 0; i < a.arrays.size(); ++i) {
    EXPECT_EQ(a.arrays[i].name, b.arrays[i].name);
    EXPECT_EQ(a.arrays[i].unit, b.arrays[i].unit);
    EXPECT_EQ(a.arrays[i].on, b.arrays[i].on);
    EXPECT_TRUE(same_bits(a.arrays[i].values, b.arrays[i].values)) << a.arrays[i].name;
  }
}

class VtkFiles : public RunTest {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder() / name, std::ios::binary) << text;
    return folder() / name;
  }
};

// Float64 and no rounding anywhere: what is read back decides metrics of a resumed run.
TEST_F(VtkFiles, GiveBackEveryKindOfPartBitByBit) {
  for (const Part& part : {triangles(), lines(), points(), grid()}) {
    const auto file = write("part" + part_extension(part), part_to_vtk_xml(part, 1.0 / 3));
    double parameter = 0;
    expect_equal(read_vtk_part(file, &parameter), part);
    EXPECT_EQ(parameter, 1.0 / 3);
  }
}

TEST_F(VtkFiles, GiveBackPartsWithoutCells) {
  for (const auto kind : {Part::Kind::triangles, Part::Kind::lines, Part::Kind::points}) {
    Part part;
    part.kind = kind;
    if (kind != Part::Kind::points) part.points = noise(2, 3, "points");
    const auto file = write("part.vtp", part_to_vtk_xml(part, 0));
    expect_equal(read_vtk_part(file), part);
  }
}

TEST_F(VtkFiles, OfEqualPartsAreEqual) {
  EXPECT_EQ(part_to_vtk_xml(triangles(), 2), part_to_vtk_xml(triangles(), 2));
  EXPECT_EQ(part_to_vtk_xml(grid(), 2), part_to_vtk_xml(grid(), 2));
}

TEST_F(VtkFiles, OfOthersAreReadInAsciiAndPolygonsBecomeTriangles) {
  const auto file = write("quad.vtp", R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="4" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>
<Polys><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4</DataArray></Polys>
</Piece></PolyData></VTKFile>)");
  const Part part = read_vtk_part(file);
  EXPECT_EQ(part.kind, Part::Kind::triangles);
  EXPECT_EQ(part.triangles.rows(), 2);
  EXPECT_EQ(part.points.rows(), 4);
  EXPECT_THAT(error_of([&] {
                double parameter = 0;
                (void)read_vtk_part(file, &parameter);
              }),
              HasSubstr("TimeValue"));
}

TEST_F(VtkFiles, CutInHalfAreOneErrorThatNamesTheFile) {
  for (const Part& part : {triangles(), grid()}) {
    const std::string text = part_to_vtk_xml(part, 0);
    const auto file = write("cut" + part_extension(part), text.substr(0, text.size() / 2));
    EXPECT_THAT(error_of([&] { (void)read_vtk_part(file); }), HasSubstr(file.string()));
  }
}

TEST_F(VtkFiles, OutOfRangeIndexInAFileIsAnError) {
  std::string text = R"(<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="1" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0</DataArray></Points>
<Polys><DataArray type="Int64" Name="connectivity" format="ascii">0 0 7</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray></Polys>
</Piece></PolyData></VTKFile>)";
  const auto file = write("index.vtp", text);
  EXPECT_THAT(error_of([&] { (void)read_vtk_part(file); }), HasSubstr("point 7"));
}

TEST(VtkText, OfABadPartIsAnErrorThatNamesArrayOrCell) {
  Part part = triangles();
  part.arrays[1].values.conservativeResize(2, 1);
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("'strain'"));
  part = triangles();
  part.triangles(2, 1) = 5;
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("cell 2"));
  part = lines();
  part.lines[2] = {4};
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("poly-line 2"));
  part = triangles();
  part.arrays[2].name = "strain";
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("twice"));
}

TEST(VtkText, OfACollectionEscapesNamesAndKeepsParameters) {
  const std::string text = pvd_text({{0.1, "a&b/x_0000.vtp", "x<y"}});
  EXPECT_THAT(text, HasSubstr("file=\"a&amp;b/x_0000.vtp\""));
  EXPECT_THAT(text, HasSubstr("name=\"x&lt;y\""));
  EXPECT_THAT(text, HasSubstr("timestep=\"0.10000000000000001\""));
}

}  // namespace
}  // namespace geoprior::test
