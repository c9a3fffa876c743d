#include <gmock/gmock.h>

#include <fstream>

#include "core/error.h"
#include "testbed/formats/vtk/files.h"
#include "tests/testbed/formats/part_samples.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::HasSubstr;

class VtkFiles : public RunTest {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder() / name, std::ios::binary) << text;
    return folder() / name;
  }
};

// Float64 and no rounding anywhere: what is read back decides metrics of a resumed run.
TEST_F(VtkFiles, GiveBackEveryKindOfPartBitByBit) {
  for (const Part& part : part_samples()) {
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
  EXPECT_EQ(part_to_vtk_xml(sample_triangles(), 2), part_to_vtk_xml(sample_triangles(), 2));
  EXPECT_EQ(part_to_vtk_xml(sample_grid(), 2), part_to_vtk_xml(sample_grid(), 2));
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
  for (const Part& part : {sample_triangles(), sample_grid()}) {
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
  Part part = sample_triangles();
  part.arrays[1].values.conservativeResize(2, 1);
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("'strain'"));
  part = sample_triangles();
  part.triangles(2, 1) = 5;
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("cell 2"));
  part = sample_lines();
  part.lines[2] = {4};
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }), HasSubstr("poly-line 2"));
  part = sample_triangles();
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
