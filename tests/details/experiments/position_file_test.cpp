// Positions as spreadsheets and other programs leave them.

#include "experiments/details/scene/position_file.h"

#include <gtest/gtest.h>

#include "tests/support/text_forms.h"
#include "tests/testbed/formats/octahedron.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::details {
namespace {

class PositionFiles : public test::ScratchFolder {
 protected:
  [[nodiscard]] std::vector<Detail> read(const std::string& name, const std::string& bytes) {
    warnings.clear();
    return details_of_file(write(name, bytes), test::octahedron(), 1e-6, warnings);
  }
  /// A corner of the octahedron, and the middle of an edge.
  void expect_both(const std::vector<Detail>& details, double weight) {
    ASSERT_EQ(details.size(), 2U);
    EXPECT_EQ(details[0].weight, weight);
    EXPECT_EQ(details[1].weight, 1);
    EXPECT_EQ(details[1].type, 2);
  }

  std::vector<std::string> warnings;
};

TEST_F(PositionFiles, AreReadInEveryForm) {
  const std::string comma = "# in m\nX,\"y\",z,Weight,type\n1,0,0,0.5,\n0.5,0.5,0,,2\n";
  const std::string semicolon = "x;y;z;WEIGHT;type\n1;0;0;0,5;\n0,5;0,5;0;;2\n";
  for (const std::string& text : {comma, semicolon}) {
    for (const test::TextForm& form : test::text_forms(text)) {
      SCOPED_TRACE(form.name);
      expect_both(read("a.csv", form.bytes), 0.5);
    }
  }
  expect_both(read("A.CSV", comma), 0.5);
  test::expect_error([&] { (void)read("a.csv", test::in_utf16(comma)); }, {"a.csv", "UTF-16"});
}

TEST_F(PositionFiles, OfMeshesSayWhatIsLeftOut) {
  EXPECT_EQ(read("a.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nl 1 2\n").size(), 3U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("a.obj: 1 line 'l' left out"), std::string::npos);
}

}  // namespace
}  // namespace geoprior::details
