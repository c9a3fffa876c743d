#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "baselines/skinning/linear_blend/linear_blend.h"
#include "core/inputs/rig.h"
#include "core/options.h"

namespace geoprior::skinning {

struct DeltaMushOptions {
  int iterations = 20;
  double step = 0.5;
  bool pin_border = false;
};
void describe(OptionVisitor& v, DeltaMushOptions& options);

/// Delta mush: linear blend, smoothed, with the detail that smoothing takes from the rest pose put
/// back in local frames.
///
///   s  = S(p)                 Jacobi passes p_i += step (mean of the ring - p_i), uniform weights
///   d_i = R_i^T (p_i - s_i)   at rest, R_i a frame of the smoothed rest surface
///   v'_i = s'_i + R'_i d_i    posed, s' = S(linear blend), R' the same frame of s'
///
/// At rest s' = s and R' = R, so that v' = p: the rest pose returns the input by construction.
/// R_i is the rotation part of the linear map that fits the whole ring best (least squares over the
/// tangential rest coordinates of the neighbours): n = a x b, t = a + b x n made unit, b = n x t.
/// It averages over the ring, does not depend on one chosen edge, and turns with the surface. Where
/// a ring spans no plane (a collapsed or isolated vertex), the detail turns with the vertex's
/// strongest joint.
///
/// Smoothing hides the collapse and the creases of linear blending, but knows nothing of volume or
/// contact: joints lose volume under large bends, and features that are not surface detail (a
/// finger) are smoothed if `iterations` reach across them.
///
/// Source: Mancewicz, Derksen, Rijpkema, Wilson 2014. The frames differ: theirs come from the
/// normal and one edge at a time.
class DeltaMush {
 public:
  /// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m (validated; throws
  /// Error). Border and non-manifold vertices are smoothed like others unless pinned.
  DeltaMush(const RiggedMesh& rig, const DeltaMushOptions& options);

  /// Writes the posed positions (n x 3, metres); resizes `posed` when needed, allocates nothing
  /// otherwise. Not const: it uses buffers of its own.
  /// @throws Error  unless `pose` has m transforms
  void deform(const Pose& pose, Eigen::MatrixX3d& posed);

 private:
  /// Tangential coefficients of one neighbour: sum over the ring of (along * edge) is a, of
  /// (across * edge) is b.
  struct FrameWeight {
    double along;
    double across;
  };
  /// Four doubles a vertex (x, y, z, unused), aligned: one load a neighbour.
  struct alignas(32) Point {
    double x, y, z, w;
  };
  void build_rings(const RiggedMesh& rig, bool pin_border);
  void build_frames();
  void load(const Eigen::MatrixX3d& V);
  void smooth();

  LinearBlend blend_;
  DeltaMushOptions options_;
  std::vector<std::uint32_t> ring_offset_;
  std::vector<std::uint32_t> ring_;
  std::vector<double> pull_;  ///< step / ring size of each vertex; 0 for one that stays
  std::vector<FrameWeight> frame_weight_;  ///< one a ring entry
  std::vector<Point> detail_;              ///< d_i in the frame of i
  std::vector<Point> rest_offset_;         ///< p_i - s_i in rest coordinates
  std::vector<int> strongest_joint_;
  std::vector<Point> current_;
  std::vector<Point> next_;
};

}  // namespace geoprior::skinning
