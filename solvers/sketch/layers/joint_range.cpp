#include "solvers/sketch/layers/joint_range.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/triangle_tree.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr double kAngleStep = kDegree;
constexpr int kAngleBisections = 10;
constexpr double kAngleMargin = 0.01 * kDegree;
constexpr double kLeastCover = 0.1;  // of the overlap
constexpr int kRimSamples = 24;

/// A layer as a solid at rest, with a tree and its edges.
struct LayerSolid {
  TriMesh mesh;
  TriangleTree tree;
  std::vector<Edge> edges;

  explicit LayerSolid(TriMesh solid)
      : mesh(std::move(solid)), tree(mesh), edges(EdgeConnectivity(mesh.F).edges()) {}
};

/// Whether an edge of b, moved, meets a triangle of a.
bool edges_meet(const LayerSolid& a, const LayerSolid& b, const Eigen::Isometry3d& move) {
  const Eigen::Matrix3Xd X = (move.linear() * b.mesh.V.transpose()).colwise() + move.translation();
  return std::any_of(b.edges.begin(), b.edges.end(),
                     [&](const Edge& e) { return a.tree.meets_segment(X.col(e[0]), X.col(e[1])); });
}

/// Whether two layers touch when b is moved against a.
bool layers_touch(const LayerSolid& a, const LayerSolid& b, const Eigen::Isometry3d& move) {
  return edges_meet(a, b, move) || edges_meet(b, a, move.inverse());
}

/// Whether the rear rim of the front layer lies above the layer behind, which is moved: behind its
/// front rim, and ahead of its rear rim, which would otherwise vanish below.
bool rim_is_covered(const FrustumBand& front, const FrustumBand& behind, const LayerHinge& hinge,
                    double overlap, const Eigen::Isometry3d& move) {
  const Eigen::Isometry3d back = move.inverse();
  for (int k = 0; k <= kRimSamples; ++k) {
    const Eigen::Vector3d rim = front.point(0, hinge.front_hole * k / kRimSamples);
    const double x = behind.own(back * rim).x(), least = kLeastCover * overlap;
    if (x < -behind.length + least || x > -least) return false;
  }
  return true;
}

/// The largest angle of a sign up to which all are free.
template <class Free>
double free_angle(double most, const Free& is_free) {
  double low = 0;
  while (low < most) {
    const double next = std::min(low + kAngleStep, most);
    if (is_free(next)) {
      low = next;
      continue;
    }
    double high = next;
    for (int i = 0; i < kAngleBisections; ++i) {
      const double middle = (low + high) / 2;
      (is_free(middle) ? low : high) = middle;
    }
    return std::max(low - kAngleMargin, 0.0);
  }
  return most;
}

class JointLimits {
 public:
  JointLimits(ArticulatedLayers& layers, const LayerOptions& options)
      : layers_(layers), options_(options) {
    for (const FrustumBand& band : layers.bands)
      solids_.emplace_back(band_solid(band, options.thickness * layers.unit, options.grid));
  }

  void set() {
    parallel_blocks(layers_.hinges.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) set_hinge(j);
    });
    reduce(1, &LayerHinge::curl);
    reduce(-1, &LayerHinge::stretch);
  }

 private:
  void set_hinge(std::size_t j) {
    LayerHinge& hinge = layers_.hinges[j];
    const auto is_free = [&](double angle) {
      const Eigen::Isometry3d move = hinge_turn(hinge, angle);
      if (options_.keep_covered && !rim_is_covered(layers_.bands[j], layers_.bands[j + 1], hinge,
                                                   layers_.overlaps[j + 1], move)) {
        return false;
      }
      return !layers_touch(solids_[j], solids_[j + 1], move);
    };
    if (!is_free(0)) return;
    const double most = options_.max_angle_deg * kDegree;
    hinge.curl = free_angle(most, is_free);
    hinge.stretch = free_angle(most, [&](double angle) { return is_free(-angle); });
  }

  [[nodiscard]] bool others_touch(double sign, double LayerHinge::*limit) const {
    std::vector<double> angles;
    for (const LayerHinge& hinge : layers_.hinges) angles.push_back(sign * hinge.*limit);
    const auto poses = layer_poses(layers_, angles);
    for (std::size_t a = 0; a < solids_.size(); ++a) {
      for (std::size_t b = a + 2; b < solids_.size(); ++b) {
        if (layers_touch(solids_[a], solids_[b], poses[a].inverse() * poses[b])) return true;
      }
    }
    return false;
  }

  void reduce(double sign, double LayerHinge::*limit) {
    constexpr double kLess = 0.9;
    constexpr int kMost = 40;
    for (int i = 0; i < kMost && others_touch(sign, limit); ++i) {
      for (LayerHinge& hinge : layers_.hinges) hinge.*limit *= kLess;
    }
  }

  ArticulatedLayers& layers_;
  const LayerOptions& options_;
  std::vector<LayerSolid> solids_;
};

}  // namespace

bool joint_turns(const LayerJoint& joint, double angle, const LayerOptions& options, double unit) {
  const auto covered = [&](double at) {
    return rim_is_covered(joint.front, joint.behind, joint.hinge, joint.overlap,
                          hinge_turn(joint.hinge, at));
  };
  if (options.keep_covered && !(covered(0) && covered(angle) && covered(-angle))) return false;
  const double thickness = options.thickness * unit;
  const LayerSolid front(band_solid(joint.front, thickness, options.grid));
  const LayerSolid behind(band_solid(joint.behind, thickness, options.grid));
  for (const double turned : {0.0, -1.0, -0.5, 0.5, 1.0}) {
    if (layers_touch(front, behind, hinge_turn(joint.hinge, turned * angle))) return false;
    if (angle == 0) break;
  }
  return true;
}

void set_joint_limits(ArticulatedLayers& layers, const LayerOptions& options) {
  JointLimits(layers, options).set();
}

}  // namespace geoprior::sketch
