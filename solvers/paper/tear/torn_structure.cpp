#include "solvers/paper/tear/torn_structure.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"
#include "solvers/paper/sheet/singular_point.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Of the width of the pattern, that a point on a lip lies from it.
constexpr double kOnLip = 1e-9;

/// Where a cut of the pattern crosses a ruling, the ends of the ruling apart.
std::optional<Vector2d> crossing(const Pattern& pattern, const Ruling& r) {
  constexpr double kEnds = 1e-6;
  std::optional<double> nearest;
  for (const std::vector<Vector2d>& cut : pattern.cuts) {
    for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
      const auto t = ray_hit(r.a, r.b - r.a, cut[i], cut[i + 1], kEnds);
      if (t && *t < 1 - kEnds && (!nearest || *t < *nearest)) nearest = t;
    }
  }
  if (!nearest) return std::nullopt;
  return r.a + *nearest * (r.b - r.a);
}

std::optional<int> tip_point(const PaperStructure& structure, int tear) {
  for (int s = 0; s < std::ssize(structure.singular_points); ++s) {
    if (structure.singular_points[s].tear == tear) return s;
  }
  return std::nullopt;
}

/// Singular points within the gap of a tear, tips apart: their sheet is no longer whole.
int remove_passed(RulingEditor& editor) {
  int removed = 0;
  auto& points = editor.structure().singular_points;
  for (std::size_t s = 0; s < points.size();) {
    const SingularPoint& p = points[s];
    if (!p.tear && distance_to_cuts(editor.pattern(), p.position) < editor.bounds().gap) {
      editor.remove_point(static_cast<int>(s));
      ++removed;
    } else {
      ++s;
    }
  }
  return removed;
}

/// A ruling of a tip that has moved on, from the tip.
struct Loose {
  int tear;
  Ruling ruling;
};

Ruling from_tip(Ruling r, int tip) {
  if (r.singular_a == tip) return r;
  std::swap(r.a, r.b);
  std::swap(r.singular_a, r.singular_b);
  return r;
}

/// Takes the tip of every tear to where it is now; its rulings are given back, to be laid again.
std::vector<Loose> move_tips(const Tears& tears, double time, RulingEditor& editor) {
  PaperStructure& structure = editor.structure();
  std::vector<Loose> loose;
  for (std::size_t t = 0; t < tears.all().size(); ++t) {
    const Tear& tear = tears.all()[t];
    const int number = static_cast<int>(t);
    std::optional<int> tip = tip_point(structure, number);
    if (tear.ended) {
      if (tip) editor.remove_point(*tip);
      continue;
    }
    if (!tip) {
      SingularPoint point;
      for (const SingularPoint& other : structure.singular_points)
        point.id = std::max(point.id, other.id + 1);
      point.position = tear.tip();
      point.birth = time;
      point.on_border = true;
      point.tear = number;
      structure.singular_points.push_back(point);
      continue;
    }
    SingularPoint& point = structure.singular_points[*tip];
    if ((point.position - tear.tip()).norm() <= editor.same()) continue;
    point.position = tear.tip();
    point.weakening = 0;
    std::vector<bool> marked;
    for (const Ruling& r : structure.rulings) {
      marked.push_back(r.singular_a == tip || r.singular_b == tip);
      if (marked.back()) loose.push_back({number, from_tip(r, *tip)});
    }
    editor.remove(marked);
  }
  return loose;
}

/// The last edge of a lip turns as the tip goes on: ends of rulings on it keep to it.
void follow_lips(RulingEditor& editor) {
  for (Ruling& r : editor.structure().rulings) {
    for (const auto& [end, singular] :
         {std::pair(&r.a, r.singular_a), std::pair(&r.b, r.singular_b)}) {
      if (!singular) *end = nearest_on_border(editor.pattern(), *end).point;
    }
  }
}

/// Rulings that no longer fit: cut by a lip, or too near to one.
void trim_rulings(RulingEditor& editor) {
  PaperStructure& structure = editor.structure();
  follow_lips(editor);
  const std::vector<bool> all(structure.rulings.size(), true);
  std::vector<bool> gone;
  std::vector<Ruling> halves;
  for (const Ruling& r : structure.rulings) {
    gone.push_back(!editor.fits(r, all));
    if (!gone.back()) continue;
    const auto at = crossing(editor.pattern(), r);
    if (!at) continue;
    for (const bool first : {true, false}) {
      Ruling half = r;
      (first ? half.b : half.a) = *at;
      (first ? half.singular_b : half.singular_a) = std::nullopt;
      halves.push_back(half);
    }
  }
  editor.remove(gone);
  for (const Ruling& half : halves) {
    if (!crossing(editor.pattern(), half) && editor.fits(half)) editor.add(half);
  }
}

/// Where a bent piece meets another one on the border: there its first and its last ruling end.
std::vector<Vector2d> junctions(const PaperStructure& structure) {
  std::vector<Vector2d> places;
  const auto add = [&](const Vector2d& p) {
    if (std::find(places.begin(), places.end(), p) == places.end()) places.push_back(p);
  };
  for (const SingularPoint& s : structure.singular_points) {
    if (s.on_border && !s.tear) add(s.position);
  }
  for (const PaperPiece& piece : structure.pieces) {
    if (piece.kind == PaperPiece::Kind::flat || piece.rulings.empty()) continue;
    for (const int i : {piece.rulings.front(), piece.rulings.back()}) {
      const Ruling& r = structure.rulings[i];
      if (!r.singular_a) add(r.a);
      if (!r.singular_b) add(r.b);
    }
  }
  return places;
}

}  // namespace

std::vector<TearCandidate> tear_candidates(const Sheet& sheet, const Tears& tears,
                                           const PaperStructure& structure) {
  std::vector<TearCandidate> candidates = plain_candidates(sheet, tears);
  for (const Vector2d& p : junctions(structure)) {
    // A lip is no border that has flaws of its own; of a hole with a tear the place is known.
    if (distance_to_cuts(tears.torn(), p) > kOnLip * width(tears.torn()) &&
        !is_on_entered_hole(sheet, tears, p))
      candidates.push_back({p, std::nullopt, true});
  }
  return candidates;
}

int follow_tears(const Tears& tears, double time, const HybridOptions& options,
                 RulingEditor& editor) {
  const auto loose = move_tips(tears, time, editor);
  const int removed = remove_passed(editor);
  trim_rulings(editor);
  for (const auto& [tear, ruling] : loose) {
    const auto tip = tip_point(editor.structure(), tear);
    if (!tip) continue;
    auto ray = editor.ray_to(*tip, ruling.b);
    if (!ray) continue;
    ray->age_frames = ruling.age_frames;
    ray->unbent_frames = ruling.unbent_frames;
    editor.add(*ray);
  }
  for (std::size_t t = 0; t < tears.all().size(); ++t) {
    const auto tip = tip_point(editor.structure(), static_cast<int>(t));
    if (tip) fill_fan(*tip, options, editor);
  }
  return removed;
}

}  // namespace geoprior::paper
