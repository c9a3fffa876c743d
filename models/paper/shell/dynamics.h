#pragma once

#include <memory>
#include <vector>

#include "models/paper/cholesky/block_matrix.h"
#include "models/paper/cholesky/sparse_cholesky.h"
#include "models/paper/contact/contact.h"
#include "models/paper/sheet/handle_map.h"
#include "models/paper/shell/elements.h"
#include "models/paper/shell/energies.h"
#include "models/paper/shell/secant_pairs.h"
#include "models/paper/shell/stepper_options.h"
#include "models/paper/shell/system.h"

namespace geoprior::paper {

/// A sheet on one connectivity: all that is computed once for it, and one implicit Euler step,
///
///   M (v1 - v0) / dt = -dE/dx (x1) - c K v1 + contact + loads + M g,      x1 = x0 + dt v1
///
/// M lumped, E elastic, c the damping time, K the Hessian of E at x0 projected to positive
/// semidefinite. `linear` replaces dE/dx (x1) by dE/dx (x0) + dt K v1, so that a step is one linear
/// solve; `newton` solves the equation. Vertices held by a handle have v1 given; their rows are
/// taken out of the system and yield the handle's reaction. A hand that gives is a spring k (y -
/// x1) to the place y that it wants, implicit in both.
///
/// Vectors in solver order have three rows a vertex, at its position in the elimination order.
class ShellDynamics {
 public:
  /// @throws Error  on a triangle without area or turned over in the pattern, on a vertex that no
  ///                triangle uses, on a handle without vertices
  ShellDynamics(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                const ShellState& state);

  /// What one step did. Positions and velocities are only meaningful when it is `good`: solved,
  /// finite, no triangle collapsed or turned over.
  struct Step {
    bool good = false;
    bool overshot = false;  ///< linear: stretching alone takes more energy than there was
    int solves = 0;
    double residual = 0;
    Eigen::MatrixX3d x, v;
    double handle_work = 0;                     ///< by prescribed handles (J)
    std::vector<Eigen::Vector3d> handle_force;  ///< N, on the sheet
  };
  void step(const ShellState& state, double dt, Integration integration, Step& result);

  [[nodiscard]] ShellEnergies energies(const ShellState& state) const;
  [[nodiscard]] Eigen::MatrixX3d elastic_forces(const ShellState& state) const;
  [[nodiscard]] Eigen::MatrixX3d elastic_forces(const ShellState& state,
                                                const std::vector<int>& triangles) const;
  [[nodiscard]] long factor_nonzeros() const { return cholesky_->nonzeros(); }
  [[nodiscard]] const HandleMap& handles() const { return handles_; }
  [[nodiscard]] const ShellElements& elements() const { return elements_; }
  [[nodiscard]] int vertices() const { return static_cast<int>(mass_.size()); }
  [[nodiscard]] int triangles() const { return elements_.size(); }

 private:
  /// What is fixed during a step; vectors in solver order.
  struct Problem {
    const ShellState* state = nullptr;
    double dt = 0, time = 0;                        ///< its length and end (s)
    Eigen::VectorXd velocity;                       ///< v0
    Eigen::VectorXd loads;                          ///< weight and dead loads (N)
    std::vector<HandleMap::Target> targets;         ///< prescribed
    std::vector<HandleMap::Target> springs;         ///< of hands that give
    std::vector<HandleMap::Target> springs_before;  ///< all targets at the start of the step
    std::vector<char> held;                         ///< of each position
    Eigen::VectorXd prescribed;                     ///< v1 - v0 of held vertices, 0 of others
    Eigen::MatrixX3d ballistic;  ///< displacement without contact and elasticity (n x 3, m)
    std::vector<ContactPoint> contacts;
    std::vector<FrictionPoint> frictions;
    Eigen::VectorXd start, inertial;  ///< newton: x0; x0 + dt v0 + dt^2 M^-1 loads
  };

  void analyse();
  void pose(const ShellState& state, double dt);
  void find_contacts();
  [[nodiscard]] double expected_slip(const ContactPoint& point, double limit) const;

  // One linear solve: the change of velocity, and the reactions (N).
  bool solve_linear(Eigen::VectorXd& change, Eigen::VectorXd& reaction);
  void add_linear_contacts();
  void add_linear_springs();
  bool solve_held(const Eigen::VectorXd& prescribed, Eigen::VectorXd& solution);

  // Implicit Euler solved by Newton's method.
  bool solve_newton(Step& result, Eigen::VectorXd& reaction);
  void prepare_potential();
  [[nodiscard]] Eigen::MatrixX3d held_still() const;
  void prepare_newton(Step& result);
  bool find_direction(const Eigen::VectorXd& gradient, SecantPairs& secants,
                      Eigen::VectorXd& direction);
  double search_line(const Eigen::VectorXd& direction, double slope, Eigen::MatrixX3d& x,
                     double& value, Eigen::MatrixX3d& trial);
  double potential(const Eigen::MatrixX3d& x);
  double potential_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);
  void add_contact_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);
  void add_friction_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);
  void add_spring_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);
  [[nodiscard]] Eigen::Vector3d slip_of(const FrictionPoint& friction,
                                        const Eigen::MatrixX3d& x) const;

  void place(const Eigen::VectorXd& change, Step& result) const;
  void report_handles(const Eigen::VectorXd& reaction, Step& result) const;
  /// Adds w_i w_j `block` for the vertices of a contact to the matrix.
  void add_contact_block(const ContactPoint& point, const Eigen::Matrix3d& block);
  /// Adds w_i `vector` for the vertices of a contact.
  void add_contact_vector(const ContactPoint& point, const Eigen::Vector3d& vector,
                          Eigen::VectorXd& sum) const;
  [[nodiscard]] bool sound(const Eigen::MatrixX3d& before, const Eigen::MatrixX3d& after) const;
  [[nodiscard]] bool stretches(const Eigen::MatrixX3d& before, const Eigen::MatrixX3d& after) const;
  [[nodiscard]] bool overshoots(const Eigen::MatrixX3d& x);
  void gather(const Eigen::MatrixX3d& by_vertex, Eigen::VectorXd& by_position) const;
  [[nodiscard]] Eigen::Index row(int vertex) const { return 3 * position_[vertex]; }

  const Sheet* sheet_;
  const StepperOptions* options_;
  ShellElements elements_;
  HandleMap handles_;
  std::vector<std::unique_ptr<ContactTerm>> contact_terms_;
  Eigen::VectorXd mass_;  ///< of each vertex (kg)
  std::vector<int> position_;
  BlockMatrix matrix_;
  std::unique_ptr<ShellSystem> system_;
  std::unique_ptr<SparseCholesky> cholesky_;

  // Kept between steps so that a step allocates nothing.
  Problem problem_;
  ShellSystem::Sums sums_;
  Eigen::VectorXd right_, scratch_;
  std::vector<BlockMatrix::Taken> taken_;
  std::vector<ContactPoint> touching_;
  BlockMatrix damping_;  ///< dt c K, newton
};

/// Mass of each vertex: a third of its triangles' (kg).
/// @throws Error  on a triangle without area or turned over, on a vertex that no triangle uses
Eigen::VectorXd lumped_masses(const ShellMesh& mesh, double area_density);

}  // namespace geoprior::paper
