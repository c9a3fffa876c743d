#include "solvers/sketch/photo/continued_colours.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>

namespace geoprior::sketch {
namespace {

constexpr double kReachAlong = 8;   ///< along a line (pixels)
constexpr double kSpread = 2;       ///< least standard deviation of the structure tensor's weights
constexpr double kMostSpread = 8;   ///< and largest, about pixels far from the region
constexpr double kWindow = 2.5;     ///< half the tensor's window, in standard deviations
constexpr double kLeastChange = 3;  ///< grey levels a pixel below which a direction is noise
/// A pixel reads others that are nearer to the region by so much (pixels): what is filled at the
/// same distance would be read in the order in which it is filled.
constexpr double kNearer = 0.9;
constexpr float kNone = 1e9F;  ///< no gradient

/// A part of the picture with the colours that are there so far.
class Canvas {
 public:
  Canvas(const PixelImage& picture, std::span<const std::size_t> region,
         std::span<const std::size_t> fill);

  void fill(double reach);
  [[nodiscard]] Eigen::Vector3d colour(std::size_t pixel_of_picture) const {
    return colour_[index_of(pixel_of_picture)].cast<double>();
  }

 private:
  [[nodiscard]] int x_of(std::size_t pixel) const {
    return static_cast<int>(pixel % picture_width_);
  }
  [[nodiscard]] int y_of(std::size_t pixel) const {
    return static_cast<int>(pixel / picture_width_);
  }
  [[nodiscard]] std::size_t index_of(std::size_t pixel_of_picture) const {
    return at(x_of(pixel_of_picture) - left_, y_of(pixel_of_picture) - top_);
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * width_ + x;
  }
  [[nodiscard]] bool holds(int x, int y) const {
    return x >= 0 && y >= 0 && x < width_ && y < height_;
  }
  [[nodiscard]] bool in_region(int x, int y) const {
    return holds(x, y) && distance_[at(x, y)] == 0;
  }
  /// Whether a pixel has a colour that one at a distance from the region may read.
  [[nodiscard]] bool readable(int x, int y, double distance) const {
    return holds(x, y) && distance_[at(x, y)] <= std::max(distance - kNearer, 0.0);
  }
  [[nodiscard]] float brightness(int x, int y) const { return colour_[at(x, y)].sum() / 3; }
  [[nodiscard]] std::optional<Eigen::Vector2d> gradient(int x, int y) const;
  void measure_gradients();
  [[nodiscard]] Eigen::Matrix2d structure(int x, int y, double distance) const;
  [[nodiscard]] std::optional<Eigen::Vector3f> between(const Eigen::Vector2d& place,
                                                       double distance) const;
  [[nodiscard]] std::optional<Eigen::Vector3f> along(int x, int y, const Eigen::Vector2d& line,
                                                     double distance) const;
  [[nodiscard]] Eigen::Vector3f around(int x, int y, double distance) const;
  [[nodiscard]] Eigen::Vector3f continued(int x, int y, double distance) const;

  std::size_t picture_width_;
  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;  ///< of the part, in the picture
  std::vector<Eigen::Vector3f> colour_;              ///< negative: none yet
  std::vector<double> distance_;           ///< from the region, of what has a colour; else infinite
  std::vector<Eigen::Vector2f> gradient_;  ///< of the region's brightness; kNone elsewhere
  std::vector<char> wanted_;
};

Canvas::Canvas(const PixelImage& picture, std::span<const std::size_t> region,
               std::span<const std::size_t> fill)
    : picture_width_(static_cast<std::size_t>(picture.width)) {
  constexpr int kMargin = static_cast<int>(kWindow * kMostSpread);
  int right = 0, bottom = 0;
  left_ = picture.width;
  top_ = picture.height;
  for (const std::size_t pixel : fill) {
    left_ = std::min(left_, x_of(pixel) - kMargin);
    right = std::max(right, x_of(pixel) + kMargin);
    top_ = std::min(top_, y_of(pixel) - kMargin);
    bottom = std::max(bottom, y_of(pixel) + kMargin);
  }
  width_ = std::max(right - left_ + 1, 0);
  height_ = std::max(bottom - top_ + 1, 0);
  const std::size_t count = static_cast<std::size_t>(width_) * height_;
  colour_.assign(count, Eigen::Vector3f::Constant(-1));
  distance_.assign(count, HUGE_VAL);
  wanted_.assign(count, 0);
  for (const std::size_t pixel : region) {
    const int x = x_of(pixel) - left_, y = y_of(pixel) - top_;
    if (!holds(x, y)) continue;
    const PixelColour& c = picture.pixels[pixel];
    colour_[at(x, y)] = Eigen::Vector3f(c[0], c[1], c[2]);
    distance_[at(x, y)] = 0;
  }
  for (const std::size_t pixel : fill) wanted_[index_of(pixel)] = 1;
}

/// Of the region's brightness; nothing where a pixel has no neighbour of it along an axis.
std::optional<Eigen::Vector2d> Canvas::gradient(int x, int y) const {
  const auto along_axis = [&](int i, int j) -> std::optional<double> {
    const bool before = in_region(x - i, y - j), after = in_region(x + i, y + j);
    if (!before && !after) return {};
    const double low = before ? brightness(x - i, y - j) : brightness(x, y);
    const double high = after ? brightness(x + i, y + j) : brightness(x, y);
    return (high - low) / (before && after ? 2 : 1);
  };
  const auto gx = along_axis(1, 0), gy = along_axis(0, 1);
  if (!gx || !gy) return {};
  return Eigen::Vector2d(*gx, *gy);
}

/// Of the region alone: directions that were read from what was filled before would drift.
void Canvas::measure_gradients() {
  gradient_.assign(colour_.size(), Eigen::Vector2f::Constant(kNone));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!in_region(x, y)) continue;
      if (const auto g = gradient(x, y)) gradient_[at(x, y)] = g->cast<float>();
    }
  }
}

