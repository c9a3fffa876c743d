#include "solvers/paper/meshing/hybrid_mesher.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "baselines/paper/dense.h"
#include "core/connectivity.h"
#include "core/limits.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/handle_map.h"
#include "models/paper/sheet/pattern_locator.h"
#include "models/paper/tear/frame.h"
#include "solvers/paper/hybrid_frame.h"
#include "solvers/paper/meshing/refinement.h"
#include "solvers/paper/meshing/ruling_field.h"
#include "solvers/paper/sheet/compression.h"
#include "solvers/paper/sheet/invariants.h"
#include "solvers/paper/sheet/pieces.h"
#include "solvers/paper/sheet/structure_bytes.h"
#include "solvers/paper/sheet/tracking.h"
#include "solvers/paper/shell/plastic_apex.h"
#include "solvers/paper/shell/settled_energy.h"
#include "solvers/paper/tear/torn_structure.h"

namespace geoprior::paper {
namespace {

/// Closest that rulings come to each other's ends, in seeding distances.
constexpr double kGap = 0.2;
/// Shortest edge that dividing a ruling makes, in seeding distances.
constexpr double kLeastPart = 2;
/// Smallest angle between two rulings with a common end.
constexpr double kLeastAngleDegrees = 6;

/// Iterations of the projection after remeshing, over those of other frames.
constexpr int kRemeshedIterations = 2;
/// Strain that a last resort leaves is given as much time as it takes, within reason.
constexpr double kUnacceptableStrain = 1e-2;
constexpr int kPatientIterations = 30;
/// Most rulings side by side over the pattern.
constexpr double kMostRulings = 1e6;
/// Least frames between two looks at whether a singular point is still needed.
constexpr int kReview = 5;
/// Strain, in that which the last look could not mend, at which the next is not waited for.
constexpr double kWorse = 2;
/// Longest way of a sheet of which a change of the mesh may move it a part, in seeding distances.
constexpr double kLongestWay = 0.625;
/// Shortest edge that halving makes, over that of a lattice halved as often: lattices are cut by
/// rulings.
constexpr double kShortest = 0.8;
/// How far a new singular point is moved out of the sheet, in seeding distances.
constexpr double kDent = 0.05;

/// Side of the sheet (+1: that of the normal) to which the neighbours of a vertex lie.
double hollow_side(const ShellState& state, const EdgeConnectivity& edges, int vertex,
                   const Eigen::RowVector3d& normal) {
  double sum = 0;
  for (const auto& [a, b] : edges.edges()) {
    if (a != vertex && b != vertex) continue;
    const int other = a == vertex ? b : a;
    const Eigen::RowVector3d d = state.x.row(other) - state.x.row(vertex);
    // Height over distance squared: half the curvature in that direction.
    sum += d.dot(normal) / d.squaredNorm();
  }
  return sum < 0 ? -1 : 1;
}

/// Moves new vertices from the triangles of the sheet before to the smooth surface through its
/// vertices: over a triangle that surface rises by as much as its curvature makes of the triangle's
/// size. Without it every new mesh would cut the folds of the old one off.
void round_off(const ShellState& before, const BendingField& field, const std::vector<bool>& held,
               ShellState& state) {
  const PatternLocator locator(before.mesh);
  for (int i = 0; i < state.mesh.vertex_count(); ++i) {
    if (held[i]) continue;
    const Eigen::Vector2d p = state.mesh.pattern.row(i);
    const PatternLocator::Place at = locator.locate(p);
    const Eigen::RowVector3i t = before.mesh.triangles.row(at.triangle);
    const Eigen::Matrix2d S = field.at(p);
    double rise = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d to = before.mesh.pattern.row(t[k]).transpose() - p;
      rise += at.weights[k] * to.dot(S * to) / 2;
    }
    const Eigen::RowVector3d a = before.x.row(t[1]) - before.x.row(t[0]);
    const Eigen::RowVector3d b = before.x.row(t[2]) - before.x.row(t[0]);
    state.x.row(i) -= rise * a.cross(b).normalized();
  }
}

std::vector<bool> held_vertices(const Sheet& sheet, const ShellState& state, std::uint64_t seed) {
  std::vector<HandleMap::Target> targets;
  HandleMap(sheet, state, seed).targets(sheet, state.time, targets);
  std::vector<bool> held(state.mesh.vertex_count(), false);
  for (const auto& target : targets) held[target.vertex] = true;
  return held;
}

}  // namespace

