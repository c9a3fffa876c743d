#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "baselines/sketch/shared/lbfgs.h"
#include "core/mesh.h"
#include "core/options.h"
#include "models/sketch/surface/position_cholesky.h"

namespace geoprior::sketch {

/// What a gradient is divided by before it is a direction.
enum class DescentMetric {
  flat,         ///< nothing: the gradient of positions; the surface stays nearest
  laplacian,    ///< K, the cotangent matrix (Sobolev H1): falls fastest
  bilaplacian,  ///< K M^-1 K, M the vertex areas (Sobolev H2): the shape drifts as a whole
};

/// How an energy of the positions is descended.
struct DescentOptions {
  int memory = 10;
  DescentMetric metric = DescentMetric::laplacian;
  bool fixed_border = true;
};
void describe(OptionVisitor& v, DescentOptions& options);

/// Value of an energy at positions (n x 3), and its gradient when it is asked for. A function
/// object may keep scratch: it is never called by two threads at once.
using PositionEnergy = std::function<double(const Eigen::MatrixX3d& x, Eigen::MatrixX3d* gradient)>;

/// Descent of an energy of a mesh's positions: L-BFGS on a factorised Sobolev metric, backtracking
/// (Armijo) line search, and a guard: a step in which a normal turns too far is shortened, and
/// corners of a thin triangle that would get thinner stay for that step. Connectivity stays.
///
/// The metric is that of the mesh that is given; it is scaled by each step, so that it need only
/// have the right shape. For closed components K is singular (translations): M / L^2 with the
/// diagonal L of the bounding box is added.
class SurfaceDescent {
 public:
  /// @param mesh    manifold, open or closed, no degenerate triangles
  /// @throws Error  on a degenerate triangle (names it)
  SurfaceDescent(const TriMesh& mesh, PositionEnergy energy, const DescentOptions& options);

  /// One step; nothing when no direction of descent is left.
  void step();

  [[nodiscard]] const TriMesh& surface() const { return mesh_; }
  [[nodiscard]] double energy() const { return value_; }
  [[nodiscard]] const Eigen::MatrixX3d& gradient() const { return gradient_; }
  [[nodiscard]] int iterations() const { return iterations_; }    ///< steps taken
  [[nodiscard]] int evaluations() const { return evaluations_; }  ///< of the energy, in all
  /// Whether neither L-BFGS nor the preconditioned gradient leads down any further.
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  void build_metric();
  void precondition(Eigen::MatrixX3d& values) const;
  double evaluate(const Eigen::MatrixX3d& x, Eigen::MatrixX3d& gradient);
  /// Shortens a direction until the energy falls enough, and goes there.
  bool search(Eigen::MatrixX3d direction);
  /// Whether a triangle's normal would turn by more than a step may.
  [[nodiscard]] bool turns_too_far(const Eigen::MatrixX3d& x) const;
  /// Stops a direction at the corners of triangles that are too thin at `x` and were less so.
  /// @return  whether there are any
  bool hold_thin(const Eigen::MatrixX3d& x, Eigen::MatrixX3d& direction) const;
  /// Where a part of a direction leads, after `hold_thin`; false when normals turn too far.
  bool admit(double part, Eigen::MatrixX3d& direction, Eigen::MatrixX3d& there) const;

  TriMesh mesh_;
  PositionEnergy function_;
  DescentOptions options_;
  std::vector<bool> fixed_;
  Eigen::VectorXd area_;  ///< of vertices: M
  std::optional<PositionCholesky> cholesky_;
  double mean_edge_ = 0;
  Lbfgs lbfgs_;
  double value_ = 0;
  Eigen::MatrixX3d gradient_;
  int iterations_ = 0;
  int evaluations_ = 0;
  bool finished_ = false;
};

}  // namespace geoprior::sketch