/// About a pixel at a distance from the region, wide enough to see some of it.
Eigen::Matrix2d Canvas::structure(int x, int y, double distance) const {
  const double spread = std::clamp(distance / 1.5, kSpread, kMostSpread);
  const int reach = static_cast<int>(kWindow * spread);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double weights = 0;
  for (int j = std::max(y - reach, 0); j <= std::min(y + reach, height_ - 1); ++j) {
    for (int i = std::max(x - reach, 0); i <= std::min(x + reach, width_ - 1); ++i) {
      if (gradient_[at(i, j)](0) == kNone) continue;
      const Eigen::Vector2d g = gradient_[at(i, j)].cast<double>();
      const int dx = i - x, dy = j - y;
      const double w = std::exp(-(dx * dx + dy * dy) / (2 * spread * spread));
      sum += w * g * g.transpose();
      weights += w;
    }
  }
  if (weights > 0) sum /= weights;
  return sum;
}

/// Between four pixels that are all readable.
std::optional<Eigen::Vector3f> Canvas::between(const Eigen::Vector2d& place,
                                               double distance) const {
  const int x = static_cast<int>(std::floor(place.x())),
            y = static_cast<int>(std::floor(place.y()));
  const auto s = static_cast<float>(place.x() - x), t = static_cast<float>(place.y() - y);
  Eigen::Vector3f sum(0, 0, 0);
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const float w = (i == 0 ? 1 - s : s) * (j == 0 ? 1 - t : t);
      if (w == 0) continue;
      if (!readable(x + i, y + j, distance)) return {};
      sum += w * colour_[at(x + i, y + j)];
    }
  }
  return sum;
}

/// The nearest colour along a line, on either side; where both are equally near, their mean.
std::optional<Eigen::Vector3f> Canvas::along(int x, int y, const Eigen::Vector2d& line,
                                             double distance) const {
  constexpr double kStep = 0.25;
  const Eigen::Vector2d here(x, y);
  for (double s = 1; s <= kReachAlong; s += kStep) {
    const auto ahead = between(here + s * line, distance),
               back = between(here - s * line, distance);
    if (ahead && back) return (*ahead + *back) / 2;
    if (ahead) return ahead;
    if (back) return back;
  }
  return {};
}

/// Of the readable pixels around, the nearer the more. One of them the pixel was reached from.
Eigen::Vector3f Canvas::around(int x, int y, double distance) const {
  Eigen::Vector3f sum(0, 0, 0);
  float weights = 0;
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      if (!readable(x + i, y + j, distance)) continue;
      const float w = 1 / static_cast<float>(i * i + j * j);
      sum += w * colour_[at(x + i, y + j)];
      weights += w;
    }
  }
  return sum / weights;
}

Eigen::Vector3f Canvas::continued(int x, int y, double distance) const {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(structure(x, y, distance));
  const double contrast = axes.eigenvalues()(1) - axes.eigenvalues()(0);
  const double noise = kLeastChange * kLeastChange / std::max(contrast, 1e-12);
  const auto clear = static_cast<float>(std::exp(-noise * noise));
  const Eigen::Vector3f mean = around(x, y, distance);
  const auto straight = along(x, y, axes.eigenvectors().col(0), distance);
  return straight ? Eigen::Vector3f(clear * *straight + (1 - clear) * mean) : mean;
}

/// In the order of distance, along chains of neighbours.
void Canvas::fill(double reach) {
  measure_gradients();
  using Entry = std::tuple<double, int, int>;  // distance, y, x
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> least(colour_.size(), HUGE_VAL);
  const auto spread = [&](int x, int y, double from) {
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height_ - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
        const double d = from + std::hypot(i - x, j - y);
        if (wanted_[at(i, j)] == 0 || d >= least[at(i, j)] || d > reach) continue;
        least[at(i, j)] = d;
        queue.emplace(d, j, i);
      }
    }
  };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x)
      if (in_region(x, y)) spread(x, y, 0);
  }
  while (!queue.empty()) {
    const auto [d, y, x] = queue.top();
    queue.pop();
    if (distance_[at(x, y)] <= d) continue;
    colour_[at(x, y)] = continued(x, y, d);
    distance_[at(x, y)] = d;
    spread(x, y, d);
  }
}

}  // namespace

std::vector<Eigen::Vector3d> continued_colours(const PixelImage& picture,
                                               std::span<const std::size_t> region,
                                               std::span<const std::size_t> fill, double reach) {
  std::vector<Eigen::Vector3d> colours;
  if (fill.empty()) return colours;
  Canvas canvas(picture, region, fill);
  canvas.fill(reach);
  colours.reserve(fill.size());
  for (const std::size_t pixel : fill) colours.push_back(canvas.colour(pixel));
  return colours;
}

}  // namespace geoprior::sketch