RulingEditor HybridMesher::editor() {
  return {pattern_,
          anchors_,
          {kGap * options_.seeding_distance, kLeastAngleDegrees * std::numbers::pi / 180},
          structure_};
}

void HybridMesher::take_scene(const Sheet& sheet) {
  if (!sheet.toughness.tears()) {
    tearing_.reset();
  } else if (!tearing_) {
    tearing_.emplace(sheet, options_.tearing);
  }
  pattern_ = tearing_ ? tearing_->tears().torn() : sheet.pattern;
  require_lattice(pattern_, options_.flat_size);
  require_count(width(pattern_) / options_.seeding_distance, "parallel rulings", kMostRulings,
                "scene.pattern");
  anchors_ = handle_points(sheet, options_.flat_size);
}

void HybridMesher::remesh() {
  mesh_ = mesh_structure(
      structure_, pattern_, anchors_,
      {options_.flat_size, options_.ruling_parts, kLeastPart * options_.seeding_distance});
  derive_pieces(structure_, pattern_, mesh_);
  assert(broken_invariants(structure_, pattern_, mesh_.mesh).empty());
  projector_.reset();
  meshed_ = true;
  ++meshes_made_;
}

ShellState HybridMesher::start(const Sheet& sheet, RunContext& context) {
  structure_ = {};
  draws_ = 0;
  left_strain_ = 0;
  rejected_ = 0;
  unborn_ = 0;
  frames_ = 0;
  looks_ = LookTimer(options_.look_frames);
  settle_steps_ = 0;
  tearing_.reset();
  take_scene(sheet);
  if (tearing_) {
    RulingEditor pen = editor();
    follow_tears(tearing_->tears(), 0, options_, pen);
  }
  remesh();
  return resting_state(sheet, mesh_.mesh, context.seed());
}

void HybridMesher::stepped(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
                           RunContext& context) {
  if (!meshed_) {
    take_scene(sheet);
    remesh();
  }
  if (!tearing_) return;
  const Phase phase(context, "tear");
  std::optional<Snapshot> before;
  const auto follow = [&](ShellState& torn) {
    before = snapshot(torn);
    tear_mesh(torn);
  };
  const auto take_back = [&] {
    ShellState whole;
    restore(*before, whole);
    pattern_ = tearing_->tears().torn();
  };
  tearing_->grow([&] { return tear_candidates(sheet, tearing_->tears(), structure_); },
                 {follow, take_back}, stepper, state);
}

/// Makes the mesh of the tears as they are now. Nothing else of it changes but what they touch. It
/// is not projected: the sheet relaxes next, in which strain goes at once, while what bending the
/// projection makes of it takes long to go.
void HybridMesher::tear_mesh(ShellState& state) {
  pattern_ = tearing_->tears().torn();
  looks_.wake();
  guide_.reset();
  RulingEditor pen = editor();
  follow_tears(tearing_->tears(), state.time, options_, pen);
  remesh();
  state = transfer_state(state, mesh_.mesh);
}

/// What happens in every frame: singular points yield, rulings age and are counted flat.
void HybridMesher::attend(const Sheet& sheet, const ShellStepper& stepper, ShellState& state) {
  curvature_ = stepper.shape_operators(state);
  if (options_.stepper.plasticity) {
    yield_at_apexes(sheet.material, options_.weakening_radius, mesh_.singular_vertices, curvature_,
                    state, structure_);
  }
  RulingEditor looker = editor();
  folds_ = fold_angles(state, mesh_);
  for (Ruling& ruling : structure_.rulings) ++ruling.age_frames;
  count_flat_frames(folds_, options_, looker);
}

