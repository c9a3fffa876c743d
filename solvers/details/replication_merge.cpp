#include <algorithm>
#include <tuple>
#include <utility>

#include "solvers/details/replication_state.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

bool Replication::may_fade(int site) const {
  if (!now_.is_detail(site) || now_.site[index(site)].target_weight == 0) return false;
  return options_.area_rule != AreaRule::budget || budget_.deficit(patch_of_site(site)) <= -limit();
}

bool Replication::has_ghost(int t) const {
  const auto corner = now_.mesh.corners(t);
  return std::any_of(corner.begin(), corner.end(), [&](int c) { return !now_.is_detail(c); });
}

/// Mean ratio of the triangles among details around one: small where details crowd.
double Replication::room_of(int site) const {
  const int start = now_.mesh.outgoing(site);
  double sum = 0;
  int count = 0;
  for (int h = start; h >= 0;) {
    if (!has_ghost(h / 3)) {
      sum += ratio(h / 3);
      ++count;
    }
    h = now_.mesh.twin(IntrinsicTriangulation::previous(h));
    if (h == start) break;
  }
  return count > 0 ? sum / count : 1;
}

/// Square of the shortest edge over the area that the triangle should have: small where two details
/// are close. The smallest triangles are slivers as often, which say nothing of distances: in their
/// order the pattern ends farther from the original.
double Replication::crowding(int t) const {
  const double shortest =
      std::min({now_.mesh.length(3 * t), now_.mesh.length(3 * t + 1), now_.mesh.length(3 * t + 2)});
  return shortest * shortest / wanted_area(t);
}

/// The end of the shortest edge that goes: the younger one. -1 when a detail of the triangle fades
/// already (that makes room), or no end may.
int Replication::loser(int t) const {
  int shortest = 3 * t;
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const int c = now_.mesh.origin(h);
    if (now_.is_detail(c) && now_.site[index(c)].target_weight == 0) return -1;
    if (now_.mesh.length(h) < now_.mesh.length(shortest)) shortest = h;
  }
  const auto age = [&](int i) {
    const Detail& d = now_.site[index(i)];
    return std::tuple(d.weight, room_of(i), -d.birth);
  };
  const int a = now_.mesh.origin(shortest), b = now_.mesh.tip(shortest);
  if (!may_fade(a)) return may_fade(b) ? b : -1;
  if (!may_fade(b)) return a;
  return age(a) < age(b) ? a : b;
}

void Replication::fade_one_of(int t) {
  const int gone = marked(t) ? -1 : loser(t);
  if (gone < 0) return;
  for (const int c : now_.mesh.corners(t)) mark(c);
  now_.site[index(gone)].target_weight = 0;
  budget_.add(patch_of_site(gone), -1);
  ++counts_.fading;
}

void Replication::merge() {
  const bool budget = options_.area_rule == AreaRule::budget;
  rank_triangles(Need::fewer, [&](int t) {
    if (has_ghost(t)) return kNotWanting;
    if (!budget && ratio(t) * options_.shrink_threshold >= 1) return kNotWanting;
    return loser(t) >= 0 ? crowding(t) : kNotWanting;
  });
  use_new_marks();
  act_in_order(Need::fewer, [&](int t) { fade_one_of(t); });
}

}  // namespace geoprior
