#include "tests/testbed/formats/part_samples.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/random.h"

namespace geoprior::test {
namespace {

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double x = a(i % a.rows(), i / a.rows());
    const double y = b(i % a.rows(), i / a.rows());
    if (std::memcmp(&x, &y, sizeof x) != 0) return false;
  }
  return true;
}

}  // namespace

Eigen::MatrixXd noise(Eigen::Index rows, Eigen::Index columns, std::string_view purpose) {
  RandomStream random(1, purpose);
  Eigen::MatrixXd values(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) values(i, j) = random.normal() * 1e-3;
  }
  return values;
}

Part sample_triangles() {
  Part part;
  part.points = noise(5, 3, "points");
  part.triangles.resize(3, 3);
  part.triangles << 0, 1, 2, 2, 3, 4, 4, 0, 2;
  part.arrays = {{"normal", "1", NamedArray::On::points, noise(5, 3, "normal")},
                 {"strain", "1/s", NamedArray::On::cells, noise(3, 1, "strain")},
                 {"no unit", "", NamedArray::On::cells, noise(3, 4, "other")},
                 {"kind",
                  "1",
                  NamedArray::On::cells,
                  Eigen::Vector3d(1, 0, 1),
                  {"flat", "cône & <\"zylinder\">", "unseen"}}};
  part.arrays[0].values(1, 2) = std::numeric_limits<double>::quiet_NaN();
  return part;
}

Part sample_lines() {
  Part part;
  part.kind = Part::Kind::lines;
  part.points = noise(6, 3, "points");
  part.lines = {{0, 1, 2}, {5, 3}, {4, 0, 4}};
  part.arrays = {{"width", "m", NamedArray::On::cells, noise(3, 1, "width")}};
  return part;
}

Part sample_points() {
  Part part;
  part.kind = Part::Kind::points;
  part.points = noise(4, 3, "points");
  part.arrays = {{"mass", "kg", NamedArray::On::points, noise(4, 1, "mass")}};
  return part;
}

Part sample_grid() {
  Part part;
  part.kind = Part::Kind::grid;
  part.grid_size = {4, 3, 2};
  part.grid_origin = {-0.1, 0.2, 1.0 / 3};
  part.grid_spacing = {0.1, 0.3, 0.7};
  part.arrays = {{"density", "kg/m^3", NamedArray::On::points, noise(24, 1, "density")},
                 {"flux", "m/s", NamedArray::On::cells, noise(6, 3, "flux")}};
  return part;
}

std::array<Part, 4> part_samples() {
  return {sample_triangles(), sample_lines(), sample_points(), sample_grid()};
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
    EXPECT_EQ(a.arrays[i].names, b.arrays[i].names);
    EXPECT_TRUE(same_bits(a.arrays[i].values, b.arrays[i].values)) << a.arrays[i].name;
  }
}

}  // namespace geoprior::test
