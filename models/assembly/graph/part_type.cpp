#include "models/assembly/graph/part_type.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/assembly/graph/point_cells.h"

namespace geoprior::assembly {
namespace {

/// Most vertices of a mesh that a motion is tried on: a body that is carried onto itself is so on a
/// part of its vertices, too.
constexpr int kTriedVertices = 2000;

std::vector<Eigen::Vector3d> body_points(const PartType& type) {
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index i = 0; i < type.mesh.V.rows(); ++i)
    points.emplace_back(type.mesh.V.row(i).transpose());
  for (const Box& box : type.boxes)
    for (int corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d x = box.half;
      for (int axis = 0; axis < 3; ++axis)
        if (corner >> axis & 1) x[axis] = -x[axis];
      points.push_back(box.pose * x);
    }
  return points;
}

/// Where each port comes to by a motion; empty when one comes to no port, or turned.
std::vector<int> port_images(const PartType& type, const Pose& motion, double tolerance) {
  std::vector<int> images;
  for (const PortType& port : type.ports) {
    const Pose moved = motion * port.frame;
    for (std::size_t j = 0; j < type.ports.size(); ++j) {
      const Pose& other = type.ports[j].frame;
      // An angle is as much of a port as its tolerance is of a part of a tenth of a metre.
      if ((moved.translation() - other.translation()).norm() > tolerance ||
          (moved.linear() - other.linear()).norm() > 10 * tolerance + 1e-9)
        continue;
      images.push_back(static_cast<int>(j));
      break;
    }
  }
  if (images.size() != type.ports.size()) return {};
  std::vector<int> sorted = images;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return {};
  return images;
}

bool is_identity(const Pose& motion, double tolerance) {
  return motion.translation().norm() <= tolerance &&
         (motion.linear() - Eigen::Matrix3d::Identity()).norm() <= 10 * tolerance + 1e-9;
}

}  // namespace

Pose mated(const Pose& port) {
  Pose out = port;
  out.linear().leftCols<2>() *= -1;
  return out;
}

Misfit misfit(const Pose& port, const Pose& other) {
  const Pose wanted = mated(other);
  // From the chord 2 sqrt 2 sin(angle / 2) of the two rotations: exact near zero, where an arc
  // cosine is not.
  const double chord = (port.linear() - wanted.linear()).norm();
  return {(port.translation() - wanted.translation()).norm(),
          2 * std::asin(std::min(1., chord / (2 * std::numbers::sqrt2)))};
}

std::vector<Symmetry> find_symmetries(const PartType& type, double tolerance) {
  std::vector<Symmetry> out;
  if (type.ports.empty()) return out;
  const std::vector<Eigen::Vector3d> body = body_points(type);
  const PointCells cells(body, tolerance);
  const std::size_t step = std::max<std::size_t>(1, body.size() / kTriedVertices);
  for (std::size_t j = 0; j < type.ports.size(); ++j) {
    const Pose motion = type.ports[j].frame * type.ports[0].frame.inverse();
    if (is_identity(motion, tolerance)) continue;
    std::vector<int> images = port_images(type, motion, tolerance);
    if (images.empty()) continue;
    bool is_carried = true;
    for (std::size_t i = 0; i < body.size() && is_carried; i += step)
      is_carried = cells.has_near(motion * body[i]);
    if (is_carried) out.push_back({std::move(images), motion});
  }
  return out;
}

}  // namespace geoprior::assembly