/// Where the simulated sheet asks for rulings.
std::vector<DemandGroup> HybridMesher::analyse(const Sheet& sheet, ShellState& state,
                                               RunContext& context) {
  RulingEditor looker = editor();
  if (options_.tracking) {
    if (!guide_)
      guide_.emplace(sheet, pattern_, options_.guide_edge, options_.stepper, context.seed());
    field_.emplace(guide_->relaxed(state));
  }
  return group_demands(find_demands(sheet, state, curvature_, mesh_, looker, options_), state.mesh,
                       options_.group_angle_deg);
}

bool HybridMesher::track(RulingEditor& editor, PropagationReport& events) {
  const bool refined = refine_rulings(folds_, options_, editor);
  const bool followed = follow_bending(*field_, options_, editor, events.new_rulings, look_span_);
  return refined || followed;
}

/// Changes the rulings as the groups ask; the mesh still is that of the old ones.
PropagationReport HybridMesher::edit(const ShellState& state,
                                     const std::vector<DemandGroup>& groups, bool tracking,
                                     std::uint64_t seed) {
  PropagationReport total;
  RulingEditor pen = editor();
  if (tracking) total.changed = track(pen, total);
  // What rulings can serve that turn needs no singular point.
  if (!groups.empty() && !(total.changed && options_.energy_test))
    resolve(state, groups, seed, pen, total);
  if (tracking && retire_rulings(total.changed, options_, pen)) total.changed = true;
  return total;
}

void HybridMesher::resolve(const ShellState& state, const std::vector<DemandGroup>& groups,
                           std::uint64_t seed, RulingEditor& pen, PropagationReport& total) {
  const PatternLocator locator(state.mesh);
  std::vector<double> folds = folds_;
  for (const DemandGroup& group : groups) {
    if (options_.tracking && !group.bent_ground) continue;
    // Once rulings have gone, the folds belong to others.
    if (total.changed) folds.clear();
    const auto in_group = [&](const Eigen::Vector2d& p) {
      const int f = locator.locate(p).triangle;
      return std::find(group.triangles.begin(), group.triangles.end(), f) != group.triangles.end();
    };
    const PropagationReport report =
        resolve_group(group, in_group, folds, state.time, seed, draws_, options_, pen);
    total.new_rulings += report.new_rulings;
    total.new_singular_points += report.new_singular_points;
    total.changed |= report.changed;
    // The strongest group first: what one point releases, others no longer ask for.
    if (total.new_singular_points > 0) break;
  }
}

HybridMesher::Snapshot HybridMesher::snapshot(const ShellState& state) const {
  return {structure_, mesh_, state, events_, projection_};
}

void HybridMesher::restore(const Snapshot& before, ShellState& state) {
  structure_ = before.structure;
  mesh_ = before.mesh;
  state = before.state;
  events_ = before.events;
  projection_ = before.projection;
  projector_.reset();
}

bool HybridMesher::adapt(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
                         RunContext& context) {
  if (!meshed_) {
    take_scene(sheet);
    remesh();
  }
  meshes_made_ = 0;
  settle_steps_ = 0;
  strains_unchanged_ = false;
  weighed_ = false;
  ++frames_;
  looks_.pass_frame();
  std::vector<DemandGroup> groups;
  const bool looks = looks_.is_due();
  {
    const Phase phase(context, "analyse");
    attend(sheet, stepper, state);
    if (looks) groups = analyse(sheet, state, context);
  }
  before_ = snapshot(state);
  const Snapshot& before = *before_;
  if (!looks) {
    keep(sheet, 1, state, context);
    const bool worse = projection_.strain_after > kWorse * left_strain_;
    if (!strains() || !(looks_.may_be_early() || worse)) return false;
    strains_unchanged_ = true;
    restore(before, state);
    const Phase phase(context, "analyse");
    groups = analyse(sheet, state, context);
  }
  look_span_ = std::min(looks_.since(), options_.look_frames);
  const bool reviews =
      options_.energy_test && frames_ / kReview != (frames_ - looks_.since()) / kReview;
  looks_.looked();
  left_strain_ = 0;
  return look(sheet, groups, reviews, before, state, context);
}

