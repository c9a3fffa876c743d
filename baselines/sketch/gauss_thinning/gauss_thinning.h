#pragma once

#include <Eigen/Core>
#include <vector>

#include "baselines/sketch/gauss_thinning/rotation_targets.h"
#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::sketch {

struct GaussThinningOptions {
  double radius = 0.03;
  double start_angle_deg = 25;  ///< of the cone about a normal in which others count, at first
  double final_angle_deg = 2.5;
  double shrink = 0.98;
};
void describe(OptionVisitor& v, GaussThinningOptions& options);

/// Gauss-image thinning (Binninger, Verhoeven, Herholz, Sorkine-Hornung, Developable Approximation
/// via Gauss Image Thinning, 2021): the normals of a developable surface trace curves on the unit
/// sphere, so normals are gathered onto curves and the surface follows.
///
/// A step, as published. Local: for triangle t, over triangles f of a neighbourhood whose normals
/// lie within the cone about n_t, a great circle is fitted, whose axis a is the eigenvector of the
/// smallest eigenvalue of sum w_f n_f n_f'; n_t is rotated by the shortest rotation R_t onto the
/// circle, to n_t - (n_t . a) a normalised. Global: the vertices X for which the triangles follow
/// their rotations best in the least-squares sense with cotangent weights, factorised once
/// (`RotationPoisson`, (b), with the edges of the surface as it is now). The cone shrinks from step
/// to step, so that creases come out between pieces that no longer see each other.
///
/// Ours: neighbourhoods are found once, on the mesh that is given, by walking over vertices while
/// barycentres are within the radius (the one-ring always belongs); w_f is the area as it is now;
/// the numbers of the options, of which the paper gives the two angles. (A weight that falls to
/// zero at the border of the cone leaves more curvature: it makes the cone smaller.)
///
/// It keeps neither silhouettes nor borders, and bends cones, whose normals lie on small circles
/// (an open frustum of half angle 14 degrees ends with a sum of |angle defects| of 0.4). Triangles
/// may turn over, and no energy is minimised, since each step's targets are new.
class GaussThinning {
 public:
  /// @param mesh    manifold, open or closed
  /// @throws Error  on an index out of range, or angles or a radius or a shrink out of bounds
  explicit GaussThinning(const TriMesh& mesh, const GaussThinningOptions& options = {});

  void step();

  [[nodiscard]] const TriMesh& surface() const { return mesh_; }
  /// Mean of the squared sines (by area) between normals and the great circles that were fitted in
  /// the last step, before it; 0 before the first. Not monotone while the cone shrinks.
  [[nodiscard]] double energy() const { return energy_; }
  [[nodiscard]] int iterations() const { return iterations_; }
  /// Cone of the next step (deg).
  [[nodiscard]] double cone_angle_deg() const { return cone_deg_; }
  /// Number of triangles that are in reach of one another, in all.
  [[nodiscard]] std::size_t neighbour_count() const { return neighbour_.size(); }

 private:
  void find_neighbourhoods(double radius);
  void measure();
  /// Fits the circle of a triangle, sets its rotation.
  /// @return  squared sine of the normal from the circle
  double turn_onto_circle(int t, double cone_cosine);

  TriMesh mesh_;
  GaussThinningOptions options_;
  RotationPoisson poisson_;
  std::vector<std::size_t> begin_;  ///< of each triangle's row
  std::vector<int> neighbour_;      ///< itself too
  Eigen::Matrix4Xd normal_;         ///< unit, and the area below it
  std::vector<Eigen::Matrix3d> rotation_;
  Eigen::VectorXd missed_;  ///< squared sine times area, by triangle
  double cone_deg_;
  double energy_ = 0;
  int iterations_ = 0;
};

}  // namespace geoprior::sketch
