#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "experiments/embryo/measures/surfaces.h"

namespace geoprior::embryo {
namespace {

/// The first-order distance |f| / |grad f| of f = |(x / (a s), y / (b s), z / c)| - 1 with the
/// egg's scale s, in local coordinates; its error is of second order in the distance.
double ovoid_distance(const Shape& shape, const Eigen::Vector3d& x) {
  const Eigen::Vector3d p = shape.axes.transpose() * (x - shape.center);
  const Eigen::Vector3d r = shape.radii;
  const double s = std::max(1 + shape.egg * p.z() / r.z(), 1e-3);
  const double g2 = (p.x() * p.x() / (r.x() * r.x()) + p.y() * p.y() / (r.y() * r.y())) / (s * s);
  const double f = std::sqrt(g2 + p.z() * p.z() / (r.z() * r.z()));
  if (f == 0) return r.minCoeff();
  const Eigen::Vector3d gradient(p.x() / (r.x() * r.x() * s * s), p.y() / (r.y() * r.y() * s * s),
                                 p.z() / (r.z() * r.z()) - g2 * shape.egg / (s * r.z()));
  return std::abs(f - 1) * f / gradient.norm();
}

double cylinder_distance(const Shape& shape, const Eigen::Vector3d& x) {
  const Eigen::Vector3d p = shape.axes.transpose() * (x - shape.center);
  const double reach = shape.radii.z() - shape.radii.x();
  const Eigen::Vector3d axis(0, 0, std::clamp(p.z(), -reach, reach));
  return std::abs((p - axis).norm() - shape.radii.x());
}

/// A recorded centre line as round cones: distance of a point from the nearest.
class CentreLine {
 public:
  CentreLine(const Part& part, const std::vector<int>& line) {
    const NamedArray& radius =
        part.require_array(recorded::kRadius, NamedArray::On::points, 1, recorded::kCentrelines);
    for (const int i : line) {
      points_.push_back(part.points.row(i).transpose());
      radii_.push_back(radius.values(i, 0));
    }
  }
  [[nodiscard]] double smallest_radius() const {
    return *std::min_element(radii_.begin(), radii_.end());
  }
  [[nodiscard]] double distance(const Eigen::Vector3d& x) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < points_.size(); ++i)
      least = std::min(least, cone_distance(x, static_cast<int>(i)));
    return std::abs(least);
  }

 private:
  /// min over s of |x - p(s)| - r(s): of the balls along a segment, whose radius grows by k a
  /// metre, the nearest is h k / sqrt(1 - k^2) beyond the foot of x, h from the axis.
  [[nodiscard]] double cone_distance(const Eigen::Vector3d& x, int i) const {
    const Eigen::Vector3d d = points_[i + 1] - points_[i];
    const double length = d.norm();
    if (length == 0) return (x - points_[i]).norm() - radii_[i];
    const double z = (x - points_[i]).dot(d) / length;
    const double h = (x - points_[i] - z / length * d).norm();
    const double k = (radii_[i + 1] - radii_[i]) / length;
    const double beyond = std::abs(k) < 1 ? h * k / std::sqrt(1 - k * k) : 0;
    const double s = std::clamp(z + beyond, 0.0, length);
    return std::hypot(h, z - s) - (radii_[i] + k * s);
  }

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radii_;
};

std::map<int, CentreLine> centre_lines(const Frame& frame) {
  std::map<int, CentreLine> lines;
  const Part* part = frame.find_part(recorded::kCentrelines);
  if (part == nullptr) return lines;
  const NamedArray& codes =
      part->require_array(recorded::kStructure, NamedArray::On::cells, 1, recorded::kCentrelines);
  for (std::size_t l = 0; l < part->lines.size(); ++l)
    lines.emplace(static_cast<int>(codes.values(static_cast<Eigen::Index>(l), 0)),
                  CentreLine(*part, part->lines[l]));
  return lines;
}

/// What a division may cut: their surfaces are not those of their shapes.
std::set<int> cut_structures(const Ontology& ontology) {
  std::set<int> found;
  for (const ProcessEntry& process : ontology.processes) {
    if (process.kind != ProcessKind::division) continue;
    found.insert(process.acts_on.begin(), process.acts_on.end());
    found.insert(process.produces.begin(), process.produces.end());
  }
  return found;
}

}  // namespace

std::optional<double> surface_error(const EmbryoScene& scene, const Frame& frame,
                                    const std::vector<RecordedPiece>& pieces) {
  const std::vector<RecordedShape> shapes = recorded_shapes(frame);
  const std::map<int, CentreLine> lines = centre_lines(frame);
  const std::set<int> cut = cut_structures(scene.ontology);
  std::optional<double> worst;
  for (const RecordedPiece& piece : pieces) {
    if (piece.structures.size() != 1 || cut.contains(piece.structures.front())) continue;
    const RecordedShape* recorded = find_shape(shapes, piece.structures.front());
    const auto line = lines.find(piece.structures.front());
    if (recorded == nullptr) continue;
    const Shape& shape = recorded->shape;
    const bool is_duct = line != lines.end();
    const double radius = is_duct ? line->second.smallest_radius() : smallest_radius(shape);
    if (radius <= 0) continue;
    double error = 0;
    for (Eigen::Index v = 0; v < piece.mesh.V.rows(); ++v) {
      const Eigen::Vector3d x = piece.mesh.V.row(v).transpose();
      error = std::max(error, is_duct                               ? line->second.distance(x)
                              : shape.primitive == Primitive::ovoid ? ovoid_distance(shape, x)
                                                                    : cylinder_distance(shape, x));
    }
    worst = std::max(worst.value_or(0), error / radius);
  }
  return worst;
}

}  // namespace geoprior::embryo