/// Changes the structure as the groups ask, where the sheet can follow.
bool HybridMesher::look(const Sheet& sheet, const std::vector<DemandGroup>& groups, bool reviews,
                        const Snapshot& before, ShellState& state, RunContext& context) {
  if (try_change(sheet, groups, options_.tracking, kRemeshedIterations, before, state, context)) {
    if (!options_.energy_test) return true;
    if (events_.new_singular_points > 0) {
      weigh_births(sheet, before, state, context);
    } else if (reviews) {
      review_points(sheet, state, context);
    }
    return true;
  }
  // Wait for the next frame, unless this one is strained without a change.
  const Snapshot tried = snapshot(state);
  const bool changed = events_.changed;
  if (changed) restore(before, state);
  keep(sheet, 1, state, context);
  if (!strains()) return reviews && review_points(sheet, state, context);
  return last_resort(sheet, groups, before, changed ? &tried : nullptr, state, context);
}

bool HybridMesher::take_back(const Sheet& sheet, ShellState& state, RunContext& context) {
  if (!before_) return false;
  restore(*before_, state);
  keep(sheet, 1, state, context);
  give_up();
  ++rejected_;
  return true;
}

/// Takes new singular points back unless the sheet, once settled, has less energy with them than
/// with rulings alone.
void HybridMesher::weigh_births(const Sheet& sheet, const Snapshot& before, ShellState& state,
                                RunContext& context) {
  const Phase phase(context, "weigh");
  weighed_ = true;
  const auto energy = [&] {
    return settled_energy(sheet, options_.stepper, context.seed(), state);
  };
  const double with_points = energy();
  const Snapshot born = snapshot(state);
  restore(before, state);
  const bool follows =
      try_change(sheet, {}, options_.tracking, kRemeshedIterations, before, state, context);
  if (!follows && events_.changed) {
    restore(born, state);
    return;
  }
  if (!follows) keep(sheet, 1, state, context);
  if (projection_.strain_after <= options_.accepted_strain && energy() <= with_points) {
    ++unborn_;
    events_.changed = true;
    return;
  }
  restore(born, state);
}

/// Takes away the oldest singular point about which the paper has not yielded, if the sheet, once
/// settled, has no more energy without it.
bool HybridMesher::review_points(const Sheet& sheet, ShellState& state, RunContext& context) {
  const auto& points = structure_.singular_points;
  const auto unyielded = std::find_if(points.begin(), points.end(), [](const SingularPoint& p) {
    return !p.tear && p.weakening == 0;
  });
  if (unyielded == points.end()) return false;
  const Phase phase(context, "weigh");
  const Snapshot before = snapshot(state);
  const double with_point = settled_energy(sheet, options_.stepper, context.seed(), state);
  RulingEditor pen = editor();
  pen.remove_point(static_cast<int>(unyielded - points.begin()));
  int new_rulings = 0;
  if (field_) follow_bending(*field_, options_, pen, new_rulings, look_span_);
  remesh();
  carry(sheet, state, structure_.singular_points.size(), context);
  if (options_.projection) project(sheet, kRemeshedIterations, state, context);
  if (projection_.strain_after <= options_.accepted_strain &&
      settled_energy(sheet, options_.stepper, context.seed(), state) <= with_point) {
    weighed_ = true;
    events_.changed = true;
    return true;
  }
  restore(before, state);
  return false;
}

