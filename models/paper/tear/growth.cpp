#include "models/paper/tear/growth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/mesh.h"
#include "models/paper/shell/relaxation.h"
#include "models/paper/tear/hoop_tension.h"
#include "models/paper/tear/lips.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Points of the pattern nearer than this share of its width are one.
constexpr double kSame = 1e-9;
/// Corners that turn less are no notches: outlines of curves are full of them.
constexpr double kLeastNotch = 20 * kDegree;
/// A pull that asks a tear to turn by more goes back on it, and tears nothing; directions of two
/// steps that differ by less lie on a curve (rad).
constexpr double kBack = 120 * kDegree, kSmooth = 20 * kDegree;
/// Of the way to the next tip or hand, that a piece about a candidate covers.
constexpr double kClear = 0.8;
/// By so much the general search takes the tension at tips for larger than it is: tears go on
/// rather than begin (Pfaff et al. 2014).
constexpr double kTip = 2;
/// Of the null, from the bisector (rad).
constexpr double kAskew = 45 * kDegree;
/// Directions tried where the toughness depends on them.
constexpr int kDirections = 720;

// Ours, chosen: what a tear does between two time steps.
/// Steps of all tears after one time step.
constexpr int kMostSteps = 10;
/// Most time steps that are not looked at after others in vain: of a sheet that swings most were,
/// and rested for nothing. A hand goes a fraction of a millimetre in them.
constexpr int kMostWait = 3;
/// For no longer than this (s): three steps of 5 ms. With longer ones a pull could come and go.
constexpr double kLongestWait = 0.0155;
/// Of the implicit steps from rest that a sheet relaxes in (s).
constexpr double kRelaxTime = 1e-3;
/// Of them, after a tear has grown; and most of them, while the sheet has more energy than before.
constexpr int kRelaxSteps = 2, kMostRelaxSteps = 20;
/// Farthest that a tear's path lies from the edges of its lips (m).
constexpr double kPathTolerance = 1e-4;
/// A tear that comes so near to a border or a tear ends there (m).
constexpr double kMargin = 1e-3;

/// The vertex at a place, unless there is none or the sheet is open there.
std::optional<int> vertex_at(const ShellMesh& mesh, const Vector2d& p, double tolerance) {
  std::optional<int> found;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if ((mesh.pattern.row(v).transpose() - p).norm() > tolerance) continue;
    if (found) return std::nullopt;
    found = v;
  }
  return found;
}

/// Every vertex that lies on no tear; all are looked at alike.
void add_vertices(const ShellMesh& mesh, const Tears& tears, std::vector<TearCandidate>& places) {
  const double same = kSame * width(tears.torn());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector2d p = mesh.pattern.row(v);
    const bool known = std::any_of(places.begin(), places.end(), [&](const TearCandidate& c) {
      return (c.place - p).norm() <= same;
    });
    if (!known && distance_to_cuts(tears.torn(), p) > same) places.push_back({p, std::nullopt});
  }
  for (TearCandidate& place : places) place.on_flaw = true;
}

bool is_on(const std::vector<Vector2d>& loop, const Vector2d& p, const Tears& tears) {
  Pattern hole;
  hole.border = loop;
  return nearest_on_loops(hole, p).distance <= kSame * width(tears.torn());
}

/// Tears that have run into a hole, less those that leave it; absent: no tear ends at it.
std::optional<int> tears_into(const std::vector<Vector2d>& loop, const Tears& tears) {
  const auto on = [&](const Vector2d& p) { return is_on(loop, p, tears); };
  int ended = 0, left = 0;
  for (const Tear& tear : tears.all()) {
    if (tear.path.size() < 2) continue;
    if (tear.ended && on(tear.tip())) ++ended;
    if (on(tear.path.front())) ++left;
  }
  if (ended == 0) return std::nullopt;
  return ended - left;
}

}  // namespace

std::vector<TearCandidate> plain_candidates(const Sheet& sheet, const Tears& tears) {
  std::vector<TearCandidate> candidates;
  for (std::size_t t = 0; t < tears.all().size(); ++t) {
    if (!tears.all()[t].ended) candidates.push_back({tears.all()[t].tip(), static_cast<int>(t)});
  }
  for (std::size_t k = 0; k < sheet.pattern.loop_count(); ++k) {
    const std::vector<Vector2d>& loop = sheet.pattern.loop(k);
    const auto open = k == 0 ? std::nullopt : tears_into(loop, tears);
    if (open && *open > 0) {
      TearCandidate candidate{loop[0], std::nullopt};
      candidate.hole = static_cast<int>(k);
      candidates.push_back(candidate);
    }
    if (open) continue;
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vector2d in = loop[i] - loop[(i + n - 1) % n], out = loop[(i + 1) % n] - loop[i];
      if (signed_angle(in, out) < -kLeastNotch) candidates.push_back({loop[i], std::nullopt});
    }
  }
  for (const Handle& handle : sheet.handles) {
    if (handle.points.size() == 1 && !handle.disc_radius)
      candidates.push_back({handle.points[0], std::nullopt});
  }
  return candidates;
}

