#include "experiments/details/drawing/drawn_spikes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "experiments/details/drawing/smooth_normals.h"
#include "experiments/details/drawing/surface_rays.h"

namespace geoprior::details {
namespace {

constexpr double kLeastSpikeWeight = 1e-3;
constexpr std::size_t kSpikeBlock = 64;

/// A ring of a spike in units of radius and height.
struct Ring {
  double radius;  ///< geodesic
  double height;
  double lean;
};

/// Ring at share `u` of the rings from foot to tip; below 0 the profile goes on in a straight line.
Ring profile_at(SpikeProfile profile, double u, double lean) {
  switch (profile) {
    case SpikeProfile::cone: {
      // Rings crowd at the tip, where smooth shading would round it.
      const double s = u < 0 ? 1 - u : (1 - u) * (1 - u);
      return {s, 1 - s, 0};
    }
    case SpikeProfile::dome: {
      if (u < 0) return {1 - u, 2 * u, 0};
      const double s = std::cos(0.5 * std::numbers::pi * u);
      return {s, 1 - s * s, 0};
    }
    case SpikeProfile::thorn:
      break;
  }
  const double flare = 1.7;
  if (u < 0) return {1 - flare * u, u, 0};
  return {std::pow(1 - u, flare), u, lean * u * u};
}

/// From the innermost ring to the one below the surface.
std::vector<Ring> rings_of(const SpikeOptions& options) {
  std::vector<Ring> rings;
  for (int j = kSpikeRings - 1; j >= 0; --j)
    rings.push_back(
        profile_at(options.profile, static_cast<double>(j) / kSpikeRings, options.lean));
  rings.push_back(profile_at(options.profile, -0.08, options.lean));
  return rings;
}

/// Triangles of a spike: rings from inside to outside, then tip and bottom.
std::vector<std::array<int, 3>> spike_triangles(int sectors, int rings) {
  std::vector<std::array<int, 3>> F;
  const int tip = sectors * rings, bottom = tip + 1, last = sectors * (rings - 1);
  for (int k = 0; k < sectors; ++k) {
    const int l = (k + 1) % sectors;
    F.push_back({tip, k, l});
    for (int j = 0; j + 1 < rings; ++j) {
      const int in = sectors * j, out = in + sectors;
      F.push_back({in + k, out + k, out + l});
      F.push_back({in + k, out + l, in + l});
    }
    F.push_back({bottom, last + l, last + k});
  }
  return F;
}

class SpikeDrawer {
 public:
  SpikeDrawer(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
              const SpikeOptions& options, double radius, double height)
      : options_(options),
        radius_(radius),
        height_(height),
        rings_(rings_of(options)),
        triangles_(spike_triangles(kSpikeSectors, static_cast<int>(rings_.size()))),
        rays_(surface, x),
        distance_(rings_.size()),
        on_surface_(rings_.size()),
        point_(rings_.size() * kSpikeSectors + 2),
        normal_(point_.size()) {
    for (int k = 0; k < kSpikeSectors; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSpikeSectors;
      ray_.emplace_back(std::cos(angle), std::sin(angle));
    }
  }

  [[nodiscard]] std::size_t vertices() const { return point_.size(); }
  [[nodiscard]] std::size_t triangles() const { return triangles_.size(); }

  void draw(const DrawnAnchor& anchor, const Eigen::Vector3d& normal) {
    const double width = options_.weight_scales == WeightScales::size ? anchor.weight : 1.0;
    const Eigen::Vector3d up = anchor.weight * height_ * normal;
    rays_.start(anchor.at, anchor.tangent);
    const Eigen::Vector3d ahead = anchor.weight * height_ * rays_.tangent();
    for (std::size_t j = 0; j < rings_.size(); ++j)
      distance_[j] = rings_[j].radius * width * radius_;
    const std::size_t sectors = kSpikeSectors;
    Eigen::Vector3d bottom = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < sectors; ++k) {
      rays_.trace(ray_[k], distance_, on_surface_);
      for (std::size_t j = 0; j < rings_.size(); ++j)
        point_[j * sectors + k] = on_surface_[j] + rings_[j].height * up + rings_[j].lean * ahead;
      bottom += point_[(rings_.size() - 1) * sectors + k];
    }
    const Ring tip = profile_at(options_.profile, 1, options_.lean);
    point_[point_.size() - 2] = rays_.origin() + tip.height * up + tip.lean * ahead;
    point_[point_.size() - 1] = bottom / kSpikeSectors;
  }

