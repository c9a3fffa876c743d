#pragma once

#include "baselines/sketch/shared/star_geometry.h"
#include "baselines/sketch/shared/surface_descent.h"
#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::sketch {

/// Hinge energy of a mesh, with its gradient by the positions:
///
///   E = sum over interior vertices of lambda_min( sum over its triangles of theta_f n_f n_f' )
///
/// theta_f the angle of the triangle at the vertex and n_f its unit normal. With x the eigenvector
/// of lambda_min,  dE_v = sum_f [ d theta_f (n_f . x)^2 + 2 theta_f (n_f . x) (d n_f . x) ].
/// Where the two lowest eigenvalues of a vertex are equal E is continuous but has a kink, and the
/// gradient is that of one side. Zero if and only if every star is a hinge (the normals of its
/// triangles lie in a plane).
class HingeEnergy {
 public:
  /// @throws Error  on a vertex index out of range
  HingeEnergy(const Eigen::MatrixX3i& F, int vertex_count) : stars_(F, vertex_count) {}

  /// @param x         n x 3 positions
  /// @param gradient  gets n x 3 derivatives; may be null
  double operator()(const Eigen::MatrixX3d& x, Eigen::MatrixX3d* gradient);

 private:
  double add_vertex(int v);

  StarGeometry stars_;
  StarDerivatives derivatives_;
  Eigen::VectorXd at_vertex_;
};

struct DevelopabilityFlowOptions {
  DescentOptions descent;
};
void describe(OptionVisitor& v, DevelopabilityFlowOptions& options);

/// Descent of the hinge energy (Stein, Grinspun, Crane, Developability of Triangle Meshes, 2018):
/// the surface breaks into developable pieces whose creases choose themselves. The energy is the
/// paper's E^lambda; its gradient is written out here. Ours are the metric of the descent
/// (Laplacian, L-BFGS) and the guard of its triangles (`DescentOptions`).
///
/// It knows nothing of silhouettes, depends on the layout of the mesh (rulings follow edges), and
/// stops in one of many local minima; connectivity stays, so that a crease can come out jagged.
class DevelopabilityFlow {
 public:
  /// @param mesh    manifold, open or closed, no degenerate triangles
  /// @throws Error  on a degenerate triangle or an index out of range
  explicit DevelopabilityFlow(const TriMesh& mesh, const DevelopabilityFlowOptions& options = {});

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
