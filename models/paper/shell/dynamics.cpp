#include "models/paper/shell/dynamics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/paper/cholesky/cholmod.h"
#include "models/paper/cholesky/eigen.h"
#include "models/paper/cholesky/supernodal.h"

// One linear solve a step: (M + dt (dt + c) K + ...) (v1 - v0) = dt f - dt (dt + c) K v0 + ...
// Implicit Euler solved: the minimum over x, held vertices at their places, of
//   1/2 |x - x0 - dt v0 - dt^2 M^-1 loads|^2_M + dt^2 (E + contact + friction) + dt c/2 |x -
//   x0|^2_K
// by Newton's method with Hessians projected to positive semidefinite, corrected by the secants of
// the step's earlier iterations, and backtracking.

namespace geoprior::paper {
namespace {

/// A triangle that lost this much of its area in one step has collapsed.
constexpr double kLeastAreaRatio = 1e-3;
/// An edge that grows by more than this factor in a step gives cause to look whether the step went
/// too far: paper tears long before.
constexpr double kMostGrowth = 1.5;

Eigen::Vector3d normal(const Eigen::MatrixX3d& x, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = x.row(t[0]);
  const Eigen::Vector3d b = x.row(t[1]);
  const Eigen::Vector3d c = x.row(t[2]);
  return (b - a).cross(c - a);
}

bool gives(const HandleMap::Target& target) { return target.stiffness.has_value(); }

/// Of the hands that give among the targets (J).
double spring_energy(const std::vector<HandleMap::Target>& targets, const Eigen::MatrixX3d& x) {
  double energy = 0;
  for (const HandleMap::Target& t : targets) {
    if (gives(t))
      energy += *t.stiffness / 2 * (x.row(t.vertex).transpose() - t.place).squaredNorm();
  }
  return energy;
}

NodeGraph element_graph(const ShellElements& elements, int vertices) {
  std::vector<int> offset(1, 0);
  std::vector<int> members;
  offset.reserve(elements.size() + 1);
  members.reserve(static_cast<std::size_t>(elements.size()) * 6);
  for (int e = 0; e < elements.size(); ++e) {
    const auto nodes = elements.nodes(e);
    members.insert(members.end(), nodes.begin(), nodes.end());
    offset.push_back(static_cast<int>(members.size()));
  }
  return couple_groups(vertices, offset, members);
}

}  // namespace

Eigen::VectorXd lumped_masses(const ShellMesh& mesh, double area_density) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Eigen::Vector3i v = mesh.triangles.row(t);
    const Eigen::Vector2d a = mesh.pattern.row(v[0]);
    const Eigen::Vector2d b = mesh.pattern.row(v[1]).transpose() - a;
    const Eigen::Vector2d c = mesh.pattern.row(v[2]).transpose() - a;
    const double area = cross(b, c) / 2;
    if (!(area > 0)) {
      throw Error("no area, or turned over, in the pattern", "triangle " + std::to_string(t),
                  "counter-clockwise triangles");
    }
    for (const int i : v) mass[i] += area_density * area / 3;
  }
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    if (!(mass[i] > 0)) throw Error("no triangle uses it", "vertex " + std::to_string(i));
  }
  return mass;
}

ShellDynamics::ShellDynamics(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                             const ShellState& state)
    : sheet_(&sheet),
      options_(&options),
      elements_(state.mesh, sheet.material, options.bending),
      handles_(sheet, state, seed),
      mass_(lumped_masses(state.mesh, sheet.material.area_density)) {
  if (!sheet.obstacles.empty()) {
    contact_terms_.push_back(make_obstacle_contact(sheet.obstacles, state.mesh,
                                                   {.distance = options.contact_distance,
                                                    .stiffness = options.contact_stiffness,
                                                    .spacing = options.contact_spacing}));
  }
  analyse();
}

