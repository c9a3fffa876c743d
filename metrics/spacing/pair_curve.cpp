#include "metrics/spacing/pair_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

constexpr std::size_t kSourcesPerBlock = 32;
constexpr double kTail = 4;          // sigmas after which the kernel is cut
constexpr int kCellsPerSigma = 8;    // of the histograms of distances
constexpr double kSampleSigmas = 3;  // edge of the triangles whose area counts at their middle

/// Amounts by distance; each is shared by the two nearest cells, in proportion.
class Histogram {
 public:
  Histogram(double cell, double reach)
      : cell_(cell), amount_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(reach / cell) + 2)) {}
  void add(double distance, double amount) {
    const double at = distance / cell_;
    if (!(at < static_cast<double>(amount_.size() - 1))) return;
    const auto i = static_cast<Eigen::Index>(at);
    const double upper = amount * (at - static_cast<double>(i));
    amount_(i) += amount - upper;
    amount_(i + 1) += upper;
  }
  void add(const Histogram& other) { amount_ += other.amount_; }
  /// sum of amounts k(r - distance), k the Gaussian.
  [[nodiscard]] double smoothed(double r, double sigma) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < amount_.size(); ++i) {
      const double z = (r - static_cast<double>(i) * cell_) / sigma;
      if (std::abs(z) < kTail) sum += amount_(i) * std::exp(-z * z / 2);
    }
    return sum / (sigma * std::sqrt(2 * std::numbers::pi));
  }

 private:
  double cell_;
  Eigen::VectorXd amount_;
};

/// What pairs and areas of some sources come to (distances in units).
struct Tally {
  Histogram pairs, area;
  void add(const Tally& other) {
    pairs.add(other.pairs);
    area.add(other.area);
  }
};

void require(std::span<const SurfacePoint> details, double unit, const PairCurveOptions& o,
             const PairCurveMask& mask, int triangles) {
  if (!(unit > 0)) throw Error("unit " + std::to_string(unit), "pair curve", "positive");
  if (!(o.reach > 0) || !(o.bandwidth > 0) || o.bins < 1 || o.sources < 1) {
    throw Error("reach " + std::to_string(o.reach) + ", bandwidth " + std::to_string(o.bandwidth) +
                    ", " + std::to_string(o.bins) + " bins, " + std::to_string(o.sources) +
                    " sources",
                "pair curve", "all positive");
  }
  if (!mask.weights.empty() && mask.weights.size() != details.size()) {
    throw Error(std::to_string(mask.weights.size()) + " weights", "pair curve",
                "one for each of " + std::to_string(details.size()) + " details");
  }
  for (std::size_t i = 0; i < mask.weights.size(); ++i) {
    if (!(mask.weights[i] >= 0) || !std::isfinite(mask.weights[i])) {
      throw Error("weight " + std::to_string(mask.weights[i]), "detail " + std::to_string(i),
                  "not negative");
    }
  }
  if (!mask.region.empty() && std::ssize(mask.region) != triangles) {
    throw Error(std::to_string(mask.region.size()) + " flags of a region", "pair curve",
                "one for each of " + std::to_string(triangles) + " triangles");
  }
}

/// The details that count, by triangle, and the measurement from one of them.
class PairCount {
 public:
  PairCount(const UnfoldedSurface& surface, std::span<const SurfacePoint> details, double unit,
            const PairCurveOptions& options, const PairCurveMask& mask)
      : surface_(surface),
        unit_(unit),
        reach_(options.reach + kTail * options.bandwidth),
        cell_(options.bandwidth / kCellsPerSigma),
        sample_(kSampleSigmas * options.bandwidth * unit),
        region_(mask.region) {
    const int triangles = surface.mesh().triangle_count();
    offset_.assign(triangles + 1, 0);
    for (std::size_t i = 0; i < details.size(); ++i) {
      surface.require(details[i]);
      const double weight = mask.weights.empty() ? 1 : mask.weights[i];
      if (weight == 0 || !counts(details[i].face)) continue;
      place_.push_back(details[i]);
      layout_.push_back(surface.layout(details[i]));
      weight_.push_back(weight);
      ++offset_[details[i].face + 1];
    }
    for (std::size_t f = 1; f < offset_.size(); ++f) offset_[f] += offset_[f - 1];
    row_.resize(place_.size());
    std::vector<std::size_t> next(offset_.begin(), offset_.end() - 1);
    for (std::size_t i = 0; i < place_.size(); ++i) {
      row_[next[place_[i].face]++] = i;
    }
  }

  [[nodiscard]] std::size_t size() const { return place_.size(); }
  [[nodiscard]] const std::vector<double>& weights() const { return weight_; }
  [[nodiscard]] Tally empty() const { return {{cell_, reach_}, {cell_, reach_}}; }
  [[nodiscard]] double area() const {
    const Eigen::VectorXd areas = triangle_areas(surface_.mesh().V, surface_.mesh().F);
    double sum = 0;
    for (Eigen::Index f = 0; f < areas.size(); ++f) {
      if (counts(static_cast<int>(f))) sum += areas(f);
    }
    return sum;
  }

  /// @param share  of the area's contribution: weight and density of the others
  void measure(std::size_t i, double share, SurfaceFront& front, Tally& tally) const {
    front.spread(place_[i], reach_ * unit_);
    for (const int f : front.faces()) {
      if (!counts(f) || front.is_beyond(f, reach_ * unit_)) continue;
      const SurfaceFront::Within within = front.within(f);
      for (std::size_t k = offset_[f]; k < offset_[f + 1]; ++k) {
        const std::size_t j = row_[k];
        if (j == i) continue;
        tally.pairs.add(within.distance(layout_[j]) / unit_, weight_[i] * weight_[j]);
      }
      const auto& [c, length, unused] = surface_.triangle(f);
      const double longest = std::max({length[0], length[1], length[2]});
      add_area(within, c[0], c[1], c[2], longest, share, tally.area);
    }
  }

