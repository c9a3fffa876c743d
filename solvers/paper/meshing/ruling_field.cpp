#include "solvers/paper/meshing/ruling_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/angles.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kSamples = 12;  // along a line
constexpr int kTurns = 5;     // lines tried to each side
/// Nearest that a line is laid to another, in the distance that the bending asks for, and the
/// narrowest gap between two that gets a line in its middle.
constexpr double kNear = 0.75;
constexpr double kTight = 1.6;
/// Frames that a line may be astray, and the share of bending along it beyond which it goes at
/// once.
constexpr int kPatience = 4;
constexpr double kFarAstray = 0.25;
/// Most bending along a new line, in that along one that goes: so that lines do not come and go.
constexpr double kLaid = 0.6;
/// Preference for the direction of the line beside (share of bending along it, at a right angle).
constexpr double kSteady = 0.2;
/// Gain of share under which a line stays where it is: four degrees of one that is alone wrong.
constexpr double kWorthATurn = 5e-3;

/// Mean of S S along a segment, away from its ends.
Matrix2d bending_along(const BendingField& field, const Vector2d& a, const Vector2d& b) {
  Matrix2d sum = Matrix2d::Zero();
  for (int k = 0; k < kSamples; ++k) {
    const Matrix2d S = field.at(a + (b - a) * (k + 0.5) / kSamples);
    sum += S * S / kSamples;
  }
  return sum;
}

/// Unit vector of the smallest eigenvalue.
Vector2d least_direction(const Matrix2d& T) {
  const double angle = std::atan2(T(0, 1), (T(0, 0) - T(1, 1)) / 2) / 2;
  return {-std::sin(angle), std::cos(angle)};
}

double share_along(const Matrix2d& T, const Vector2d& d) {
  return d.dot(T * d) / (d.squaredNorm() * T.trace());
}

bool is_bent(const Matrix2d& T, const HybridOptions& options) {
  return T.trace() > options.flat_curvature * options.flat_curvature;
}

/// Turns chords towards the direction of least bending along them, by no more than
/// `tracking_rate_deg` a frame.
bool turn(const BendingField& field, const HybridOptions& options, int frames,
          RulingEditor& editor) {
  std::vector<Ruling>& rulings = editor.structure().rulings;
  bool any = false;
  for (int i = 0; i < std::ssize(rulings); ++i) {
    if (!is_chord(rulings[i])) continue;
    const Matrix2d T = bending_along(field, rulings[i].a, rulings[i].b);
    if (!is_bent(T, options)) continue;
    double least = share_along(T, rulings[i].b - rulings[i].a) - kWorthATurn;
    if (least <= 0) continue;
    std::optional<Ruling> best;
    const int turns = kTurns * frames;
    for (int k = -turns; k <= turns; ++k) {
      if (k == 0) continue;
      const auto line = editor.turned(i, k * options.tracking_rate_deg * kDegree / kTurns);
      if (!line) continue;
      const double share = share_along(bending_along(field, line->a, line->b), line->b - line->a);
      if (share >= least) continue;
      least = share;
      best = line;
    }
    if (!best) continue;
    rulings[i] = *best;
    any = true;
  }
  return any;
}

/// Lays lines where the sheet is bent.
class RulingLayer {
 public:
  RulingLayer(const BendingField& field, const HybridOptions& options, RulingEditor& editor)
      : field_(field), options_(options), editor_(editor), border_{editor.pattern().border} {
    most_ = kLaid * std::pow(std::sin(options.follow_angle_deg * kDegree), 2);
  }

