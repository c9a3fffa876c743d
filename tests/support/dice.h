#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/random.h"

namespace geoprior::test {

/// Numbers by which generators of files vary what a format leaves open.
class Dice {
 public:
  Dice(int seed, std::string_view of) : random_(static_cast<std::uint64_t>(seed), of) {}

  double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
  int below(int n) { return static_cast<int>(random_.below(static_cast<std::uint32_t>(n))); }
  bool coin() { return below(2) == 0; }
  Eigen::Vector3d vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  Eigen::Quaterniond rotation() {
    Eigen::Quaterniond q;
    for (double& x : q.coeffs()) x = uniform(-1, 1);
    return q.norm() > 0.1 ? q.normalized() : Eigen::Quaterniond::Identity();
  }
  std::string one_of(const std::vector<std::string>& texts) {
    return texts[below(static_cast<int>(texts.size()))];
  }
  template <class T>
  void shuffle(std::vector<T>& list) {
    for (std::size_t i = list.size(); i > 1; --i)
      std::swap(list[i - 1], list[below(static_cast<int>(i))]);
  }

 private:
  RandomStream random_;
};

}  // namespace geoprior::test