void ShellDynamics::analyse() {
  const bool large = triangles() >= options_->dissection_from;
  const NodeGraph graph = element_graph(elements_, vertices());
  position_ =
      elimination_order(graph, large ? Ordering::nested_dissection : Ordering::minimum_degree);
  const bool eigen = options_->solver == LinearSolver::eigen;
  using Triangle = BlockMatrix::Triangle;
  matrix_ = BlockMatrix(graph, position_, eigen ? Triangle::upper : Triangle::lower);
  system_ = std::make_unique<ShellSystem>(elements_, position_, matrix_);
  if (eigen) {
    cholesky_ = make_eigen_cholesky(matrix_);
  } else if (options_->solver == LinearSolver::cholmod) {
    cholesky_ = make_cholmod_cholesky(matrix_);
  } else {
    cholesky_ = make_supernodal_cholesky(matrix_);
  }
}

void ShellDynamics::gather(const Eigen::MatrixX3d& by_vertex, Eigen::VectorXd& by_position) const {
  by_position.resize(3 * by_vertex.rows());
  for (int i = 0; i < by_vertex.rows(); ++i) by_position.segment<3>(row(i)) = by_vertex.row(i);
}

void ShellDynamics::pose(const ShellState& state, double dt) {
  Problem& p = problem_;
  p.state = &state;
  p.dt = dt;
  p.time = state.time + dt;
  gather(state.v, p.velocity);
  Eigen::MatrixX3d loads = mass_ * sheet_->gravity.transpose();
  handles_.add_loads(*sheet_, p.time, loads);
  gather(loads, p.loads);
  handles_.targets(*sheet_, p.time, p.targets);
  p.springs.clear();
  std::copy_if(p.targets.begin(), p.targets.end(), std::back_inserter(p.springs), gives);
  std::erase_if(p.targets, gives);
  p.springs_before.clear();
  if (!p.springs.empty()) handles_.targets(*sheet_, state.time, p.springs_before);
  p.held.assign(vertices(), 0);
  p.prescribed.setZero(p.velocity.size());
  for (const HandleMap::Target& target : p.targets) {
    p.held[position_[target.vertex]] = 1;
    const Eigen::Vector3d move = target.place - state.x.row(target.vertex).transpose();
    p.prescribed.segment<3>(row(target.vertex)) =
        move / dt - state.v.row(target.vertex).transpose();
  }
  find_contacts();
}

void ShellDynamics::find_contacts() {
  Problem& p = problem_;
  p.contacts.clear();
  p.frictions.clear();
  if (contact_terms_.empty()) return;
  // Where a step without contact and elasticity would lead.
  p.ballistic = p.dt * p.state->v;
  p.ballistic.rowwise() += p.dt * p.dt * sheet_->gravity.transpose();
  for (const HandleMap::Target& t : p.targets) {
    p.ballistic.row(t.vertex) = t.place.transpose() - p.state->x.row(t.vertex);
  }
  for (const auto& term : contact_terms_) {
    term->find({p.state->x, &p.ballistic, p.time}, p.contacts);
  }
  if (!(sheet_->material.friction > 0)) return;
  for (const ContactPoint& point : p.contacts) {
    // The gap at the start of the step: the obstacle moves meanwhile.
    const double gap = point.gap + p.dt * point.normal.dot(point.surface_velocity);
    const double push = point.stiffness * (options_->contact_distance - gap);
    if (!(push > 0)) continue;
    const double limit = sheet_->material.friction * push;
    p.frictions.push_back({point, limit, expected_slip(point, limit)});
  }
}

/// Slip speed of a point at the end of the step as far as it is known before the solve: the present
/// one, or that of free flight slowed by friction, whichever is faster.
double ShellDynamics::expected_slip(const ContactPoint& point, double limit) const {
  const Problem& p = problem_;
  Eigen::Vector3d now = -point.surface_velocity, ballistic = now;
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
    now += point.weight[k] * p.state->v.row(point.vertex[k]).transpose();
    ballistic += point.weight[k] / p.dt * p.ballistic.row(point.vertex[k]).transpose();
  }
  const auto across = [&](const Eigen::Vector3d& v) {
    return (v - point.normal * point.normal.dot(v)).norm();
  };
  const double mass = point.stiffness / options_->contact_stiffness * sheet_->material.area_density;
  return std::max(across(now), across(ballistic) - p.dt * limit / mass);
}

