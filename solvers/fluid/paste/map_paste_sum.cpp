#include "solvers/fluid/paste/map_paste_sum.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kSummedBlock = 2048;
constexpr int kSecantSteps = 4;
/// Volumes this small against the map's own are none.
constexpr double kNoVolume = 1e-12;

Eigen::Matrix3d axes_of(const PlacedMap& placed, const EditedFrame& frame, std::size_t i) {
  return placed.places.axes.empty() ? Eigen::Matrix3d(frame.placement.linear())
                                    : placed.places.axes[i];
}

std::vector<Eigen::Vector3d> spread(const PlacedMap& placed,
                                    const std::vector<Eigen::Vector3d>& shift,
                                    std::size_t vertices) {
  std::vector<Eigen::Vector3d> all(vertices, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < shift.size(); ++i) {
    all[placed.places.vertex[i]] = shift[i];
  }
  return all;
}

}  // namespace

Displaced displacements(const PlacedMap& placed) {
  Displaced result;
  const std::size_t n = placed.places.vertex.size();
  result.shift.resize(n);
  result.alpha.resize(n);
  parallel_blocks(n, kSummedBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const DisplacementSampler::Value value = placed.map.at(placed.places.uv[i]);
      const double factor = placed.frame.fade * placed.places.weight[i];
      result.shift[i] = axes_of(placed, placed.frame, i) * (factor * value.head<3>()).matrix();
      result.alpha[i] = factor * value[3];
    }
  });
  return result;
}

void lock_volume(const WorkMesh& mesh, const PlacedMap& placed, Displaced& displaced) {
  std::vector<Eigen::Vector3d> lift(displaced.shift.size());
  for (std::size_t i = 0; i < lift.size(); ++i) {
    lift[i] = displaced.alpha[i] * axes_of(placed, placed.frame, i).col(2).normalized();
  }
  const auto volume = [&](double constant) {
    std::vector<Eigen::Vector3d> shift = displaced.shift;
    for (std::size_t i = 0; i < shift.size(); ++i) shift[i] += constant * lift[i];
    return swept_volume(mesh, spread(placed, shift, mesh.x.size()));
  };
  double x0 = 0, v0 = volume(0);
  const double all = std::abs(v0);
  double x1 = placed.map.texel(), v1 = volume(x1);
  for (int step = 0; step < kSecantSteps && std::abs(v1) > kNoVolume * all; ++step) {
    if (v1 == v0) return;  // nothing to move: alpha is 0 everywhere
    const double x2 = x1 - v1 * (x1 - x0) / (v1 - v0);
    x0 = x1;
    v0 = v1;
    x1 = x2;
    v1 = volume(x1);
  }
  for (std::size_t i = 0; i < lift.size(); ++i) displaced.shift[i] += x1 * lift[i];
}

std::vector<Eigen::Vector3d> displacement_rates(const WorkMesh& mesh, const PlacedMap& placed) {
  std::vector<Eigen::Vector3d> rates;
  if (placed.instants.size() != 2) return rates;
  const PlacedMap::Instant &before = placed.instants[0], &after = placed.instants[1];
  rates.resize(placed.places.vertex.size());
  const bool projected = placed.places.axes.empty();
  const Eigen::Affine3d inverse = placed.frame.placement.inverse();
  const std::array<Eigen::Affine3d, 2> inverses{before.frame.placement.inverse(),
                                                after.frame.placement.inverse()};
  parallel_blocks(rates.size(), kSummedBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int v = placed.places.vertex[i];
      const auto shift = [&](std::size_t k) -> Eigen::Vector3d {
        const PlacedMap::Instant& instant = placed.instants[k];
        const Eigen::Vector3d x = mesh.x[v] + instant.time * mesh.velocity[v];
        // Over a curved target the map slides by what its centre moves in its own axes.
        const Eigen::Vector2d uv =
            projected
                ? Eigen::Vector2d((inverses[k] * x).head<2>())
                : Eigen::Vector2d(placed.places.uv[i] -
                                  (inverse * instant.frame.placement.translation()).head<2>());
        const DisplacementSampler::Value value = instant.map.at(uv);
        return axes_of(placed, instant.frame, i) *
               (instant.frame.fade * placed.places.weight[i] * value.head<3>()).matrix();
      };
      rates[i] = (shift(1) - shift(0)) / (after.time - before.time);
    }
  });
  return rates;
}

double swept_volume(const WorkMesh& mesh, const std::vector<Eigen::Vector3d>& shift) {
  if (mesh.x.empty()) return 0;
  const Eigen::Vector3d origin = mesh.x.front();
  std::vector<double> sums((mesh.triangles.size() + kSummedBlock - 1) / kSummedBlock, 0);
  parallel_blocks(mesh.triangles.size(), kSummedBlock, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& f = mesh.triangles[t];
      const int a = f[0], b = f[1], c = f[2];
      if (shift[a].isZero(0) && shift[b].isZero(0) && shift[c].isZero(0)) continue;
      const Eigen::Vector3d p = mesh.x[a] - origin, q = mesh.x[b] - origin, r = mesh.x[c] - origin;
      sum += (p + shift[a]).dot((q + shift[b]).cross(r + shift[c])) - p.dot(q.cross(r));
    }
    sums[begin / kSummedBlock] = sum;
  });
  double total = 0;
  for (const double s : sums) total += s;
  return total / 6;
}

}  // namespace geoprior::fluid
