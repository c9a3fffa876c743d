#include "experiments/grammar/measures/fidelity.h"

#include <algorithm>
#include <cmath>

#include "metrics/arrangement/changes.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

double mean_square_distance(std::span<const Vector3d> a, std::span<const Vector3d> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]).squaredNorm();
  return sum / static_cast<double>(a.size());
}

/// Squares of distances, summed over elements.
class SquareSums {
 public:
  void add(double of_state, double of_nothing) {
    of_state_ += of_state;
    of_nothing_ += of_nothing;
    ++count_;
  }
  /// Root mean squares; absent without elements.
  [[nodiscard]] std::optional<Deviation> deviation() const {
    if (count_ == 0) return std::nullopt;
    return Deviation{std::sqrt(of_state_ / count_), std::sqrt(of_nothing_ / count_)};
  }

 private:
  double of_state_ = 0, of_nothing_ = 0;
  int count_ = 0;
};

}  // namespace

std::optional<Deviation> deviation_of(const RecordedState& state, const RecordedState& rest,
                                      const AskedPlaces& asked) {
  SquareSums sums;
  for (const RecordedElement& before : rest.elements()) {
    const RecordedElement* now = state.find_same(before);
    if (now == nullptr || before.keys.empty()) continue;
    const std::vector<Vector3d> wanted = asked.keys(before.number);
    sums.add(mean_square_distance(now->keys, wanted), mean_square_distance(before.keys, wanted));
  }
  return sums.deviation();
}

std::optional<Deviation> unserved_deviation_of(const RecordedState& state,
                                               const RecordedState& rest, const AskedPlaces& asked,
                                               const std::set<int>& broken) {
  SquareSums sums;
  for (const RecordedElement& before : rest.elements()) {
    if (before.keys.empty()) continue;
    const std::vector<Vector3d> wanted = asked.keys(before.number);
    const double at_rest = mean_square_distance(before.keys, wanted);
    const RecordedElement* now = state.find_same(before);
    double own = now != nullptr ? mean_square_distance(now->keys, wanted) : at_rest;
    if (broken.contains(before.number)) own = std::max(own, at_rest);
    sums.add(own, at_rest);
  }
  return sums.deviation();
}

Difference difference_of(const RecordedState& state, const RecordedState& other) {
  Difference out;
  int matched = 0;
  for (const RecordedElement& e : state.elements()) {
    const RecordedElement* same = other.find_same(e);
    if (same == nullptr) continue;
    ++matched;
    for (std::size_t k = 0; k < e.keys.size(); ++k)
      out.largest = std::max(out.largest.value_or(0), (e.keys[k] - same->keys[k]).norm());
  }
  out.unmatched = static_cast<int>(state.elements().size() + other.elements().size()) - 2 * matched;
  return out;
}

ElementChanges element_changes(const RecordedState& state, const RecordedState& before) {
  ElementChanges out;
  for (const RecordedElement& e : before.elements()) {
    ++out.before;
    const RecordedElement* now = state.find_same(e);
    if (now == nullptr) ++out.lost;
    if (now == nullptr || !looks_the_same(*now, e)) ++out.touched;
  }
  for (const RecordedElement& e : state.elements())
    if (before.find_same(e) == nullptr) ++out.added;
  return out;
}

std::optional<double> kept_size(const RecordedState& state, const RecordedState& before) {
  double sum = 0;
  int count = 0;
  for (const RecordedElement& e : before.elements()) {
    const std::optional<double> then = before.parameter_if_any(e, "size");
    if (!then || *then == 0) continue;
    ++count;
    if (const RecordedElement* now = state.find_same(e))
      sum += state.parameter(*now, "size") / *then;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

int changed_among(std::span<const int> elements, const RecordedState& state,
                  const RecordedState& before) {
  return static_cast<int>(std::count_if(elements.begin(), elements.end(), [&](int number) {
    const RecordedElement* then = before.find(number);
    const RecordedElement* now = state.find(number);
    if (then == nullptr || now == nullptr) return then != now;
    return !same_bytes(*now, *then);
  }));
}

std::optional<KeptElement> kept_element(const RecordedState& now, const RecordedElement& before) {
  const RecordedElement* e = now.find_same(before);
  if (e == nullptr) return std::nullopt;
  KeptElement out{distance_change(before.keys, e->keys), 0};
  for (std::size_t p = 0; p < e->parameters.size(); ++p)
    out.parameter = std::max(out.parameter, std::abs(e->parameters[p] - before.parameters[p]));
  return out;
}

}  // namespace geoprior::grammar
