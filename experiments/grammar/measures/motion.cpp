#include "experiments/grammar/measures/motion.h"

#include <algorithm>
#include <cmath>

#include "metrics/arrangement/changes.h"

namespace geoprior::grammar {

double element_extent(const RecordedState& state, const RecordedElement& element) {
  if (element.keys.size() != 1) return extent_of(element.keys);
  const auto size = state.parameter_if_any(element, "size");
  const auto radius = state.parameter_if_any(element, "radius");
  return size && radius ? 2 * *size * *radius : 0;
}

namespace {

/// Extent of an element if it were at full size (m).
double full_extent(const RecordedState& state, const RecordedElement& element) {
  const double extent = element_extent(state, element);
  const auto size = state.parameter_if_any(element, "size");
  return size && *size > 0 ? extent / *size : extent;
}

/// The same element in another frame. New elements are numbered as they come: one of the same
/// number that hangs on another element is another one.
const RecordedElement* same_in(const RecordedState& other, const RecordedElement& e, bool is_new) {
  const RecordedElement* same = other.find_same(e);
  return is_new && same != nullptr && same->parent != e.parent ? nullptr : same;
}

}  // namespace

void PopMeter::note(int element, double size, double pop) {
  Watched& w = watched_[element];
  w.size = std::max(w.size, size);
  w.pop = std::max(w.pop, pop);
  largest_ = std::max(largest_.value_or(0), pop);
}

void PopMeter::add(const RecordedState& before, const AskedPlaces& asked_before,
                   const RecordedState& now, const AskedPlaces& asked_now) {
  if (!largest_) largest_ = 0;
  for (const RecordedElement& e : before.elements()) {
    if (e.keys.empty()) continue;
    const double extent = element_extent(before, e);
    const RecordedElement* same = same_in(now, e, !asked_before.knows(e));
    if (same == nullptr) {
      note(e.number, full_extent(before, e), extent);
      continue;
    }
    const bool is_known = asked_before.knows(e);
    const auto from = is_known ? asked_before.keys(e.number) : e.keys;
    const auto to = is_known ? asked_now.keys(e.number) : e.keys;
    double pop = unexplained_displacement(e.keys, same->keys, from, to);
    // Of a ball the surface moves by the change of its radius.
    if (e.keys.size() == 1)
      pop = std::max(pop, 0.5 * std::abs(element_extent(now, *same) - extent));
    note(e.number, std::max(full_extent(before, e), full_extent(now, *same)), pop);
  }
  for (const RecordedElement& e : now.elements())
    if (!e.keys.empty() && same_in(before, e, !asked_now.knows(e)) == nullptr)
      note(e.number, full_extent(now, e), element_extent(now, e));
}

std::optional<double> PopMeter::largest_over_size() const {
  if (!largest_) return std::nullopt;
  double out = 0;
  for (const auto& [element, w] : watched_)
    if (w.size > 0) out = std::max(out, w.pop / w.size);
  return out;
}

double return_gap(const RecordedState& start, const RecordedState& end) {
  double out = 0;
  for (const RecordedElement& e : start.elements()) {
    const RecordedElement* same = end.find_same(e);
    if (same == nullptr) out = std::max(out, element_extent(start, e));
    if (same == nullptr) continue;
    for (std::size_t k = 0; k < e.keys.size(); ++k)
      out = std::max(out, (e.keys[k] - same->keys[k]).norm());
  }
  for (const RecordedElement& e : end.elements())
    if (start.find_same(e) == nullptr) out = std::max(out, element_extent(end, e));
  return out;
}

}  // namespace geoprior::grammar