void ShellDynamics::add_contact_block(const ContactPoint& point, const Eigen::Matrix3d& block) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(point.count); ++a) {
    for (std::size_t b = a; b < static_cast<std::size_t>(point.count); ++b) {
      const auto place = matrix_.place(position_[point.vertex[a]], position_[point.vertex[b]]);
      matrix_.add(place, point.weight[a] * point.weight[b] * block);
    }
  }
}

void ShellDynamics::add_contact_vector(const ContactPoint& point, const Eigen::Vector3d& vector,
                                       Eigen::VectorXd& sum) const {
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
    sum.segment<3>(row(point.vertex[k])) += point.weight[k] * vector;
  }
}

void ShellDynamics::place(const Eigen::VectorXd& change, Step& result) const {
  const ShellState& state = *problem_.state;
  for (int i = 0; i < vertices(); ++i) {
    result.v.row(i) = state.v.row(i) + change.segment<3>(row(i)).transpose();
  }
  result.x = state.x + problem_.dt * result.v;
  // Held vertices get their places themselves, not by way of the velocity: they would drift.
  for (const HandleMap::Target& t : problem_.targets) result.x.row(t.vertex) = t.place.transpose();
}

void ShellDynamics::report_handles(const Eigen::VectorXd& reaction, Step& result) const {
  result.handle_force.assign(sheet_->handles.size(), Eigen::Vector3d::Zero());
  result.handle_work = 0;
  for (const HandleMap::Target& t : problem_.targets) {
    const Eigen::Vector3d force = reaction.segment<3>(row(t.vertex));
    const Eigen::Vector3d from = problem_.state->x.row(t.vertex);
    result.handle_force[t.handle] += force;
    result.handle_work += force.dot(t.place - from);
  }
  for (const HandleMap::Target& t : problem_.springs) {
    const Eigen::Vector3d to = result.x.row(t.vertex);
    const Eigen::Vector3d force = *t.stiffness * (t.place - to);
    result.handle_force[t.handle] += force;
    // By its own way: the spring between is part of what it moves.
    const auto before = std::find_if(
        problem_.springs_before.begin(), problem_.springs_before.end(),
        [&](const HandleMap::Target& b) { return b.vertex == t.vertex && b.handle == t.handle; });
    if (before != problem_.springs_before.end())
      result.handle_work += force.dot(t.place - before->place);
  }
  for (std::size_t h = 0; h < sheet_->handles.size(); ++h) {
    const Handle& handle = sheet_->handles[h];
    if (handle.force && handle.is_active(problem_.time)) result.handle_force[h] = *handle.force;
  }
}

void ShellDynamics::step(const ShellState& state, double dt, Integration integration,
                         Step& result) {
  pose(state, dt);
  result.good = false;
  result.overshot = false;
  result.solves = 1;
  result.residual = 0;
  result.v.resize(vertices(), 3);
  Eigen::VectorXd change, reaction;
  const bool solved = solve_linear(change, reaction);
  if (solved) {
    place(change, result);
  } else {
    result.x.resize(0, 3);
  }
  if (integration == Integration::newton) {
    if (!solve_newton(result, reaction)) return;
  } else if (!solved) {
    return;
  }
  if (!sound(state.x, result.x)) return;
  result.overshot =
      integration == Integration::linear && stretches(state.x, result.x) && overshoots(result.x);
  report_handles(reaction, result);
  result.good = true;
}