/// Changes the structure as the groups ask. False when there is nothing to change, or when the
/// sheet cannot follow; the change is then still there.
bool HybridMesher::try_change(const Sheet& sheet, const std::vector<DemandGroup>& groups,
                              bool tracking, int effort, const Snapshot& before, ShellState& state,
                              RunContext& context) {
  {
    const Phase phase(context, "propagate");
    events_ = edit(state, groups, tracking, context.seed());
  }
  if (!events_.changed) return false;
  {
    const Phase phase(context, "remesh");
    remesh();
    carry(sheet, state, before.structure.singular_points.size(), context);
  }
  if (!options_.projection) return true;
  project(sheet, effort, state, context);
  if (projection_.strain_after <= options_.accepted_strain) return true;
  ++rejected_;
  return false;
}

/// Whether the projection has left more strain than is accepted.
bool HybridMesher::strains() const {
  return options_.projection && projection_.strain_after > options_.accepted_strain;
}

/// Goes on with the structure as it is.
void HybridMesher::keep(const Sheet& sheet, int effort, ShellState& state, RunContext& context) {
  events_ = {};
  if (options_.projection) project(sheet, effort, state, context);
}

/// Makes the mesh finer where the sheet strains whatever its rulings are. What strain the new mesh
/// has at first is not asked: the next steps bend it at its new edges. False, and everything as it
/// was, where it is as fine as it may be.
bool HybridMesher::refine(const Sheet& sheet, const Snapshot& before, ShellState& state,
                          RunContext& context) {
  if (options_.refinements == 0) return false;
  const double shortest = kShortest * std::ldexp(options_.flat_size, -options_.refinements);
  const std::vector<FinePlace> places =
      strained_places(state, options_.accepted_strain, shortest, structure_.fine_places);
  if (places.empty()) return false;
  restore(before, state);
  structure_.fine_places.insert(structure_.fine_places.end(), places.begin(), places.end());
  remesh();
  carry(sheet, state, structure_.singular_points.size(), context);
  events_ = {};
  events_.changed = true;
  project(sheet, options_.last_iterations, state, context);
  if (strains()) give_up();
  return true;
}

/// Neither the change nor the structure before it can follow the handles: a finer mesh, then other
/// draws of singular points, with patience. The least strained of all stays.
bool HybridMesher::last_resort(const Sheet& sheet, const std::vector<DemandGroup>& groups,
                               const Snapshot& before, const Snapshot* tried, ShellState& state,
                               RunContext& context) {
  strains_unchanged_ = true;
  keep(sheet, options_.last_iterations, state, context);
  if (!strains()) return false;
  if (refine(sheet, before, state, context)) return true;
  if (tried == nullptr) {
    give_up();
    return false;
  }
  Snapshot best = snapshot(state);
  const auto improve = [&](const Snapshot& other) {
    if (other.projection.strain_after < best.projection.strain_after) best = other;
  };
  improve(*tried);
  const int retry_iterations = std::max(1, options_.last_iterations / 2);
  for (int attempt = 1; attempt < options_.attempts; ++attempt) {
    restore(before, state);
    if (try_change(sheet, groups, false, retry_iterations, before, state, context)) return true;
    if (!events_.changed) break;
    improve(snapshot(state));
  }
  restore(best, state);
  if (projection_.strain_after > kUnacceptableStrain) {
    project(sheet, kPatientIterations, state, context);
  }
  give_up();
  return events_.changed;
}

/// The look was in vain: what strain it has left is not looked at again soon.
void HybridMesher::give_up() {
  looks_.in_vain();
  left_strain_ = projection_.strain_after;
}

/// Takes the state to the new mesh. A new singular point is moved a little towards its neighbours,
/// the hollow side: a sheet compressed along its rulings dents inwards, and edges in one plane
/// could not decide.
void HybridMesher::carry(const Sheet& sheet, ShellState& state, std::size_t old_points,
                         RunContext& context) const {
  const ShellState before = state;
  state = transfer_state(state, mesh_.mesh);
  if (field_) {
    round_off(before, *field_, held_vertices(sheet, state, context.seed()), state);
  }
  if (old_points >= mesh_.singular_vertices.size()) return;
  const EdgeConnectivity edges(state.mesh.triangles);
  const VertexCorners corners(state.mesh.triangles, state.mesh.vertex_count());
  for (std::size_t s = old_points; s < mesh_.singular_vertices.size(); ++s) {
    const int apex = mesh_.singular_vertices[s];
    const Eigen::RowVector3d normal = vertex_normal(state, corners, apex);
    state.x.row(apex) +=
        hollow_side(state, edges, apex, normal) * kDent * options_.seeding_distance * normal;
  }
}

