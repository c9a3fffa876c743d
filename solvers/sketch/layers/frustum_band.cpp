#include "solvers/sketch/layers/frustum_band.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace geoprior::sketch {
namespace {

/// sin(a) / a.
double sinc(double a) { return std::abs(a) < 1e-4 ? 1 - a * a / 6 : std::sin(a) / a; }

/// s of column k; exactly symmetric about the middle.
double rim_angle(const FrustumBand& band, const BandGrid& grid, int k) {
  return band.half_angle * (2.0 * k - grid.around) / grid.around;
}

/// Vertices of the band moved inwards by a depth, row by row from the front.
Eigen::MatrixX3d band_points(const FrustumBand& band, const BandGrid& grid, double depth) {
  Eigen::MatrixX3d points(Eigen::Index{grid.along + 1} * (grid.around + 1), 3);
  Eigen::Index row = 0;
  for (int i = 0; i <= grid.along; ++i) {
    const double x = -band.length * (grid.along - i) / grid.along;
    for (int k = 0; k <= grid.around; ++k) {
      const double s = rim_angle(band, grid, k);
      points.row(row++) = (band.point(x, s) - depth * band.normal(s)).transpose();
    }
  }
  return points;
}

}  // namespace

Eigen::Vector3d FrustumBand::across() const { return axis.cross(up); }

double FrustumBand::radius_at(double x) const {
  return rear_radius + (rear_radius - front_radius) * x / length;
}

Eigen::Vector3d FrustumBand::point(double x, double s) const {
  return rear + x * axis + radius_at(x) * (std::cos(s) * up + std::sin(s) * across());
}

Eigen::Vector3d FrustumBand::normal(double s) const {
  const double slope = (rear_radius - front_radius) / length;
  return (std::cos(s) * up + std::sin(s) * across() - slope * axis).normalized();
}

Eigen::Vector3d FrustumBand::own(const Eigen::Vector3d& P) const {
  const Eigen::Vector3d d = P - rear;
  return {d.dot(axis), d.dot(up), d.dot(across())};
}

double FrustumBand::slant() const { return std::hypot(length, rear_radius - front_radius); }

Eigen::Vector2d FrustumBand::unrolled(double x, double s) const {
  const double bend = (rear_radius - front_radius) / slant();  // radians of the sector for one of s
  const double forward = -x / length * slant();
  const double r = radius_at(x), half = sinc(s * bend / 2);
  return {-r * s * sinc(s * bend), forward + r * s * s * bend / 2 * half * half};
}

TriMesh band_sheet(const FrustumBand& band, const BandGrid& grid) {
  TriMesh sheet;
  sheet.V = band_points(band, grid, 0);
  sheet.F.resize(Eigen::Index{2} * grid.along * grid.around, 3);
  Eigen::Index t = 0;
  for (int i = 0; i < grid.along; ++i) {
    for (int k = 0; k < grid.around; ++k) {
      const int a = i * (grid.around + 1) + k, b = a + 1, c = a + grid.around + 1, d = c + 1;
      sheet.F.row(t++) << a, b, c;
      sheet.F.row(t++) << b, d, c;
    }
  }
  return sheet;
}

TriMesh band_solid(const FrustumBand& band, double thickness, const BandGrid& grid) {
  const TriMesh outside = band_sheet(band, grid);
  const int n = outside.vertex_count(), row = grid.around + 1;
  TriMesh solid;
  solid.V.resize(2 * outside.V.rows(), 3);
  solid.V << outside.V, band_points(band, grid, thickness);
  std::vector<Eigen::RowVector3i> faces;
  for (Eigen::Index t = 0; t < outside.F.rows(); ++t) {
    const Eigen::RowVector3i f = outside.F.row(t);
    faces.push_back(f);
    faces.emplace_back(f[0] + n, f[2] + n, f[1] + n);
  }
  // Borders of the sheet, run through with the sheet on their left.
  const auto close = [&](int a, int b) {
    faces.emplace_back(b, a, a + n);
    faces.emplace_back(b, a + n, b + n);
  };
  const int last = grid.along * row;
  for (int k = 0; k < grid.around; ++k) {
    close(k, k + 1);
    close(last + k + 1, last + k);
  }
  for (int i = 0; i < grid.along; ++i) {
    close((i + 1) * row, i * row);
    close(i * row + grid.around, (i + 1) * row + grid.around);
  }
  solid.F.resize(faces.size(), 3);
  for (std::size_t t = 0; t < faces.size(); ++t) solid.F.row(t) = faces[t];
  return solid;
}

}  // namespace geoprior::sketch
