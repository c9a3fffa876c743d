#include "testbed/given_tables.h"

#include <cassert>
#include <cstdio>

namespace geoprior {

void TableBuilder::add(const std::vector<double>& row) {
  assert(row.size() == columns_.size());
  values_.insert(values_.end(), row.begin(), row.end());
}

FrameTable TableBuilder::finished() const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = static_cast<Eigen::Index>(columns_.size());
  const Eigen::Index rows = std::ssize(values_) / columns;
  return {columns_, Eigen::Map<const RowMajor>(values_.data(), rows, columns)};
}

std::vector<std::string> with_transform_columns(std::vector<std::string> columns) {
  for (const char* row : {"x", "y", "z"}) {
    for (const char* column : {"x", "y", "z"}) {
      columns.push_back(std::string(row) + "_from_" + column);
    }
    columns.push_back(std::string(row) + "_shift [m]");
  }
  return columns;
}

std::vector<double> with_transform(std::vector<double> row, const Eigen::Affine3d& transform) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) row.push_back(transform(r, c));
  }
  return row;
}

FrameTable frame_times(const std::vector<double>& times) {
  TableBuilder table({"frame", "time [s]"});
  for (std::size_t i = 0; i < times.size(); ++i) table.add({static_cast<double>(i), times[i]});
  return table.finished();
}

std::string numbered(const std::string& name, int number) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "_%04d", number);
  return name + digits;
}

}  // namespace geoprior