bool ShellDynamics::sound(const Eigen::MatrixX3d& before, const Eigen::MatrixX3d& after) const {
  if (!after.allFinite()) return false;
  for (int e = 0; e < triangles(); ++e) {
    const auto nodes = elements_.nodes(e);
    const Eigen::Vector3i t(nodes[0], nodes[1], nodes[2]);
    const Eigen::Vector3d old_normal = normal(before, t);
    const Eigen::Vector3d new_normal = normal(after, t);
    if (!(old_normal.dot(new_normal) > 0)) return false;
    if (!(new_normal.squaredNorm() >
          kLeastAreaRatio * kLeastAreaRatio * old_normal.squaredNorm())) {
      return false;
    }
  }
  return true;
}

bool ShellDynamics::stretches(const Eigen::MatrixX3d& before, const Eigen::MatrixX3d& after) const {
  for (int e = 0; e < triangles(); ++e) {
    const auto nodes = elements_.nodes(e);
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = nodes[k], b = nodes[(k + 1) % 3];
      const double old_length = (before.row(a) - before.row(b)).norm();
      if ((after.row(a) - after.row(b)).norm() > kMostGrowth * old_length) return true;
    }
  }
  return false;
}

/// Whether stretching alone takes more than all that the step began with, its handles moved. Where
/// nothing is strained the linear forces know no tension, and vertices that are pulled or pushed
/// sideways go much farther than the sheet reaches. (Bending does not count: the angle of a sharp
/// fold jumps from pi to -pi where the sheet passes through itself.)
bool ShellDynamics::overshoots(const Eigen::MatrixX3d& x) {
  prepare_potential();
  const double had = potential(held_still());
  system_->energy(elements_, *problem_.state, x, sums_);
  return !(problem_.dt * problem_.dt * sums_.membrane <= had);
}

ShellEnergies ShellDynamics::energies(const ShellState& state) const {
  ShellSystem::Sums sums;
  system_->energy(elements_, state, state.x, sums);
  ShellEnergies energies{.membrane = sums.membrane, .bending = sums.bending};
  for (int i = 0; i < vertices(); ++i) {
    energies.kinetic += mass_[i] / 2 * state.v.row(i).squaredNorm();
    energies.gravity -= mass_[i] * state.x.row(i).dot(sheet_->gravity);
  }
  std::vector<ContactPoint> contacts;
  for (const auto& term : contact_terms_) term->find({state.x, nullptr, state.time}, contacts);
  energies.contact = contact_energy(contacts, options_->contact_distance);
  std::vector<HandleMap::Target> targets;
  handles_.targets(*sheet_, state.time, targets);
  energies.hands = spring_energy(targets, state.x);
  return energies;
}

Eigen::MatrixX3d ShellDynamics::elastic_forces(const ShellState& state) const {
  ShellSystem::Sums sums;
  system_->gradient(elements_, state, state.x, sums);
  Eigen::MatrixX3d forces(vertices(), 3);
  for (int i = 0; i < vertices(); ++i) forces.row(i) = -sums.gradient.segment<3>(row(i));
  return forces;
}

Eigen::MatrixX3d ShellDynamics::elastic_forces(const ShellState& state,
                                               const std::vector<int>& triangles) const {
  Eigen::MatrixX3d forces = Eigen::MatrixX3d::Zero(vertices(), 3);
  ShellElements::Local local;
  for (const int f : triangles) {
    elements_.evaluate(f, state, state.x, ShellElements::Order::gradient, local);
    const auto nodes = elements_.nodes(f);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      forces.row(nodes[k]) -= local.gradient.segment<3>(static_cast<Eigen::Index>(3 * k));
  }
  return forces;
}

bool ShellDynamics::solve_linear(Eigen::VectorXd& change, Eigen::VectorXd& reaction) {
  const ShellState& state = *problem_.state;
  const double dt = problem_.dt;
  matrix_.set_zero();
  system_->hessian(elements_, state, state.x, dt * (dt + sheet_->material.damping), sums_, matrix_);
  matrix_.multiply(problem_.velocity, right_);
  right_ = dt * (problem_.loads - sums_.gradient) - right_;
  for (int i = 0; i < vertices(); ++i) {
    matrix_.add_to_diagonal(position_[i], mass_[i]);
  }
  add_linear_contacts();
  add_linear_springs();
  change = right_;
  if (!solve_held(problem_.prescribed, change)) return false;
  reaction = -right_;
  multiply_taken(taken_, change, reaction);
  reaction /= dt;
  return true;
}