 private:
  [[nodiscard]] bool counts(int face) const { return region_.empty() || region_[face] != 0; }

  /// Area of a triangle at the distance of its middle, quartered until it is small; parts that are
  /// out of reach are not looked into.
  void add_area(const SurfaceFront::Within& within, const Eigen::Vector2d& a,
                const Eigen::Vector2d& b, const Eigen::Vector2d& c, double longest, double share,
                Histogram& area) const {
    const double distance = within.distance((a + b + c) / 3);
    if (!(distance - longest < reach_ * unit_)) return;
    if (longest <= sample_) {
      const Eigen::Vector2d u = b - a, v = c - a;
      area.add(distance / unit_, share * cross(u, v) / 2);
      return;
    }
    const Eigen::Vector2d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    add_area(within, a, ab, ca, longest / 2, share, area);
    add_area(within, b, bc, ab, longest / 2, share, area);
    add_area(within, c, ca, bc, longest / 2, share, area);
    add_area(within, ab, bc, ca, longest / 2, share, area);
  }

  const UnfoldedSurface& surface_;
  double unit_, reach_, cell_, sample_;  // reach and cell in units, sample in m
  std::span<const char> region_;
  std::vector<SurfacePoint> place_;
  std::vector<Eigen::Vector2d> layout_;
  std::vector<double> weight_;
  std::vector<std::size_t> offset_, row_;  // details of the triangles
};

struct Weights {
  double sum = 0, squares = 0;
};

Weights add_up(const std::vector<double>& weights) {
  Weights w;
  for (const double x : weights) {
    w.sum += x;
    w.squares += x * x;
  }
  return w;
}

/// Every so-many-th of the details as source; blocks of them in parallel, added up in order.
Tally tally_of(const PairCount& count, const UnfoldedSurface& surface, std::size_t sources,
               double area) {
  const double sum = add_up(count.weights()).sum;
  std::vector<Tally> blocks((sources + kSourcesPerBlock - 1) / kSourcesPerBlock, count.empty());
  parallel_blocks(sources, kSourcesPerBlock, [&](std::size_t begin, std::size_t end) {
    SurfaceFront front(surface);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = k * count.size() / sources;
      const double weight = count.weights()[i];
      count.measure(i, weight * (sum - weight) / area, front, blocks[begin / kSourcesPerBlock]);
    }
  });
  Tally tally = count.empty();
  for (const Tally& block : blocks) tally.add(block);
  return tally;
}

}  // namespace

PairCurve pair_curve(const TriMesh& surface, std::span<const SurfacePoint> details, double unit,
                     const PairCurveOptions& options, const PairCurveMask& mask) {
  require(details, unit, options, mask, surface.triangle_count());
  const UnfoldedSurface unfolded(surface);
  const PairCount count(unfolded, details, unit, options, mask);
  if (count.size() < 2) {
    throw Error(std::to_string(count.size()) + " details that count", "pair curve", "2 or more");
  }
  const std::size_t sources = std::min(count.size(), static_cast<std::size_t>(options.sources));
  const Tally tally = tally_of(count, unfolded, sources, count.area());

  const Weights w = add_up(count.weights());
  const double heaviness = w.squares / w.sum;
  // A pair seen from both ends counts twice, which doubles its share of the variance.
  const double twice = static_cast<double>(sources) / static_cast<double>(count.size());
  const double roughness = 1 / (2 * std::sqrt(std::numbers::pi) * options.bandwidth);
  PairCurve curve;
  curve.sources = static_cast<int>(sources);
  curve.step = options.reach / options.bins;
  curve.radius =
      curve.step * (Eigen::VectorXd::LinSpaced(options.bins, 0, options.bins - 1).array() + 0.5);
  curve.g.setOnes(options.bins);
  curve.error.setZero(options.bins);
  for (Eigen::Index k = 0; k < curve.radius.size(); ++k) {
    const double expected = tally.area.smoothed(curve.radius(k), options.bandwidth);
    if (!(expected > 0)) continue;
    curve.g(k) = tally.pairs.smoothed(curve.radius(k), options.bandwidth) / expected;
    curve.error(k) = heaviness * std::sqrt((1 + twice) * roughness / expected);
  }
  return curve;
}

double pair_curve_distance(const PairCurve& a, const PairCurve& b) {
  if (a.radius.size() != b.radius.size() || a.step != b.step) {
    throw Error(std::to_string(a.radius.size()) + " and " + std::to_string(b.radius.size()) +
                    " radii, steps " + std::to_string(a.step) + " and " + std::to_string(b.step),
                "distance of pair curves", "the same");
  }
  return a.step * (a.g - b.g).cwiseAbs().sum();
}

PairNoise pair_curve_noise(std::span<const PairCurve> resamples) {
  if (resamples.size() < 2) {
    throw Error(std::to_string(resamples.size()) + " curves", "noise of pair curves", "2 or more");
  }
  PairNoise noise;
  int pairs = 0;
  for (std::size_t i = 0; i < resamples.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = pair_curve_distance(resamples[i], resamples[j]);
      noise.mean += distance;
      noise.largest = std::max(noise.largest, distance);
      ++pairs;
    }
  }
  noise.mean /= pairs;
  return noise;
}

}  // namespace geoprior
