#include "baselines/paper/shell_dynamics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

/// A triangle that lost this much of its area in one step has collapsed.
constexpr double kLeastAreaRatio = 1e-3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Eigen::Vector3d normal(const Eigen::MatrixX3d& x, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = x.row(t[0]);
  const Eigen::Vector3d b = x.row(t[1]);
  const Eigen::Vector3d c = x.row(t[2]);
  return (b - a).cross(c - a);
}

NodeGraph element_graph(const ShellElements& elements, int vertices) {
  std::vector<int> offset(1, 0);
  std::vector<int> members;
  offset.reserve(at(elements.size()) + 1);
  members.reserve(at(elements.size()) * 6);
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
    const double area = (b.x() * c.y() - b.y() * c.x()) / 2;
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
      elements_(state.mesh, sheet.material, options.bending, options.hinge_calibration),
      handles_(sheet, state.mesh, seed),
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
  p.held.assign(at(vertices()), 0);
  p.prescribed.setZero(p.velocity.size());
  for (const HandleMap::Target& target : p.targets) {
    p.held[at(position_[at(target.vertex)])] = 1;
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
  for (std::size_t k = 0; k < at(point.count); ++k) {
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
  for (std::size_t a = 0; a < at(point.count); ++a) {
    for (std::size_t b = a; b < at(point.count); ++b) {
      const auto place =
          matrix_.place(position_[at(point.vertex[a])], position_[at(point.vertex[b])]);
      matrix_.add(place, point.weight[a] * point.weight[b] * block);
    }
  }
}

void ShellDynamics::add_contact_vector(const ContactPoint& point, const Eigen::Vector3d& vector,
                                       Eigen::VectorXd& sum) const {
  for (std::size_t k = 0; k < at(point.count); ++k) {
    sum.segment<3>(row(point.vertex[k])) += point.weight[k] * vector;
  }
}

void ShellDynamics::place(const Eigen::VectorXd& change, Step& result) const {
  const ShellState& state = *problem_.state;
  for (int i = 0; i < vertices(); ++i) {
    result.v.row(i) = state.v.row(i) + change.segment<3>(row(i)).transpose();
  }
  result.x = state.x + problem_.dt * result.v;
  // Not by way of the velocity: held places do not drift.
  for (const HandleMap::Target& t : problem_.targets) result.x.row(t.vertex) = t.place.transpose();
}

void ShellDynamics::report_handles(const Eigen::VectorXd& reaction, Step& result) const {
  result.handle_force.assign(sheet_->handles.size(), Eigen::Vector3d::Zero());
  result.handle_work = 0;
  for (const HandleMap::Target& t : problem_.targets) {
    const Eigen::Vector3d force = reaction.segment<3>(row(t.vertex));
    const Eigen::Vector3d from = problem_.state->x.row(t.vertex);
    result.handle_force[at(t.handle)] += force;
    result.handle_work += force.dot(t.place - from);
  }
  for (std::size_t h = 0; h < sheet_->handles.size(); ++h) {
    const Handle& handle = sheet_->handles[h];
    if (handle.force && handle.is_active(problem_.time)) result.handle_force[h] = *handle.force;
  }
}

void ShellDynamics::step(const ShellState& state, double dt, Step& result) {
  pose(state, dt);
  result.good = false;
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
  if (options_->integration == Integration::newton) {
    if (!solve_newton(result, reaction)) return;
  } else if (!solved) {
    return;
  }
  if (!sound(state.x, result.x)) return;
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
  return energies;
}

Eigen::MatrixX3d ShellDynamics::elastic_forces(const ShellState& state) const {
  ShellSystem::Sums sums;
  system_->gradient(elements_, state, state.x, sums);
  Eigen::MatrixX3d forces(vertices(), 3);
  for (int i = 0; i < vertices(); ++i) forces.row(i) = -sums.gradient.segment<3>(row(i));
  return forces;
}

}  // namespace geoprior