/// Contacts as linear springs that end at the contact distance, friction as a viscous force with
/// the coefficient that the expected slip has.
void ShellDynamics::add_linear_contacts() {
  const double dt = problem_.dt;
  const auto add = [&](const ContactPoint& point, const Eigen::Matrix3d& block,
                       const Eigen::Vector3d& impulse) {
    add_contact_block(point, block);
    add_contact_vector(point, impulse, right_);
  };
  const auto speed = [&](const ContactPoint& point) {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
      v += point.weight[k] * problem_.velocity.segment<3>(row(point.vertex[k]));
    }
    return v;
  };
  for (const ContactPoint& point : problem_.contacts) {
    const Eigen::Vector3d& n = point.normal;
    const double push = options_->contact_distance - point.gap - dt * n.dot(speed(point));
    add(point, dt * dt * point.stiffness * n * n.transpose(), dt * point.stiffness * push * n);
  }
  for (const FrictionPoint& friction : problem_.frictions) {
    const ContactPoint& point = friction.contact;
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - point.normal * point.normal.transpose();
    const Eigen::Vector3d slip = across * (speed(point) - point.surface_velocity);
    const double viscosity = friction.limit / std::hypot(friction.slip, options_->creep_speed);
    add(point, dt * viscosity * across, -dt * viscosity * slip);
  }
}

void ShellDynamics::add_linear_springs() {
  const double dt = problem_.dt;
  for (const HandleMap::Target& t : problem_.springs) {
    const Eigen::Vector3d x = problem_.state->x.row(t.vertex);
    const Eigen::Vector3d stretch = t.place - x - dt * problem_.velocity.segment<3>(row(t.vertex));
    right_.segment<3>(row(t.vertex)) += dt * *t.stiffness * stretch;
    matrix_.add_to_diagonal(position_[t.vertex], dt * dt * *t.stiffness);
  }
}

bool ShellDynamics::solve_held(const Eigen::VectorXd& prescribed, Eigen::VectorXd& solution) {
  matrix_.take_out(problem_.held, taken_);
  scratch_.setZero(solution.size());
  multiply_taken(taken_, prescribed, scratch_);
  solution -= scratch_;
  for (const HandleMap::Target& target : problem_.targets) {
    solution.segment<3>(row(target.vertex)) = prescribed.segment<3>(row(target.vertex));
  }
  if (!cholesky_->factorise(matrix_)) return false;
  cholesky_->solve(solution);
  return solution.allFinite();
}

