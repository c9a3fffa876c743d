#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "models/details/mesh.h"

namespace geoprior::details {

/// Points of a surface in the cells of a hashed grid, for questions about near points. A point
/// counts only where its normal is within 90 degrees of that of the question, so that the other
/// side of a thin part is not near. Reading is safe from several threads.
class PointGrid {
 public:
  /// @param cell      edge of a cell: about the radius of the questions (m)
  /// @param expected  points to come; more are allowed, only slower
  PointGrid(double cell, std::size_t expected);

  /// Adds a point; its number counts up from 0.
  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal);
  /// Adds all details, in order of their sites.
  void add_details(const DetailMesh& details);
  /// True where no point is nearer than `radius`.
  [[nodiscard]] bool is_free(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                             double radius) const;
  /// Number of the nearest point within `radius` (the least number among equals); -1 for none.
  [[nodiscard]] int nearest(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                            double radius) const;

 private:
  struct Entry {
    Eigen::Vector3d position;
    Eigen::Vector3d normal;
    int next;  ///< of its bucket
  };
  [[nodiscard]] std::int64_t cell_of(double coordinate) const;
  [[nodiscard]] std::size_t bucket(std::int64_t x, std::int64_t y, std::int64_t z) const;
  template <class Visit>
  void visit_near(const Eigen::Vector3d& position, double radius, const Visit& visit) const;

  double cell_ = 1;
  std::vector<int> first_;  ///< of a bucket; a power of two of them
  std::vector<Entry> entry_;
};

}  // namespace geoprior::details
