#include "solvers/sketch/photo/continued_patches.h"

#include <algorithm>
#include <cmath>

#include "solvers/sketch/photo/continued_colours.h"

namespace geoprior::sketch {

ContinuedPatches::ContinuedPatches(int width, int height, int step, int patches)
    : width_(width),
      step_(step),
      cells_{(width + step - 1) / step, (height + step - 1) / step, {}},
      region_(patches),
      wanted_(patches),
      continued_(patches) {
  cells_.pixels.assign(static_cast<std::size_t>(cells_.width) * cells_.height, {});
  known_.assign(cells_.pixels.size(), -1);
}

std::size_t ContinuedPatches::cell_of(std::size_t pixel) const {
  const std::size_t x = pixel % width_, y = pixel / width_;
  return y / step_ * cells_.width + x / step_;
}

void ContinuedPatches::know(std::size_t pixel, int patch, const Eigen::Vector3d& colour) {
  const std::size_t middle = step_ / 2;
  if (pixel % width_ % step_ != middle || pixel / width_ % step_ != middle) return;
  const std::size_t cell = cell_of(pixel);
  cells_.pixels[cell] = rounded_colour(colour);
  known_[cell] = patch;
  region_[patch].push_back(cell);
}

void ContinuedPatches::want(std::size_t pixel, int patch) {
  const std::size_t cell = cell_of(pixel);
  if (known_[cell] != patch) wanted_[patch].push_back(cell);
}

void ContinuedPatches::fill(double reach) {
  for (std::size_t patch = 0; patch < wanted_.size(); ++patch) {
    std::vector<std::size_t>& wanted = wanted_[patch];
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const std::vector<Eigen::Vector3d> colours =
        continued_colours(cells_, region_[patch], wanted, reach);
    for (std::size_t i = 0; i < colours.size(); ++i)
      if (colours[i](0) >= 0) continued_[patch].emplace(wanted[i], colours[i]);
  }
}

std::optional<Eigen::Vector3d> ContinuedPatches::cell_colour(int x, int y, int patch) const {
  if (x < 0 || y < 0 || x >= cells_.width || y >= cells_.height) return {};
  const std::size_t cell = static_cast<std::size_t>(y) * cells_.width + x;
  if (known_[cell] == patch) {
    const PixelColour& c = cells_.pixels[cell];
    return Eigen::Vector3d(c[0], c[1], c[2]);
  }
  const auto found = continued_[patch].find(cell);
  if (found == continued_[patch].end()) return {};
  return found->second;
}

std::optional<Eigen::Vector3d> ContinuedPatches::colour(std::size_t pixel, int patch) const {
  const auto in_cells = [&](std::size_t along) {
    return (static_cast<double>(along) - step_ / 2) / step_;
  };
  const double x = in_cells(pixel % width_), y = in_cells(pixel / width_);
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  Eigen::Vector3d sum(0, 0, 0);
  double weights = 0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const double w = (1 - std::abs(x - left - i)) * (1 - std::abs(y - top - j));
      const auto colour = w > 0 ? cell_colour(left + i, top + j, patch) : std::nullopt;
      if (!colour) continue;
      sum += w * *colour;
      weights += w;
    }
  }
  if (!(weights > 0)) return {};
  return Eigen::Vector3d(sum / weights);
}

}  // namespace geoprior::sketch
