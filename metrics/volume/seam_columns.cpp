#include "metrics/volume/seam_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geoprior {
namespace {

enum class Cover : char { unknown, plain, marked };

/// What the vertices in a column's square say: marked when one of them is, unknown without any.
std::vector<Cover> cover_of(const ColumnGrid& grid, const TriMesh& surface,
                            const std::vector<char>& marked) {
  std::vector<Cover> cover(grid.count(), Cover::unknown);
  for (const int v : surface.F.reshaped()) {
    const Eigen::Vector2d at =
        (surface.V.row(v).head<2>().transpose() - grid.origin) / grid.spacing;
    const int i = static_cast<int>(std::floor(at.x())), j = static_cast<int>(std::floor(at.y()));
    if (i < 0 || j < 0 || i >= grid.nx || j >= grid.ny) continue;
    Cover& here = cover[grid.index(i, j)];
    here = std::max(here, marked[v] == 0 ? Cover::plain : Cover::marked);
  }
  return cover;
}

}  // namespace

std::vector<char> seam_columns(const ColumnGrid& grid, const TriMesh& surface,
                               const std::vector<char>& marked) {
  const std::vector<Cover> cover = cover_of(grid, surface, marked);
  std::vector<char> seam(cover.size(), 0);
  const auto at = [&](int i, int j) { return cover[grid.index(i, j)]; };
  for (int j = 1; j + 1 < grid.ny; ++j) {
    for (int i = 1; i + 1 < grid.nx; ++i) {
      if (at(i, j) != Cover::marked) continue;
      const auto beside = {at(i - 1, j), at(i + 1, j), at(i, j - 1), at(i, j + 1)};
      const bool border = std::count(beside.begin(), beside.end(), Cover::plain) > 0;
      if (border) seam[grid.index(i, j)] = 1;
    }
  }
  return seam;
}

Eigen::VectorXd values_where(const Eigen::VectorXd& values, const std::vector<char>& flags) {
  Eigen::VectorXd kept = values;
  for (Eigen::Index i = 0; i < kept.size(); ++i) {
    if (flags[i] == 0) {
      kept[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return kept;
}

}  // namespace geoprior
