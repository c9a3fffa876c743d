// Names of values in VTK files: what comes back, and what does not.
#include "testbed/formats/vtk/value_names.h"

#include <gmock/gmock.h>

#include <fstream>

#include "core/error.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/formats/vtk/part_bytes.h"
#include "tests/testbed/formats/part_samples.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Four points with an array `organ` over them.
Part organs(const Eigen::Vector4d& values, std::vector<std::string> names) {
  Part part = sample_points();
  part.arrays = {{"organ", "1", NamedArray::On::points, values, std::move(names)}};
  return part;
}

/// A file of two points whose array `organ` has these values, with further field data.
std::string organ_file(const std::string& values, const std::string& fields) {
  return R"(<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData><FieldData>)" +
         fields +
         R"(</FieldData><Piece NumberOfPoints="2"><Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0</DataArray></Points>
<PointData><DataArray type="Float64" Name="organ" format="ascii">)" +
         values + "</DataArray></PointData></Piece></PolyData></VTKFile>";
}

/// Characters as VTK writes them in text: each as its number, a zero behind each name.
std::string names_field(const std::string& name, const std::vector<std::string>& names) {
  std::string text = "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" +
                     std::to_string(names.size()) + "\" format=\"ascii\">";
  for (const std::string& one : names) {
    for (const char c : one) text += std::to_string(static_cast<unsigned char>(c)) + " ";
    text += "0 ";
  }
  return text + "</Array>";
}

class ValueNames : public RunTest {
 protected:
  [[nodiscard]] Part read(const std::string& text) const {
    const auto file = folder() / "organs.vtp";
    std::ofstream(file, std::ios::binary) << text;
    std::optional<double> time;
    return read_foreign_vtk_part(file, time);
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    return error_of([&] { (void)read(text); });
  }
};

TEST_F(ValueNames, ComeBackFromAFileInTheirOrder) {
  const Part part = organs({2, 0, 0, 1}, {"kidney", "ureter", "vessie (blåsa)"});
  expect_equal(read(part_to_vtk_xml(part, 0)), part);
  EXPECT_EQ(part_to_vtk_xml(part, 0), part_to_vtk_xml(part, 0));
  EXPECT_NE(part_to_vtk_xml(part, 0),
            part_to_vtk_xml(organs({2, 0, 0, 1}, {"kidney", "ureter", "bladder"}), 0))
      << "names are part of what a run's checksums are of";
}

TEST_F(ValueNames, AreWhatOtherProgramsReadAsStringsOfTheFieldData) {
  const std::string xml = part_to_vtk_xml(organs({1, 0, 0, 1}, {"kidney", "ureter"}), 0);
  EXPECT_THAT(xml, HasSubstr("<Array type=\"String\" Name=\"organ_names\" NumberOfTuples=\"2\""));
  const Part part = read(organ_file("1 0", names_field("organ_names", {"kidney", "ureter"})));
  EXPECT_THAT(part.arrays.at(0).names, ElementsAre("kidney", "ureter"));
}

TEST_F(ValueNames, OfManyArraysAndOfBothElementsAreKeptApart) {
  Part part = sample_triangles();
  part.arrays = {
      {"organ", "1", NamedArray::On::points, Eigen::VectorXd::Ones(5), {"kidney", "ureter"}},
      {"organ", "1", NamedArray::On::cells, Eigen::Vector3d(0, 1, 0), {"kidney", "ureter"}},
      {"side", "1", NamedArray::On::cells, Eigen::Vector3d(0, 0, 0), {"left"}},
      {"side_names", "1", NamedArray::On::cells, Eigen::Vector3d(7, 7.5, 7)}};
  expect_equal(read(part_to_vtk_xml(part, 0)), part);
  part.arrays[1].names = {"ureter", "kidney"};
  EXPECT_THAT(error_of([&] { (void)part_to_vtk_xml(part, 0); }),
              AllOf(HasSubstr("'organ'"), HasSubstr("other names over points")));
}