bool is_on_entered_hole(const Sheet& sheet, const Tears& tears, const Vector2d& p) {
  return std::ranges::any_of(sheet.pattern.holes, [&](const std::vector<Vector2d>& loop) {
    return is_on(loop, p, tears) && tears_into(loop, tears);
  });
}

TearGrowth::TearGrowth(const Sheet& sheet, const TearOptions& options)
    : sheet_(sheet), options_(options), tears_(sheet.pattern, kPathTolerance) {
  if (!(options.step > 1e3 * kSame * width(sheet.pattern))) {
    throw Error("step of a tear is lost in the rounding of the pattern", "tearing.step",
                "more than a millionth of the pattern's width");
  }
}

Vector2d TearGrowth::direction_of(const TipPull& pull, const Vector2d& p) const {
  const Vector2d away = pull.away();
  if (options_.direction == TearDirection::askew)
    return Eigen::Rotation2Dd(std::copysign(kAskew, cross(away, pull.right))) * away;
  const bool even = !sheet_.toughness.grain_deg || sheet_.toughness.across == 1;
  if (even || options_.direction == TearDirection::bisector) return away;
  // Where the fibres count, what is released over what is opposed decides.
  Vector2d best = away;
  double most = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double turn = std::numbers::pi * ((k + 0.5) / kDirections - 0.5);
    const Vector2d d = Eigen::Rotation2Dd(turn) * away;
    const double ratio = pull.released(d, sheet_.material.thickness) / sheet_.toughness.at(p, d);
    if (ratio <= most) continue;
    most = ratio;
    best = d;
  }
  return best;
}

/// Distance to the next tip of another tear (m).
double TearGrowth::nearest_tip(const TearCandidate& candidate) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < tears_.all().size(); ++t) {
    const Tear& tear = tears_.all()[t];
    if (!tear.ended && static_cast<int>(t) != candidate.tear)
      nearest = std::min(nearest, (tear.tip() - candidate.place).norm());
  }
  return nearest;
}

/// How far a piece about the candidate may reach: neither to another tip nor to a hand, whose own
/// J integrals it would enclose (m).
double TearGrowth::clear_reach(const TearCandidate& candidate, double time) const {
  double nearest = std::min(options_.pull.reach / kClear, nearest_tip(candidate));
  for (const Handle& handle : sheet_.handles) {
    if (handle.is_active(time) && !handle.covers(candidate.place))
      nearest = std::min(nearest, handle.distance(candidate.place));
  }
  return kClear * nearest;
}

std::optional<TipPull> TearGrowth::pull_on(const TearCandidate& candidate, int vertex,
                                           const ShellStepper& stepper, const ShellState& state,
                                           const MeshNeighbours& neighbours) const {
  PullOptions options = options_.pull;
  options.reach = clear_reach(candidate, state.time);
  if (candidate.on_flaw) {
    // Near a tip it is the tip that tears.
    const bool near_tip =
        options_.search == TearSearch::candidates && nearest_tip(candidate) < options_.pull.reach;
    if (near_tip) return {};
    auto pull = pull_on_flaw(sheet_, state, neighbours, vertex, options_.flaw);
    if (pull && candidate.tear) pull->release *= kTip * kTip;
    return pull;
  }
  const bool integrates = options_.release == TearRelease::j_integral;
  auto pull = pull_at(sheet_, stepper, state, neighbours, vertex, options,
                      integrates ? sheet_.toughness.least() : 0);
  if (pull && !integrates) pull->release = pull->of_resultants();
  if (pull && options_.release == TearRelease::force)
    pull->release = 2 * pull->force * pull->away();
  return pull;
}

/// Of a hole it is a place once given up, and what is nearer to it than a step.
bool TearGrowth::is_given_up(const TearCandidate& candidate) const {
  const double same = candidate.hole ? options_.step : kSame * width(sheet_.pattern);
  return std::ranges::any_of(
      given_up_, [&](const Vector2d& p) { return (p - candidate.place).norm() <= same; });
}