namespace {

/// Part of the decrease that the slope promises which a step must keep (Armijo).
constexpr double kLeastDecrease = 1e-4;
constexpr int kMostBacktracks = 20;
/// Iterations left to the projected Hessian alone, which is the better guide where it converges.
constexpr int kPatience = 6;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

bool ShellDynamics::solve_newton(Step& result, Eigen::VectorXd& reaction) {
  prepare_newton(result);
  SecantPairs secants;
  Eigen::VectorXd gradient, direction, before, step;
  Eigen::MatrixX3d trial;
  double value = potential(result.x);
  for (int solves = 0;; ++solves) {
    if (!std::isfinite(value)) return false;
    const double scale = potential_gradient(result.x, gradient);
    reaction = gradient / (problem_.dt * problem_.dt);
    for (const HandleMap::Target& t : problem_.targets)
      gradient.segment<3>(row(t.vertex)).setZero();
    if (solves >= kPatience) secants.remember(step, gradient - before);
    const double residual = gradient.norm();
    result.residual = scale > 0 ? residual / scale : 0;
    // What rounding of the positions alone leaves of the forces.
    const double floor = 4 * kEpsilon * result.x.cwiseAbs().maxCoeff() * matrix_.diagonal_norm();
    if (residual <= std::max(options_->newton_tolerance * scale, floor)) break;
    if (solves == options_->newton_iterations) return false;
    matrix_.take_out(problem_.held, taken_);
    if (!cholesky_->factorise(matrix_)) return false;
    ++result.solves;
    double length = 0;
    for (int attempt = 0; attempt < 2 && length == 0; ++attempt) {
      if (!find_direction(gradient, secants, direction)) return false;
      length = search_line(direction, gradient.dot(direction), result.x, value, trial);
      // Secants across a change of contact can mislead: once more without them.
      if (length == 0) secants.clear();
    }
    if (length == 0) return false;
    step = length * direction;
    before = gradient;
  }
  result.v = (result.x - problem_.state->x) / problem_.dt;
  return true;
}

/// The step to the minimum of the quadratic model; that of the projected Hessian alone where the
/// secants do not lead down.
bool ShellDynamics::find_direction(const Eigen::VectorXd& gradient, SecantPairs& secants,
                                   Eigen::VectorXd& direction) {
  const auto solve = [&](Eigen::VectorXd& b) {
    cholesky_->solve(b);
    return b.allFinite();
  };
  direction = -gradient;
  if (!secants.apply(direction, solve)) return false;
  if (gradient.dot(direction) < 0) return true;
  secants.clear();
  direction = -gradient;
  return solve(direction);
}

/// What the potential of the step is made of.
void ShellDynamics::prepare_potential() {
  const ShellState& state = *problem_.state;
  const double dt = problem_.dt;
  gather(state.x, problem_.start);
  problem_.inertial = problem_.start + dt * problem_.velocity;
  for (int i = 0; i < vertices(); ++i) {
    problem_.inertial.segment<3>(row(i)) += dt * dt / mass_[i] * problem_.loads.segment<3>(row(i));
  }
  if (sheet_->material.damping > 0) {
    damping_ = matrix_;
    damping_.set_zero();
    system_->hessian(elements_, state, state.x, dt * sheet_->material.damping, sums_, damping_);
  }
}

/// The sheet where it was, its handles moved.
Eigen::MatrixX3d ShellDynamics::held_still() const {
  Eigen::MatrixX3d still = problem_.state->x;
  for (const HandleMap::Target& t : problem_.targets) still.row(t.vertex) = t.place.transpose();
  return still;
}

/// Starts where the potential is lower: the linear step's result, or the sheet at rest with its
/// handles moved.
void ShellDynamics::prepare_newton(Step& result) {
  prepare_potential();
  const Eigen::MatrixX3d still = held_still();
  const bool usable = result.x.rows() == still.rows() && result.x.allFinite();
  if (!usable || !(potential(result.x) <= potential(still))) result.x = still;
}

/// Moves `x` along the direction, as far as the potential falls. @return the part of it; 0: none
double ShellDynamics::search_line(const Eigen::VectorXd& direction, double slope,
                                  Eigen::MatrixX3d& x, double& value, Eigen::MatrixX3d& trial) {
  const double noise = 64 * kEpsilon * std::abs(value);
  double length = 1;
  for (int k = 0; k < kMostBacktracks; ++k, length /= 2) {
    trial = x;
    for (int i = 0; i < vertices(); ++i) {
      trial.row(i) += length * direction.segment<3>(row(i)).transpose();
    }
    const double tried = potential(trial);
    if (!(tried <= value + kLeastDecrease * length * slope + noise)) continue;
    x.swap(trial);
    value = tried;
    return length;
  }
  return 0;
}

double ShellDynamics::potential(const Eigen::MatrixX3d& x) {
  const double dt = problem_.dt;
  system_->energy(elements_, *problem_.state, x, sums_);
  double energy = sums_.membrane + sums_.bending;
  touching_.clear();
  for (const auto& term : contact_terms_) term->find({x, nullptr, problem_.time}, touching_);
  energy += contact_energy(touching_, options_->contact_distance);
  for (const FrictionPoint& friction : problem_.frictions) {
    energy += friction.limit * std::hypot(slip_of(friction, x).norm(), options_->creep_speed * dt);
  }
  energy += spring_energy(problem_.springs, x);
  double value = dt * dt * energy;
  for (int i = 0; i < vertices(); ++i) {
    value +=
        mass_[i] / 2 * (x.row(i).transpose() - problem_.inertial.segment<3>(row(i))).squaredNorm();
  }
  if (sheet_->material.damping > 0) {
    gather(x, right_);
    right_ -= problem_.start;
    damping_.multiply(right_, scratch_);
    value += right_.dot(scratch_) / 2;
  }
  return value;
}

/// Gradient of the potential, and its Hessian in the matrix. @return the largest of its terms
double ShellDynamics::potential_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const double dt = problem_.dt;
  matrix_.set_zero();
  system_->hessian(elements_, *problem_.state, x, dt * dt, sums_, matrix_);
  gradient = dt * dt * sums_.gradient;
  const double elastic = gradient.norm();
  gather(x, right_);
  if (sheet_->material.damping > 0) {
    scratch_ = right_ - problem_.start;
    Eigen::VectorXd force;
    damping_.multiply(scratch_, force);
    gradient += force;
    matrix_.add(damping_);
  }
  right_ -= problem_.inertial;
  for (int i = 0; i < vertices(); ++i) {
    right_.segment<3>(row(i)) *= mass_[i];
    matrix_.add_to_diagonal(position_[i], mass_[i]);
  }
  gradient += right_;
  const double inertia = right_.norm();
  add_contact_gradient(x, gradient);
  add_friction_gradient(x, gradient);
  add_spring_gradient(x, gradient);
  return std::max({elastic, inertia, dt * dt * problem_.loads.norm()});
}