TEST_F(ValueNames, ThatDoNotFitTheValuesAreNotWritten) {
  const auto refused = [](const Part& part) {
    return error_of([&] { (void)part_to_vtk_xml(part, 0); });
  };
  EXPECT_THAT(refused(organs({0, 1, 2, 0}, {"kidney", "ureter"})),
              AllOf(HasSubstr("'organ'"), HasSubstr("row 2"), HasSubstr("0 to 1")));
  EXPECT_THAT(refused(organs({0, 0.5, 0, 0}, {"kidney", "ureter"})), HasSubstr("0.5"));
  EXPECT_THAT(refused(organs({0, -1, 0, 0}, {"kidney"})), HasSubstr("-1"));
  EXPECT_THAT(refused(organs({0, std::nan(""), 0, 0}, {"kidney"})), HasSubstr("nan"));
  EXPECT_THAT(refused(organs({0, 0, 0, 0}, {"kidney", ""})), HasSubstr("name of 1 is empty"));
  EXPECT_THAT(refused(organs({0, 0, 0, 0}, {std::string("kid\0ney", 7)})), HasSubstr("no text"));
  const std::vector<std::string> many(kMostValueNames + 1, "kidney");
  EXPECT_THAT(refused(organs({0, 0, 0, 0}, many)), HasSubstr("65537 names"));
}

TEST_F(ValueNames, OfAHostileFileAreAnErrorThatNamesFileAndArray) {
  const std::string two = names_field("organ_names", {"kidney", "ureter"});
  for (const char* values : {"0 2", "0 -1", "0 1.5", "0 1e300", "nan 0"}) {
    EXPECT_THAT(refusal(organ_file(values, two)),
                AllOf(HasSubstr("organs.vtp"), HasSubstr("'organ'"), HasSubstr("has no name")))
        << values;
  }
  EXPECT_THAT(refusal(organ_file("0 1", names_field("organ_names", {"kidney", ""}))),
              HasSubstr("is empty"));
  EXPECT_THAT(refusal(organ_file("0 1",
                                 "<Array type=\"String\" Name=\"organ_names\" "
                                 "NumberOfTuples=\"3000000000\" format=\"ascii\">0</Array>")),
              HasSubstr("organs.vtp"));
  const std::string padding(20000, ' ');
  EXPECT_THAT(refusal(organ_file("0 1",
                                 "<Array type=\"String\" NumberOfTuples=\"2000000\" "
                                 "Name=\"organ_names\" format=\"ascii\">0</Array>" +
                                     padding)),
              HasSubstr("has 2000000 texts"));
  const std::vector<std::string> many(kMostValueNames + 1, "k");
  EXPECT_THAT(refusal(organ_file("0 1", names_field("organ_names", many))),
              HasSubstr("65537 names"));
}

// A list of numbers, of another array, or of nothing names no values.
TEST_F(ValueNames, OfNoListOfStringsAreNone) {
  const std::string numbers =
      "<DataArray type=\"Float64\" Name=\"organ_names\" NumberOfTuples=\"1\" "
      "format=\"ascii\">3</DataArray>";
  EXPECT_TRUE(read(organ_file("0.5 7", numbers)).arrays.at(0).names.empty());
  const std::string other = names_field("bone_names", {"femur"});
  EXPECT_TRUE(read(organ_file("0.5 7", other)).arrays.at(0).names.empty());
  const std::string none = names_field("organ_names", {});
  EXPECT_TRUE(read(organ_file("0.5 7", none)).arrays.at(0).names.empty());
}

TEST_F(ValueNames, OfAReplyThatDoNotFitAreRefused) {
  const Part part = organs({0, 1, 2, 0}, {"kidney", "ureter"});
  std::optional<double> time;
  EXPECT_THAT(error_of([&] { (void)part_from_bytes(part_to_bytes(part, 1), time, "f"); }),
              AllOf(HasSubstr("f: array 'organ'"), HasSubstr("has no name")));
}

}  // namespace
}  // namespace geoprior::test