/// Takes the candidate of a hole to where its border is stretched most; the pull is that on the
/// vertex there, about which a J integral over a large piece depends little on where it is.
std::optional<TipPull> TearGrowth::pull_of(TearCandidate& candidate, const ShellStepper& stepper,
                                           const ShellState& state,
                                           const MeshNeighbours& neighbours) const {
  std::optional<int> vertex;
  if (candidate.hole) {
    const auto peak =
        greatest_hoop_tension(sheet_, state, neighbours, sheet_.pattern.loop(*candidate.hole));
    if (!peak) return {};
    candidate.place = peak->place;
    vertex = peak->vertex;
  } else {
    vertex = vertex_at(state.mesh, candidate.place, kSame * width(sheet_.pattern));
  }
  if (!vertex || is_given_up(candidate)) return {};
  return pull_on(candidate, *vertex, stepper, state, neighbours);
}

std::optional<TearGrowth::Growing> TearGrowth::look_at(TearCandidate candidate,
                                                       const ShellStepper& stepper,
                                                       const ShellState& state,
                                                       const MeshNeighbours& neighbours) const {
  const auto pull = pull_of(candidate, stepper, state, neighbours);
  if (!pull) return {};
  Growing growing{candidate, *pull, direction_of(*pull, candidate.place), 0};
  if (candidate.tear) {
    const Vector2d heading = tears_.all()[*candidate.tear].heading();
    const double turn = signed_angle(heading, growing.direction);
    if (std::abs(turn) > kBack) return {};
    const double most = options_.most_turn_deg * kDegree;
    growing.direction = Eigen::Rotation2Dd(std::clamp(turn, -most, most)) * heading;
  }
  // The null goes astray, but not for want of energy.
  const Vector2d released_along =
      options_.direction == TearDirection::askew ? pull->away() : growing.direction;
  growing.excess = pull->released(released_along, sheet_.material.thickness) /
                   sheet_.toughness.at(candidate.place, growing.direction);
  // Into the sheet.
  const Vector2d ahead = candidate.place + options_.step * growing.direction;
  if (!contains(sheet_.pattern, ahead) && !candidate.tear) return {};
  return growing;
}

/// The same pull once the sheet has come to rest; absent when it is too weak on the way, gone, or
/// does not come to rest.
std::optional<TearGrowth::Growing> TearGrowth::at_rest(Growing growing, ShellStepper& stepper,
                                                       ShellState state,
                                                       const MeshNeighbours& neighbours) const {
  Relaxation relaxation(kRelaxTime, stepper, state);
  for (int i = 0; i < options_.rest_steps; ++i) {
    const bool whole = relaxation.step(stepper, state);
    auto next = look_at(growing.candidate, stepper, state, neighbours);
    if (!next || next->excess < 1) return std::nullopt;
    const double turn = std::abs(signed_angle(growing.pull.away(), next->pull.away()));
    const double change = std::abs(next->excess / growing.excess - 1);
    growing = *std::move(next);
    if (whole && turn <= options_.rest_turn_deg * kDegree && change <= options_.rest_change)
      return growing;
  }
  return std::nullopt;
}

/// Where a step goes.
Vector2d TearGrowth::course(const Growing& growing) const {
  if (options_.integrator == TearIntegrator::euler || !growing.candidate.tear)
    return growing.direction;
  const Tear& tear = tears_.all()[*growing.candidate.tear];
  if (tear.last_pull.isZero(0)) return growing.direction;
  const double turn = signed_angle(tear.last_pull, growing.direction);
  // A jump of the pull is no curve to go on with.
  if (std::abs(turn) > kSmooth) return growing.direction;
  return Eigen::Rotation2Dd(turn / 2 * options_.step / tear.last_step) * growing.direction;
}

/// Takes a tip to a place, or to what stands in the way.
/// @return  elastic energy that the step set free (J)
double TearGrowth::go(int tear, const Vector2d& to, const Follower& follower, ShellStepper& stepper,
                      ShellState& state) {
  const Tears before = tears_;
  const ShellState old = state;
  const double energy = stepper.energies(state).strain();
  const Vector2d from = tears_.all()[tear].tip();
  const auto stop = tears_.obstruction(tear, to, kMargin);
  tears_.advance(tear, stop.value_or(to), state.time);
  if (stop) tears_.end(tear);
  const auto too_small = [&] {
    const std::vector<double> areas = part_areas(state.mesh);
    return std::ranges::count_if(areas, [&](double a) { return a < options_.least_part; });
  };
  const auto small_before = too_small();
  bool fits = true;
  try {
    follower.remesh(state);
    fits = !stop || too_small() <= small_before;
    if (fits) stepper.set_mesh(state);
  } catch (const Error&) {
    fits = false;
  }
  if (!fits) {
    // No mesh, or one that cuts off nothing: the tear stays where it is, and ends.
    tears_ = before;
    tears_.end(tear);
    given_up_.push_back(from);
    ++totals_.given_up;
    follower.take_back();
    state = old;
    stepper.set_mesh(state);
  }
  // What the new mesh has strained is not for the sheet to move by.
  Relaxation relaxation(kRelaxTime, stepper, state);
  for (int i = 0; i < kMostRelaxSteps; ++i) {
    if (i >= kRelaxSteps && relaxation.energy() <= energy) break;
    relaxation.step(stepper, state);
  }
  return energy - relaxation.energy();
}

