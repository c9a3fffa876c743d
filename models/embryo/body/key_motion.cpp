#include "models/embryo/body/key_motion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

constexpr int kSizes = 7, kLengths = 5;  // the lengths come first

/// Cosine of 150 degrees.
constexpr double kWidestTurn = -0.8660254037844386;

std::vector<double> days_of(const std::vector<Key>& keys) {
  std::vector<double> days;
  for (const Key& key : keys) days.push_back(key.day);
  return days;
}

/// Columns x, y, z of a z direction and an x direction, not parallel.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& axis, const Eigen::Vector3d& up) {
  Eigen::Matrix3d axes;
  axes.col(2) = axis.normalized();
  axes.col(0) = (up - axes.col(2).dot(up) * axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

void require_one_kind(const std::vector<Key>& keys, const std::string& structure) {
  if (keys.empty()) throw Error("it has no key frame", structure);
  for (const Key& key : keys) {
    if (key.geometry.primitive != keys[0].geometry.primitive)
      throw Error("it has another primitive at " + key.name + " than at " + keys[0].name, structure,
                  "one primitive in all key frames");
    if (key.geometry.frame != keys[0].geometry.frame)
      throw Error("it has another frame at " + key.name + " than at " + keys[0].name, structure,
                  "one frame in all key frames");
  }
}

}  // namespace

KeyMotion::KeyMotion(const std::vector<Key>& keys, const std::string& structure,
                     Interpolation interpolation) {
  require_one_kind(keys, structure);
  primitive_ = keys[0].geometry.primitive;
  frame_ = keys[0].geometry.frame;
  add_sizes(keys, interpolation);
  add_directions(keys, structure, interpolation);
  std::vector<Eigen::Vector3d> places;
  for (const Key& key : keys) places.push_back(key.geometry.position);
  path_ = KeyPath(days_of(keys), std::move(places), interpolation);
}

void KeyMotion::add_sizes(const std::vector<Key>& keys, Interpolation interpolation) {
  const int n = static_cast<int>(keys.size());
  Eigen::MatrixXd values(n, kSizes);
  for (int i = 0; i < n; ++i) {
    const Geometry& g = keys[i].geometry;
    values.row(i) << g.radii.transpose(), g.radius, g.end_radius, g.egg, g.branchings;
  }
  logarithmic_.assign(kSizes, false);
  for (int c = 0; c < kLengths; ++c) {
    logarithmic_[c] = interpolation == Interpolation::monotone && values.col(c).minCoeff() > 0;
    if (logarithmic_[c]) values.col(c) = values.col(c).array().log().eval();
  }
  sizes_ = MonotoneCurve(days_of(keys), std::move(values), interpolation, Ends::fading);
}

void KeyMotion::add_directions(const std::vector<Key>& keys, const std::string& structure,
                               Interpolation interpolation) {
  const int n = static_cast<int>(keys.size());
  Eigen::MatrixXd values(n, 6);
  for (int i = 0; i < n; ++i)
    values.row(i) << keys[i].geometry.axis.transpose(), keys[i].geometry.up.transpose();
  for (int i = 1; i < n; ++i) {
    const Geometry &a = keys[i - 1].geometry, &b = keys[i].geometry;
    const double trace =
        (rotation_of(a.axis, a.up).transpose() * rotation_of(b.axis, b.up)).trace();
    if (!((trace - 1) / 2 >= kWidestTurn))
      throw Error(
          "it turns by more than 150 degrees from " + keys[i - 1].name + " to " + keys[i].name,
          structure, "a key frame between them");
  }
  directions_ = MonotoneCurve(days_of(keys), std::move(values), interpolation, Ends::rest);
}

Shape KeyMotion::sizes(double day) const {
  Eigen::VectorXd values = sizes_.at(day);
  for (int c = 0; c < kSizes; ++c)
    if (logarithmic_[c]) values[c] = std::exp(values[c]);
  Shape shape;
  shape.primitive = primitive_;
  shape.radii = values.head<3>();
  shape.radius = values[3];
  shape.end_radius = values[4];
  shape.egg = values[5];
  shape.branchings = values[6];
  return shape;
}

Eigen::Matrix3d KeyMotion::axes(double day) const {
  const Eigen::VectorXd directions = directions_.at(day);
  return rotation_of(directions.head<3>(), directions.tail<3>());
}

}  // namespace geoprior::embryo
