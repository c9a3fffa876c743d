#include "core/frame.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace geoprior {
namespace {

using On = NamedArray::On;

/// Two triangles with one array over points, one over cells.
Frame two_triangles() {
  Part part;
  part.points.setZero(4, 3);
  part.triangles.setZero(2, 3);
  part.arrays = {{"velocity", "m/s", On::points, Eigen::MatrixXd::Zero(4, 3)},
                 {"damage", "1", On::cells, Eigen::MatrixXd::Zero(2, 1)}};
  Frame frame;
  frame.parameter = 0.25;
  frame.parts["surface"] = part;
  frame.tables["sea"].columns = {"depth [m]"};
  return frame;
}

template <class Function>
std::string message(const Function& function) {
  try {
    static_cast<void>(function());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Frame, FindsPartsTablesAndArrays) {
  const Frame frame = two_triangles();
  const Part& part = frame.require_part("surface");
  EXPECT_EQ(frame.find_part("surface"), &part);
  EXPECT_EQ(&frame.require_part("surface", Part::Kind::triangles), &part);
  EXPECT_EQ(frame.find_part("rulings"), nullptr);
  EXPECT_EQ(frame.require_table("sea").columns.size(), 1U);
  EXPECT_EQ(frame.find_table("pieces"), nullptr);
  EXPECT_EQ(part.find_array("damage"), &part.arrays[1]);
  EXPECT_EQ(part.find_array("damage", On::points), nullptr);
  EXPECT_EQ(part.find_array("label"), nullptr);
  EXPECT_EQ(&frame.require_array("surface", "velocity", On::points), &part.arrays[0]);
  EXPECT_EQ(&frame.require_array("surface", "velocity", On::points, 3), &part.arrays[0]);
}

TEST(Frame, SaysWhatIsMissingAndWhatIsThere) {
  Frame frame = two_triangles();
  EXPECT_EQ(message([&] { return frame.require_part("rulings"); }),
            "frame at 0.25: has no part 'rulings', but: 'surface'");
  EXPECT_EQ(message([&] { return frame.require_part("surface", Part::Kind::lines); }),
            "frame at 0.25: part 'surface' is of kind triangles (allowed: lines)");
  EXPECT_EQ(message([&] { return frame.require_table("pieces"); }),
            "frame at 0.25: has no table 'pieces', but: 'sea'");
  EXPECT_EQ(message([] { return Frame().require_part("surface"); }),
            "frame at 0: has no part 'surface', but: none");
  EXPECT_EQ(message([&] { return frame.require_array("surface", "velocity", On::points, 1); }),
            "frame at 0.25, part 'surface': has no point array 'velocity' of 1 component, but: "
            "point array 'velocity' of 3 components, cell array 'damage' of 1 component");
  frame.parts["surface"].triangles.setZero(3, 3);
  EXPECT_EQ(message([&] { return frame.require_array("surface", "damage", On::cells, 1); }),
            "frame at 0.25, part 'surface': cell array 'damage' has 2 rows (allowed: 3, one a "
            "cell)");
}

TEST(Frame, PartsCountTheirPointsAndCells) {
  Part part;
  part.points.setZero(5, 3);
  part.triangles.setZero(2, 3);
  part.lines = {{0, 1}, {1, 2, 3}, {3, 4}};
  EXPECT_EQ(part.count(On::points), 5);
  EXPECT_EQ(part.count(On::cells), 2);
  part.kind = Part::Kind::lines;
  EXPECT_EQ(part.count(On::cells), 3);
  part.kind = Part::Kind::points;
  EXPECT_EQ(part.count(On::cells), 5);
  part.kind = Part::Kind::grid;
  part.grid_size = {4, 3, 1};
  EXPECT_EQ(part.count(On::points), 12);
  EXPECT_EQ(part.count(On::cells), 6);
}

}  // namespace
}  // namespace geoprior