void TearGrowth::take_step(const Growing& growing, const Follower& follower, ShellStepper& stepper,
                           ShellState& state) {
  const Vector2d from = growing.candidate.place;
  // A flaw opens at once: any shorter slit would release less than what opened it.
  const bool opens = growing.candidate.on_flaw && !growing.candidate.tear;
  const double step = opens ? std::max(options_.flaw, options_.step) : options_.step;
  const Vector2d to = from + step * course(growing);
  const int tear =
      growing.candidate.tear ? *growing.candidate.tear : tears_.start(from, state.time);
  const double released = go(tear, to, follower, stepper, state);
  const Vector2d way = tears_.all()[tear].tip() - from;
  if (way.isZero(0)) return;
  tears_.note_pull(tear, growing.direction, way.norm(), growing.pull.shear(way.normalized()));
  const double opposed = sheet_.toughness.at(from + way / 2, way.normalized());
  totals_.energy += opposed * way.norm() * sheet_.material.thickness;
  totals_.released += released;
  ++totals_.steps;
  last_pull_ = {growing.pull.force, growing.pull.angle};
}

int TearGrowth::grow(const Candidates& candidates, const Follower& follower, ShellStepper& stepper,
                     ShellState& state) {
  if (!sheet_.toughness.tears()) return 0;
  if (wait_ > 0 && state.time - looked_ < kLongestWait) {
    --wait_;
    return 0;
  }
  looked_ = state.time;
  for (int steps = 0; steps < kMostSteps; ++steps) {
    const Eigen::MatrixX3i& now = state.mesh.triangles;
    if (!neighbours_ || !same_triangles(neighbours_->triangles, now)) {
      neighbours_.emplace(state.mesh);
    }
    const MeshNeighbours& neighbours = *neighbours_;
    std::vector<TearCandidate> places = candidates();
    if (options_.search == TearSearch::everywhere) add_vertices(state.mesh, tears_, places);
    std::vector<Growing> pulled;
    for (const TearCandidate& candidate : places) {
      ++totals_.tested;
      auto growing = look_at(candidate, stepper, state, neighbours);
      if (growing && growing->excess >= 1) pulled.push_back(*std::move(growing));
    }
    std::stable_sort(pulled.begin(), pulled.end(),
                     [](const Growing& a, const Growing& b) { return a.excess > b.excess; });
    std::optional<Growing> strongest;
    for (std::size_t i = 0; !strongest && i < pulled.size(); ++i)
      strongest = at_rest(pulled[i], stepper, state, neighbours);
    if (!strongest) {
      in_vain_ = steps > 0 || pulled.empty() ? 0 : std::min(in_vain_ + 1, kMostWait);
      wait_ = in_vain_;
      return steps;
    }
    take_step(*strongest, follower, stepper, state);
  }
  return kMostSteps;
}

void TearGrowth::save(StateWriter& out) const {
  tears_.save(out);
  out.items(given_up_);
  // One by one: what lies between the members of a struct has no value.
  out.number(totals_.energy);
  out.number(totals_.released);
  out.number(totals_.tested);
  out.number(totals_.steps);
  out.number(totals_.given_up);
  out.number(last_pull_);
  out.number(in_vain_);
  out.number(wait_);
  out.number(looked_);
}

void TearGrowth::load(StateReader& in) {
  tears_.load(in);
  in.items(given_up_);
  totals_.energy = in.number<double>();
  totals_.released = in.number<double>();
  totals_.tested = in.number<int>();
  totals_.steps = in.number<int>();
  totals_.given_up = in.number<int>();
  last_pull_ = in.number<LastPull>();
  in_vain_ = in.number<int>();
  wait_ = in.number<int>();
  looked_ = in.number<double>();
}

}  // namespace geoprior::paper
