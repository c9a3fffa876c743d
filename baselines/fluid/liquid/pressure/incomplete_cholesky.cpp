#include "baselines/fluid/liquid/pressure/incomplete_cholesky.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kSlabs = 8;  ///< decides the result: not the number of threads
constexpr float kTau = 0.97F;      ///< share of the dropped fill that goes to the diagonal
constexpr float kSigma = 0.25F;    ///< a pivot under this share of the diagonal is replaced

class IncompleteCholesky final : public PressureApproximation {
 public:
  void build(const PressureSystem& system) override {
    system_ = &system;
    const std::size_t n = system.n;
    slab_ = std::max<std::size_t>((n + kSlabs - 1) / kSlabs, 1);
    pivot_.assign(n + 2, 0);
    value_.assign(n + 2, 0);
    parallel_blocks(n, slab_, [&](std::size_t begin, std::size_t end) { factor(begin, end); });
  }

  void apply(const std::vector<double>& r, std::vector<double>& z) override {
    const double largest = largest_magnitude(r);
    const double scale = largest > 0 ? largest : 1;
    parallel_blocks(system_->n, slab_, [&](std::size_t begin, std::size_t end) {
      forward(begin, end, r, scale);
      backward(begin, end, z, scale);
    });
  }

 private:
  /// Inverse square roots of the pivots; rows of other slabs do not exist.
  void factor(std::size_t begin, std::size_t end) {
    const PressureSystem& a = *system_;
    const auto& [lx, ly, lz] = a.link;
    for (std::size_t c = begin + 1; c <= end; ++c) {
      const std::size_t xm = inside(c - 1, begin), ym = inside(at(a.lower[0][c]), begin),
                        zm = inside(at(a.lower[1][c]), begin);
      const float px = lx[xm] * pivot_[xm], py = ly[ym] * pivot_[ym], pz = lz[zm] * pivot_[zm];
      const float fill = px * pivot_[xm] * (ly[xm] + lz[xm]) + py * pivot_[ym] * (lx[ym] + lz[ym]) +
                         pz * pivot_[zm] * (lx[zm] + ly[zm]);
      float e = a.diagonal[c] - px * px - py * py - pz * pz - kTau * fill;
      if (e < kSigma * a.diagonal[c]) e = a.diagonal[c];
      pivot_[c] = 1 / std::sqrt(e);
    }
  }

  void forward(std::size_t begin, std::size_t end, const std::vector<double>& r, double scale) {
    const PressureSystem& a = *system_;
    for (std::size_t c = begin + 1; c <= end; ++c) {
      const std::size_t xm = inside(c - 1, begin), ym = inside(at(a.lower[0][c]), begin),
                        zm = inside(at(a.lower[1][c]), begin);
      const float t = static_cast<float>(r[c] / scale) + a.link[0][xm] * pivot_[xm] * value_[xm] +
                      a.link[1][ym] * pivot_[ym] * value_[ym] +
                      a.link[2][zm] * pivot_[zm] * value_[zm];
      value_[c] = t * pivot_[c];
    }
  }

  void backward(std::size_t begin, std::size_t end, std::vector<double>& z, double scale) {
    const PressureSystem& a = *system_;
    for (std::size_t c = end; c > begin; --c) {
      float t = value_[c];
      // The upper neighbour on x is c + 1, which may be the first row of the next slab.
      if (c < end) t += a.link[0][c] * pivot_[c] * value_[c + 1];
      for (std::size_t s = 0; s < 2; ++s) {
        const std::size_t up = at(a.upper[s][c]);
        if (up <= end) t += a.link[s + 1][c] * pivot_[c] * value_[up];
      }
      value_[c] = t * pivot_[c];
      z[c] = scale * static_cast<double>(value_[c]);
    }
  }

  static std::size_t at(std::int32_t number) { return number; }
  /// 0, whose links are 0, for a lower neighbour in another slab.
  static std::size_t inside(std::size_t c, std::size_t begin) { return c > begin ? c : 0; }

  const PressureSystem* system_ = nullptr;
  std::size_t slab_ = 1;
  std::vector<float> pivot_, value_;
};

}  // namespace

std::unique_ptr<PressureApproximation> make_incomplete_cholesky_approximation() {
  return std::make_unique<IncompleteCholesky>();
}

}  // namespace geoprior::fluid
