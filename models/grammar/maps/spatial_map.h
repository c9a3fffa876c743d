#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

namespace geoprior::grammar {

/// Where a map takes a point, and how it turns and stretches there.
struct MappedPoint {
  Eigen::Vector3d position;
  Eigen::Matrix3d jacobian;
};

/// A deformation of space: what a gesture asks for, before anybody interprets it. Lengths in m.
/// Queries may be asked from several threads at once.
class SpatialMap {
 public:
  virtual ~SpatialMap() = default;
  [[nodiscard]] virtual Eigen::Vector3d at(const Eigen::Vector3d& x) const = 0;
  /// Point and derivative. The default takes central differences of `at` over `difference()`.
  [[nodiscard]] virtual MappedPoint with_jacobian(const Eigen::Vector3d& x) const;
  /// Step of the default's differences (m).
  [[nodiscard]] virtual double difference() const { return 1e-5; }
  /// A box outside of which the map is the identity, bit for bit; absent: nowhere.
  [[nodiscard]] virtual std::optional<Eigen::AlignedBox3d> support() const { return std::nullopt; }
};

/// The rotation of the polar decomposition of a matrix of positive determinant.
Eigen::Quaterniond rotation_of(const Eigen::Matrix3d& m);

/// Whether the map may move a point of the box.
bool reaches(const SpatialMap& map, const Eigen::AlignedBox3d& box);

/// x -> transform * x.
class AffineMap final : public SpatialMap {
 public:
  explicit AffineMap(const Eigen::Affine3d& transform) : transform_(transform) {}
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override {
    return transform_ * x;
  }
  [[nodiscard]] MappedPoint with_jacobian(const Eigen::Vector3d& x) const override {
    return {transform_ * x, transform_.linear()};
  }

 private:
  Eigen::Affine3d transform_;
};

/// x -> second(first(x)).
class ComposedMap final : public SpatialMap {
 public:
  ComposedMap(std::shared_ptr<const SpatialMap> first, std::shared_ptr<const SpatialMap> second)
      : first_(std::move(first)), second_(std::move(second)) {}
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override {
    return second_->at(first_->at(x));
  }
  [[nodiscard]] MappedPoint with_jacobian(const Eigen::Vector3d& x) const override;
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override;

 private:
  std::shared_ptr<const SpatialMap> first_, second_;
};

/// The inverse of a map that has one, by Newton's method from the image: exact to round-off where
/// the map has no fold.
class InverseMap final : public SpatialMap {
 public:
  explicit InverseMap(std::shared_ptr<const SpatialMap> map) : map_(std::move(map)) {}
  /// @throws Error  naming the point, where no preimage is found
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override;
  [[nodiscard]] MappedPoint with_jacobian(const Eigen::Vector3d& x) const override;
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override {
    return map_->support();
  }

 private:
  std::shared_ptr<const SpatialMap> map_;
};

}  // namespace geoprior::grammar
