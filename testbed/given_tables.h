#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "core/frame.h"

namespace geoprior {

/// A table that is filled row by row, for what scenes give to programs from outside.
class TableBuilder {
 public:
  explicit TableBuilder(std::vector<std::string> columns) : columns_(std::move(columns)) {}
  /// @param row  as many numbers as there are columns
  void add(const std::vector<double>& row);
  [[nodiscard]] FrameTable finished() const;

 private:
  std::vector<std::string> columns_;
  std::vector<double> values_;
};

/// The columns of a 3 x 4 matrix (A t), row by row, after others: it moves points from where they
/// start, x -> A x + t.
std::vector<std::string> with_transform_columns(std::vector<std::string> columns);
/// A row for them.
std::vector<double> with_transform(std::vector<double> row, const Eigen::Affine3d& transform);

/// Table of the frames that methods record: columns "frame" and "time [s]".
FrameTable frame_times(const std::vector<double>& times);

/// "motion", 7: "motion_0007".
std::string numbered(const std::string& name, int number);

}  // namespace geoprior