void ShellDynamics::add_contact_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const double dt = problem_.dt;
  touching_.clear();
  for (const auto& term : contact_terms_) term->find({x, nullptr, problem_.time}, touching_);
  for (const ContactPoint& point : touching_) {
    const double push = point.stiffness * (options_->contact_distance - point.gap);
    add_contact_vector(point, -dt * dt * push * point.normal, gradient);
    add_contact_block(point, dt * dt * point.stiffness * point.normal * point.normal.transpose());
  }
}

void ShellDynamics::add_friction_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const double dt = problem_.dt;
  for (const FrictionPoint& friction : problem_.frictions) {
    const Eigen::Vector3d& n = friction.contact.normal;
    const Eigen::Vector3d slip = slip_of(friction, x);
    const double length = std::hypot(slip.norm(), options_->creep_speed * dt);
    const double factor = dt * dt * friction.limit / length;
    add_contact_vector(friction.contact, factor * slip, gradient);
    add_contact_block(friction.contact, factor * (Eigen::Matrix3d::Identity() - n * n.transpose() -
                                                  slip * slip.transpose() / (length * length)));
  }
}

void ShellDynamics::add_spring_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  for (const HandleMap::Target& t : problem_.springs) {
    const double stiffness = problem_.dt * problem_.dt * *t.stiffness;
    gradient.segment<3>(row(t.vertex)) += stiffness * (x.row(t.vertex).transpose() - t.place);
    matrix_.add_to_diagonal(position_[t.vertex], stiffness);
  }
}

/// How far a point has slid along the surface it touches, from the start of the step (m).
Eigen::Vector3d ShellDynamics::slip_of(const FrictionPoint& friction,
                                       const Eigen::MatrixX3d& x) const {
  const ContactPoint& point = friction.contact;
  Eigen::Vector3d moved = -problem_.dt * point.surface_velocity;
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
    const int i = point.vertex[k];
    moved += point.weight[k] * (x.row(i) - problem_.state->x.row(i)).transpose();
  }
  return moved - point.normal * point.normal.dot(moved);
}

}  // namespace geoprior::paper
