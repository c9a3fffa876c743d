#include "solvers/fluid/lift/displacement_map_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kRowsPerBlock = 16;

/// Weights of four equidistant samples at the fraction s between the middle two.
std::array<double, 4> catmull_rom(double s) {
  const double s2 = s * s, s3 = s2 * s;
  return {0.5 * (-s3 + 2 * s2 - s), 0.5 * (3 * s3 - 5 * s2 + 2), 0.5 * (-3 * s3 + 4 * s2 + s),
          0.5 * (s3 - s2)};
}

struct Contribution {
  const MapFrame* map;
  float weight;
};

/// Frames of the feature that make up a time; one of them at a frame's own time.
std::vector<Contribution> contributions(const Feature& feature, double time) {
  const auto& times = feature.times;
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const int last = feature.frame_count() - 1;
  const int i = std::clamp(static_cast<int>(after - times.begin()) - 1, 0, last);
  const auto frame = [&](int k) { return &feature.maps[std::clamp(k, 0, last)]; };
  const double t0 = times[i];
  if (i == last || time <= t0) return {{frame(i), 1.0F}};
  const double s = (time - t0) / (times[i + 1] - t0);
  const std::array<double, 4> w = catmull_rom(s);
  std::vector<Contribution> result;
  for (int k = 0; k < 4; ++k) {
    result.push_back({frame(i - 1 + k), static_cast<float>(w[k])});
  }
  return result;
}

}  // namespace

DisplacementSampler::DisplacementSampler(const Feature& feature, double source_time)
    : resolution_(feature.resolution), extent_(feature.extent) {
  const std::size_t side = resolution_ + 2 * kPad;
  texels_.assign(side * side, Texel::Zero());
  blend(feature, source_time);
  count_occupied();
}

void DisplacementSampler::blend(const Feature& feature, double source_time) {
  const std::vector<Contribution> parts = contributions(feature, source_time);
  const std::size_t n = resolution_;
  parallel_blocks(n, kRowsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      Texel* row = texels_.data() + padded(0, static_cast<int>(j));
      for (const Contribution& part : parts) {
        const float* x = part.map->displacement.data() + j * n;
        const float* y = x + n * n;
        const float* z = y + n * n;
        const float* alpha = part.map->alpha.data() + j * n;
        for (std::size_t i = 0; i < n; ++i) {
          row[i] += part.weight * alpha[i] * Texel(x[i], y[i], z[i], 1.0F);
        }
      }
    }
  });
}

void DisplacementSampler::count_occupied() {
  const std::size_t n = resolution_;
  table_.assign((n + 1) * (n + 1), 0);
  for (std::size_t j = 0; j < n; ++j) {
    const Texel* row = texels_.data() + padded(0, static_cast<int>(j));
    int sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += row[i].w() > 0 ? 1 : 0;
      table_[(j + 1) * (n + 1) + i + 1] = table_[j * (n + 1) + i + 1] + sum;
    }
  }
}

DisplacementSampler::Value DisplacementSampler::at(const Eigen::Vector2d& uv) const {
  const double gx = (uv.x() / extent_ + 0.5) * resolution_ - 0.5;
  const double gy = (uv.y() / extent_ + 0.5) * resolution_ - 0.5;
  if (!(gx > -2 && gy > -2 && gx < resolution_ + 1 && gy < resolution_ + 1)) return Value::Zero();
  const int i = static_cast<int>(std::floor(gx)), j = static_cast<int>(std::floor(gy));
  const std::array<double, 4> wx = catmull_rom(gx - i), wy = catmull_rom(gy - j);
  Value result = Value::Zero();
  for (int b = 0; b < 4; ++b) {
    const int row_index = j - 1 + b;
    const Texel* row = texels_.data() + padded(i - 1, row_index);
    const Value sum = wx[0] * row[0].cast<double>() + wx[1] * row[1].cast<double>() +
                      wx[2] * row[2].cast<double>() + wx[3] * row[3].cast<double>();
    result += wy[b] * sum;
  }
  return result;
}

bool DisplacementSampler::occupied(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const {
  const auto index = [&](double x, double slack) {
    const double g = std::floor((x / extent_ + 0.5) * resolution_ + slack);
    return static_cast<std::size_t>(std::clamp(g, 0.0, static_cast<double>(resolution_)));
  };
  const std::size_t i0 = index(low.x(), -2), j0 = index(low.y(), -2);
  const std::size_t i1 = index(high.x(), 3), j1 = index(high.y(), 3);
  const auto width = static_cast<std::size_t>(resolution_) + 1;
  return table_[j1 * width + i1] - table_[j0 * width + i1] - table_[j1 * width + i0] +
             table_[j0 * width + i0] >
         0;
}

double DisplacementSampler::min_jacobian(double fade) const {
  const std::size_t n = resolution_;
  const std::size_t blocks = (n + kRowsPerBlock - 1) / kRowsPerBlock;
  std::vector<double> smallest(blocks, 1);
  const double factor = fade / (2 * texel());
  parallel_blocks(n, kRowsPerBlock, [&](std::size_t begin, std::size_t end) {
    double least = 1;
    for (std::size_t j = begin; j < end; ++j) {
      for (int i = 0; i < resolution_; ++i) {
        const Texel* t = texels_.data() + padded(i, static_cast<int>(j));
        if (t->w() <= 0) continue;
        const std::ptrdiff_t up = resolution_ + 2 * kPad;
        const Value x = factor * (t[1] - t[-1]).cast<double>();
        const Value y = factor * (t[up] - t[-up]).cast<double>();
        least = std::min(least, (1 + x[0]) * (1 + y[1]) - x[1] * y[0]);
      }
    }
    smallest[begin / kRowsPerBlock] = least;
  });
  return *std::min_element(smallest.begin(), smallest.end());
}

}  // namespace geoprior::fluid
