#include "solvers/sketch/layers/frustum_band.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace geoprior::sketch {
namespace {

constexpr double kFirstStep = 0.02;  // of the search for the generator below which a point is (rad)
constexpr double kSameGenerator = 1e-7;  // rad
constexpr int kSecantSteps = 4;
constexpr int kPlaceBisections = 60;
constexpr double kUnrollStep = 0.005;  // rad

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

Eigen::Vector3d FrustumBand::own_rear(double s) const {
  return {0, rear_radius * std::cos(s), rear_radius * std::sin(s)};
}

Eigen::Vector3d FrustumBand::own_front(double t) const {
  const double y = front_radius * std::cos(t);
  return {-length + y * std::sin(front_tilt), front_rise + y * std::cos(front_tilt),
          front_radius * std::sin(t)};
}

double FrustumBand::front_angle(double s) const {
  if (!oblique()) return s;
  const double tilt = std::sin(front_tilt);
  const double a =
      length * std::cos(s) * std::cos(front_tilt) - (rear_radius - front_rise * std::cos(s)) * tilt;
  const double b = length * std::sin(s), w = front_radius * std::sin(s) * tilt;
  return std::atan2(b, a) - std::asin(std::clamp(w / std::hypot(a, b), -1.0, 1.0));
}

Eigen::Vector3d FrustumBand::own_generator(double s) const {
  return own_front(front_angle(s)) - own_rear(s);
}

Eigen::Vector3d FrustumBand::own_normal(double s) const {
  const Eigen::Vector3d along(0, -std::sin(s), std::cos(s));
  return own_generator(s).cross(along).normalized();
}

Eigen::Vector3d FrustumBand::point(double x, double s) const {
  if (!oblique())
    return rear + x * axis + radius_at(x) * (std::cos(s) * up + std::sin(s) * across());
  const Eigen::Vector3d p = own_rear(s) - x / length * own_generator(s);
  return rear + p.x() * axis + p.y() * up + p.z() * across();
}

Eigen::Vector3d FrustumBand::normal(double s) const {
  if (oblique()) {
    const Eigen::Vector3d n = own_normal(s);
    return n.x() * axis + n.y() * up + n.z() * across();
  }
  const double slope = (rear_radius - front_radius) / length;
  return (std::cos(s) * up + std::sin(s) * across() - slope * axis).normalized();
}

Eigen::Vector3d FrustumBand::own(const Eigen::Vector3d& P) const {
  const Eigen::Vector3d d = P - rear;
  return {d.dot(axis), d.dot(up), d.dot(across())};
}

double FrustumBand::behind_front(const Eigen::Vector3d& P) const {
  const Eigen::Vector3d p = own(P);
  return (p.x() + length) * std::cos(front_tilt) - (p.y() - front_rise) * std::sin(front_tilt);
}

double FrustumBand::height_above(const Eigen::Vector3d& P) const {
  const Eigen::Vector3d p = own(P);
  return std::hypot(p.y(), p.z()) - radius_at(p.x());
}

bool FrustumBand::rims_are_apart() const {
  constexpr int kSamples = 48;
  for (int k = 0; k <= kSamples; ++k) {
    const double s = half_angle * k / kSamples;
    if (!(behind_front(point(0, s)) > 0)) return false;
    if (!(own_front(front_angle(s)).x() < 0)) return false;
  }
  return true;
}

bool FrustumBand::has_below(const Eigen::Vector3d& P, double depth) const {
  const Eigen::Vector3d p = own(P);
  if (p.x() > 0) return true;
  if (!oblique()) {
    if (p.x() < -length) return true;
    const double slope = (rear_radius - front_radius) / length;
    return std::hypot(p.y(), p.z()) <= radius_at(p.x()) - depth * std::hypot(1.0, slope);
  }
  if (behind_front(P) < 0) return true;
  // The tangent plane that is highest above the point: there it lies beside the generator itself.
  const auto beside = [&](double s) {
    const Eigen::Vector3d along(0, -std::sin(s), std::cos(s)), generator = own_generator(s);
    return (p - own_rear(s)).dot(generator.cross(along).normalized().cross(generator));
  };
  double s = std::atan2(p.z(), p.y()), before = s + kFirstStep;
  double value = beside(s), value_before = beside(before);
  for (int i = 0; i < kSecantSteps && value != value_before; ++i) {
    const double next = s - value * (s - before) / (value - value_before);
    before = s;
    value_before = value;
    s = next;
    if (std::abs(s - before) < kSameGenerator) break;
    value = beside(s);
  }
  return (p - own_rear(s)).dot(own_normal(s)) <= -depth;
}

FrustumBand::Place FrustumBand::side_place(const Eigen::Vector3d& own) const {
  if (!oblique()) return {own.x(), std::acos(std::clamp(own.y() / radius_at(own.x()), -1.0, 1.0))};
  double low = 0, high = half_angle;
  const auto share = [&](double s) { return own.x() / own_generator(s).x(); };
  for (int i = 0; i < kPlaceBisections; ++i) {
    const double s = (low + high) / 2;
    const double y = own_rear(s).y() + share(s) * own_generator(s).y();
    (y > own.y() ? low : high) = s;
  }
  return {-length * share(low), low};
}

double FrustumBand::lower_border(double axial, double margin) const {
  if (!oblique()) {
    const double r = radius_at(axial);
    return r * std::cos(half_angle - margin / r);
  }
  const Eigen::Vector3d generator = own_generator(half_angle);
  const Eigen::Vector3d p = own_rear(half_angle) + axial / generator.x() * generator;
  const double r = std::hypot(p.y(), p.z());
  return r * std::cos(std::atan2(p.z(), p.y()) - margin / r);
}

double FrustumBand::slant() const {
  return oblique() ? own_generator(0).norm() : std::hypot(length, rear_radius - front_radius);
}

Eigen::Vector2d FrustumBand::unrolled(double x, double s) const {
  if (oblique()) return unrolled_oblique(x, s);
  const double bend = (rear_radius - front_radius) / slant();  // radians of the sector for one of s
  const double forward = -x / length * slant();
  const double r = radius_at(x), half = sinc(s * bend / 2);
  return {-r * s * sinc(s * bend), forward + r * s * s * bend / 2 * half * half};
}

/// Seen from outside, n x T is T turned to the left. The rim's curvature vector is -e / R, e its
/// radial direction, so that the flat rim turns by d psi = -e . (n x T) ds.
Eigen::Vector2d FrustumBand::unrolled_oblique(double x, double s) const {
  const auto turning = [&](double at) {
    const Eigen::Vector3d e(0, std::cos(at), std::sin(at)), along(0, -e.z(), e.y());
    return -e.dot(own_normal(at).cross(along));
  };
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(s) / kUnrollStep)));
  const double h = s / steps;
  double psi = 0;
  Eigen::Vector2d rim(0, 0);
  const auto along_rim = [&](double angle) -> Eigen::Vector2d {
    return rear_radius * Eigen::Vector2d(-std::cos(angle), -std::sin(angle));
  };
  double now = turning(0);
  for (int i = 0; i < steps; ++i) {
    // Simpson's rule for the angle at the end and, by the same parabola, in the middle.
    const double middle = turning((i + 0.5) * h), next = turning((i + 1) * h);
    const double half = psi + h * (5 * now + 8 * middle - next) / 24;
    const double end = psi + h * (now + 4 * middle + next) / 6;
    rim += h / 6 * (along_rim(psi) + 4 * along_rim(half) + along_rim(end));
    psi = end;
    now = next;
  }
  const Eigen::Vector3d along(0, -std::sin(s), std::cos(s)), generator = own_generator(s);
  const Eigen::Vector2d flat_along = along_rim(psi) / rear_radius;
  const Eigen::Vector2d flat_left(-flat_along.y(), flat_along.x());
  return rim - x / length *
                   (generator.dot(along) * flat_along +
                    generator.dot(own_normal(s).cross(along)) * flat_left);
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