  void write(int detail, std::size_t number, DrawnDetails& drawn) {
    const Eigen::Index vertex = number * point_.size();
    Eigen::Index triangle = number * triangles_.size();
    std::fill(normal_.begin(), normal_.end(), Eigen::Vector3d::Zero());
    for (const auto& f : triangles_) {
      const Eigen::Vector3d n = (point_[f[1]] - point_[f[0]]).cross(point_[f[2]] - point_[f[0]]);
      for (const int v : f) normal_[v] += n;
      for (Eigen::Index k = 0; k < 3; ++k)
        drawn.mesh.F(triangle, k) = static_cast<int>(vertex) + f[k];
      ++triangle;
    }
    for (std::size_t v = 0; v < point_.size(); ++v) {
      const Eigen::Index row = vertex + v;
      drawn.mesh.V.row(row) = point_[v].transpose();
      drawn.normals.row(row) = normal_[v].normalized().transpose();
      drawn.detail[row] = detail;
    }
  }

 private:
  const SpikeOptions& options_;
  double radius_, height_;
  std::vector<Ring> rings_;
  std::vector<std::array<int, 3>> triangles_;
  SurfaceRays rays_;
  std::vector<Eigen::Vector2d> ray_;
  std::vector<double> distance_;
  std::vector<Eigen::Vector3d> on_surface_;
  std::vector<Eigen::Vector3d> point_, normal_;
};

}  // namespace

void describe(OptionVisitor& v, SpikeOptions& o) {
  static constexpr std::array<std::string_view, 3> kProfiles{"cone", "dome", "thorn"};
  static constexpr std::array<std::string_view, 2> kScales{"size", "height"};
  describe_choice(v, "profile", o.profile, kProfiles, {"shape of a spike"});
  v.value("height", o.height, {"height of a spike of weight 1, in `unit`", "", 0, 1e6});
  v.value("lean", o.lean,
          {"share of the height that the tip of a thorn is off along the tangent", "", -10, 10});
  describe_choice(v, "weight_scales", o.weight_scales, kScales,
                  {"the weight scales height and radius (size), or the height alone"});
}

DrawnDetails draw_spikes(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                         std::span<const DrawnAnchor> anchors, const SpikeOptions& options,
                         double radius, double height) {
  std::vector<int> visible;
  for (int i = 0; i < std::ssize(anchors); ++i)
    if (anchors[i].weight >= kLeastSpikeWeight) visible.push_back(i);
  const std::vector<Eigen::Vector3d> normals = normals_at(surface, x, anchors);
  const SpikeDrawer model(surface, x, options, radius, height);
  DrawnDetails drawn;
  const Eigen::Index rows = visible.size() * model.vertices();
  drawn.mesh.V.resize(rows, 3);
  drawn.normals.resize(rows, 3);
  drawn.detail.resize(rows);
  drawn.mesh.F.resize(visible.size() * model.triangles(), 3);
  parallel_blocks(visible.size(), kSpikeBlock, [&](std::size_t begin, std::size_t end) {
    SpikeDrawer spike = model;
    for (std::size_t i = begin; i < end; ++i) {
      const int anchor = visible[i];
      spike.draw(anchors[anchor], normals[anchor]);
      spike.write(visible[i], i, drawn);
    }
  });
  return drawn;
}

}  // namespace geoprior::details