  /// Families of lines: from those that are there, then from the point bent most that none covers,
  /// each grows to both sides.
  int lay() {
    for (std::size_t i = 0; i < rulings().size(); ++i) grow(i);
    const Eigen::VectorXd bent = field_.curvature().rowwise().norm();
    std::vector<int> order(bent.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return bent[i] > bent[j]; });
    for (const int v : order) {
      if (bent[v] < options_.flat_curvature) break;
      const Vector2d p = field_.sheet().mesh.pattern.row(v);
      const double asked = spacing(bent[v]);
      if (is_at_border(p, kNear * asked) || !is_free(p, asked)) continue;
      const Matrix2d S = field_.at(p);
      const std::size_t first = rulings().size();
      if (!add(p, least_direction(S * S))) continue;
      for (std::size_t i = first; i < rulings().size(); ++i) grow(i);
    }
    return added_;
  }

 private:
  [[nodiscard]] std::vector<Ruling>& rulings() { return editor_.structure().rulings; }
  [[nodiscard]] double spacing(double curvature) const {
    return std::clamp(options_.refine_angle_deg * kDegree / curvature, 2 * editor_.bounds().gap,
                      options_.seeding_distance);
  }
  [[nodiscard]] bool is_free(const Vector2d& p, double asked) {
    return std::none_of(rulings().begin(), rulings().end(), [&](const Ruling& r) {
      return distance_to_segment(p, r.a, r.b) < kNear * asked;
    });
  }

  /// The ground beside a hole is narrow: there a line may be laid as near as it fits.
  [[nodiscard]] bool is_at_border(const Vector2d& p, double distance) const {
    if (nearest_on_border(editor_.pattern(), p).distance < editor_.bounds().gap) return true;
    return nearest_on_border(border_, p).distance < distance;
  }

  /// Puts lines beside a chord, as far as the bending asks for. Where a hole cuts the line beside
  /// it, each part is laid for itself.
  void grow(std::size_t index) {
    for (const int side : {-1, 1}) {
      const Ruling r = rulings()[index];
      if (!is_chord(r)) return;
      const Matrix2d T = bending_along(field_, r.a, r.b);
      if (!is_bent(T, options_)) return;
      const double asked = spacing(std::sqrt(T.trace()));
      const Vector2d along = (r.b - r.a).normalized(), across = side * perpendicular(along);
      const Vector2d middle = (r.a + r.b) / 2;
      const RulingHit hit = editor_.propagate(middle, across);
      double step = asked;
      if (!editor_.is_hole(hit)) {
        if (hit.distance < kTight * asked) continue;
        if (hit.kind == RulingHit::Kind::ruling && hit.distance < 2 * kTight * asked)
          step = hit.distance / 2;
        if (hit.kind != RulingHit::Kind::ruling && hit.distance < asked + editor_.bounds().gap)
          continue;
      }
      add_parts(middle + step * across, along, asked);
    }
  }

  void add_parts(const Vector2d& p, const Vector2d& along, double asked) {
    if (editor_.pattern().holes.empty()) {
      add(p, along);
      return;
    }
    for (const Vector2d& middle : editor_.middles_of_parts(p, along)) {
      if (is_free(middle, asked)) add(middle, along);
    }
  }

  /// Adds the line through p near the direction d along which the sheet bends least, if it fits.
  bool add(const Vector2d& p, const Vector2d& d) {
    std::optional<Ruling> best;
    double least = 0;
    for (int k = -kTurns; k <= kTurns; ++k) {
      const double angle = k * options_.follow_angle_deg * kDegree / kTurns;
      const auto line = editor_.chord(p, Eigen::Rotation2Dd(angle) * d);
      if (!line) continue;
      const Matrix2d T = bending_along(field_, line->a, line->b);
      if (!is_bent(T, options_)) continue;
      const double share = share_along(T, line->b - line->a);
      const double turned = std::sin(line_angle(line->b - line->a, d));
      const double cost = share + kSteady * turned * turned;
      if (share > most_ || (best && cost >= least)) continue;
      least = cost;
      best = line;
    }
    if (!best) return false;
    editor_.add(*best);
    ++added_;
    return true;
  }

  const BendingField& field_;
  const HybridOptions& options_;
  RulingEditor& editor_;
  Pattern border_;  ///< the pattern without its holes
  double most_ = 0;
  int added_ = 0;
};

}  // namespace

bool follow_bending(const BendingField& field, const HybridOptions& options, RulingEditor& editor,
                    int& new_rulings, int frames) {
  const double most = std::pow(std::sin(options.follow_angle_deg * kDegree), 2);
  std::vector<Ruling>& rulings = editor.structure().rulings;
  const bool turned = turn(field, options, frames, editor);
  std::vector<bool> gone(rulings.size(), false);
  for (std::size_t i = 0; i < rulings.size(); ++i) {
    if (!is_chord(rulings[i])) continue;
    const Matrix2d T = bending_along(field, rulings[i].a, rulings[i].b);
    const double share = share_along(T, rulings[i].b - rulings[i].a);
    int& astray = rulings[i].astray_frames;
    astray = is_bent(T, options) && share > most ? astray + frames : 0;
    gone[i] = astray >= kPatience || (astray > 0 && share > kFarAstray);
  }
  const bool removed = std::find(gone.begin(), gone.end(), true) != gone.end();
  if (removed) editor.remove(gone);
  const int added = RulingLayer(field, options, editor).lay();
  new_rulings += added;
  return turned || removed || added > 0;
}

}  // namespace geoprior::paper
