#pragma once

#include "baselines/sketch/shared/star_geometry.h"
#include "baselines/sketch/shared/surface_descent.h"
#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::sketch {

/// Sum of squared angle defects (2 pi - sum of angles) of the interior vertices (rad^2), with its
/// gradient by the positions, and optionally a term that holds vertices near where they were:
///
///   E = sum_v K_v^2 + closeness sum_v (A_v / A) |x_v - x0_v|^2 / h^2
///
/// A_v vertex areas, A their sum, h the mean edge length, all of the mesh that is given.
class AngleDefectEnergy {
 public:
  /// @throws Error  on a vertex index out of range
  AngleDefectEnergy(const TriMesh& mesh, double closeness);

  /// @param x         n x 3 positions
  /// @param gradient  gets n x 3 derivatives; may be null
  double operator()(const Eigen::MatrixX3d& x, Eigen::MatrixX3d* gradient);

 private:
  StarGeometry stars_;
  StarDerivatives derivatives_;
  Eigen::VectorXd at_vertex_;
  Eigen::MatrixX3d start_;
  Eigen::VectorXd hold_;  ///< closeness A_v / (A h^2)
};

struct AngleDefectFlowOptions {
  double closeness = 0;
  DescentOptions descent;
};
void describe(OptionVisitor& v, AngleDefectFlowOptions& options);

/// Descent of the squared angle defects, the plainest way to make a mesh developable (after Wang
/// and Tang, Achieving Developability of a Polygonal Surface by Minimum Deformation, 2004, who
/// minimise the defects under a penalty of deformation; theirs is the energy, the descent is ours).
///
/// Blind to a surface that is crumpled: the defect of every vertex vanishes on one that no sheet
/// without singular points can take. On a closed surface of genus 0 the defects add up to 4 pi, and
/// the square favours spreading them evenly, not gathering them in corners.
class AngleDefectFlow {
 public:
  /// @param mesh    manifold, open or closed, no degenerate triangles
  /// @throws Error  on a degenerate triangle, an index out of range or a negative closeness
  explicit AngleDefectFlow(const TriMesh& mesh, const AngleDefectFlowOptions& options = {});

  void step() { descent_.step(); }
  [[nodiscard]] const TriMesh& surface() const { return descent_.surface(); }
  [[nodiscard]] double energy() const { return descent_.energy(); }
  [[nodiscard]] int iterations() const { return descent_.iterations(); }
  /// Whether no direction leads down any further.
  [[nodiscard]] bool finished() const { return descent_.finished(); }
  [[nodiscard]] const SurfaceDescent& descent() const { return descent_; }

 private:
  SurfaceDescent descent_;
};

}  // namespace geoprior::sketch