/// @param effort  iterations, in those of a usual frame
void HybridMesher::project(const Sheet& sheet, int effort, ShellState& state, RunContext& context) {
  const Phase phase(context, "project");
  std::vector<bool> held = held_vertices(sheet, state, context.seed());
  if (!projector_ || projector_->held() != held) projector_.emplace(state.mesh, held);
  projection_ = projector_->project(
      state, {effort * options_.projection_iterations, options_.projection_strain});
}

/// Whether a change of the mesh moves the sheet farther than the part `jump_share` of the way that
/// its fastest vertex goes between two looks: such a change is worse than none, whatever it mends.
/// A sheet at rest keeps its mesh. Not asked of singular points that come or go, which are weighed
/// by energy, and of a sheet that strains without the change.
bool HybridMesher::moves_too_far(const Sheet& sheet, const ShellState& state) const {
  if (!before_ || strains_unchanged_ || weighed_ || events_.new_singular_points > 0) return false;
  const ShellState carried = transfer_state(before_->state, state.mesh);
  const double moved = (state.x - carried.x).rowwise().norm().maxCoeff();
  const double speed = before_->state.v.rowwise().norm().maxCoeff();
  const double way = speed * look_span_ * sheet.frame_interval;
  const double longest = kLongestWay * options_.seeding_distance;
  return moved > options_.jump_share * std::min(way, longest);
}

bool HybridMesher::strains_without_change(const Sheet& sheet, ShellState state,
                                          RunContext& context) {
  const Snapshot changed = snapshot(state);
  restore(*before_, state);
  keep(sheet, 1, state, context);
  const bool strained = strains();
  restore(changed, state);
  return strained;
}

/// The projection puts the new mesh where it is isometric, not where it is at rest.
bool HybridMesher::settle(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
                          RunContext& context) {
  {
    const Phase phase(context, "settle");
    settle_steps_ = paper::settle(sheet, options_.settle, stepper, state);
  }
  return !moves_too_far(sheet, state) || strains_without_change(sheet, state, context);
}

void HybridMesher::annotate(const ShellState& state, Frame& frame) const {
  add_structure(structure_, mesh_, state, frame);
  if (tearing_) add_tears(*tearing_, state, frame);
  frame.diagnostics["new_rulings"] = events_.new_rulings;
  frame.diagnostics["new_singular_points"] = events_.new_singular_points;
  frame.diagnostics["rejected_changes"] = rejected_;
  frame.diagnostics["unborn_points"] = unborn_;
  frame.diagnostics["remeshed"] = events_.changed ? 1 : 0;
  frame.diagnostics["meshes_made"] = meshes_made_;
  frame.diagnostics["projection_iterations"] = projection_.iterations;
  frame.diagnostics["strain_before"] = projection_.strain_before;
  frame.diagnostics["strain_after"] = projection_.strain_after;
  frame.diagnostics["settle_steps"] = settle_steps_;
}

void HybridMesher::save(StateWriter& out) const {
  write_structure(structure_, out);
  if (tearing_) tearing_->save(out);
  out.number(draws_);
  out.number(left_strain_);
  out.number(rejected_);
  out.number(unborn_);
  out.number(frames_);
  looks_.save(out);
}

void HybridMesher::load(const Sheet& sheet, StateReader& in) {
  structure_ = read_structure(in);
  take_scene(sheet);
  if (tearing_) tearing_->load(in);
  draws_ = in.number<std::uint64_t>();
  left_strain_ = in.number<double>();
  rejected_ = in.number<int>();
  unborn_ = in.number<int>();
  frames_ = in.number<int>();
  looks_.load(in);
  meshed_ = false;
}

}  // namespace geoprior::paper
