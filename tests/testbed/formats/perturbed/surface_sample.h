#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior::test {

/// A surface that a generator of files knows: points on a plane whose coordinates are multiples of
/// 1/64, so that each format holds them exactly, and convex faces of three or four corners. Its
/// numbers are computed here, from its own arrays.
struct SurfaceSample {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> faces;

  [[nodiscard]] double area_of(const std::vector<int>& face) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < face.size(); ++k)
      sum += points[face[k]].cross(points[face[(k + 1) % face.size()]]);
    return sum.norm() / 2;
  }
  [[nodiscard]] double area() const {
    return std::accumulate(faces.begin(), faces.end(), 0.0,
                           [&](double sum, const auto& face) { return sum + area_of(face); });
  }
  [[nodiscard]] std::size_t triangle_count() const {
    return std::accumulate(faces.begin(), faces.end(), std::size_t{0},
                           [](std::size_t sum, const auto& face) { return sum + face.size() - 2; });
  }
};

inline bool chance(RandomStream& random, double share) { return random.uniform() < share; }

template <class T>
void shuffle(RandomStream& random, std::vector<T>& list) {
  for (std::size_t i = list.size(); i > 1; --i)
    std::swap(list[i - 1], list[random.below(static_cast<std::uint32_t>(i))]);
}

/// A grid of cells, each a quadrangle or two triangles, numbered at random.
/// @param triangles_only  no quadrangles
inline SurfaceSample surface_sample(RandomStream& random, bool triangles_only) {
  const int columns = 2 + static_cast<int>(random.below(4));
  const int rows = 2 + static_cast<int>(random.below(4));
  const double a = random.below(5), b = random.below(5), s = (1 + random.below(128)) / 64.0;
  SurfaceSample sample;
  std::vector<int> number(columns * rows);
  std::iota(number.begin(), number.end(), 0);
  shuffle(random, number);
  sample.points.resize(number.size());
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i)
      sample.points[number[j * columns + i]] = {s * i - 2, s * j + 1, s * (a * i - b * j)};
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const auto at = [&](int di, int dj) { return number[(j + dj) * columns + i + di]; };
      if (!triangles_only && chance(random, 0.5)) {
        sample.faces.push_back({at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
      } else {
        sample.faces.push_back({at(0, 0), at(1, 0), at(1, 1)});
        sample.faces.push_back({at(0, 0), at(1, 1), at(0, 1)});
      }
    }
  }
  shuffle(random, sample.faces);
  return sample;
}

/// A number as programs write them, exact for multiples of 1/64 below 1000.
inline std::string number_text(RandomStream& random, double x) {
  constexpr std::array<const char*, 5> kFormats{"%.17g", "%.9g", "%.8f", "%.10e", "%.10E"};
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), kFormats[random.below(kFormats.size())], x);
  std::string out = text.data();
  if (x > 0 && chance(random, 0.1)) out.insert(0, "+");
  return out;
}

inline std::string blank(RandomStream& random) {
  constexpr std::array<const char*, 4> kBlanks{" ", "  ", "\t", " \t "};
  return kBlanks[random.below(kBlanks.size())];
}

inline double triangles_area(const TriMesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                          c = mesh.V.row(mesh.F(t, 2));
    sum += (b - a).cross(c - a).norm() / 2;
  }
  return sum;
}

/// Points in their order, and triangles of the right number, area and sense.
inline void expect_sample(const MeshFile& read, const SurfaceSample& sample) {
  ASSERT_EQ(read.mesh.V.rows(), std::ssize(sample.points));
  for (Eigen::Index v = 0; v < read.mesh.V.rows(); ++v)
    ASSERT_EQ(read.mesh.V.row(v), sample.points[v].transpose()) << "vertex " << v;
  EXPECT_EQ(read.mesh.F.rows(),
            std::ssize(sample.faces) == 0 ? 0 : static_cast<Eigen::Index>(sample.triangle_count()));
  EXPECT_NEAR(triangles_area(read.mesh), sample.area(), 1e-12 * (1 + sample.area()));
  const Eigen::Vector3d up = sample.faces.empty() ? Eigen::Vector3d::UnitZ() : [&] {
    const auto& f = sample.faces.front();
    return Eigen::Vector3d((sample.points[f[1]] - sample.points[f[0]])
                               .cross(sample.points[f[2]] - sample.points[f[0]]));
  }();
  for (Eigen::Index t = 0; t < read.mesh.F.rows(); ++t) {
    const Eigen::Vector3d a = read.mesh.V.row(read.mesh.F(t, 0)),
                          b = read.mesh.V.row(read.mesh.F(t, 1)),
                          c = read.mesh.V.row(read.mesh.F(t, 2));
    EXPECT_GT((b - a).cross(c - a).dot(up), 0) << "triangle " << t;
  }
}

}  // namespace geoprior::test
