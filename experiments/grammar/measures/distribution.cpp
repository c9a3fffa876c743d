#include "experiments/grammar/measures/distribution.h"

#include <utility>
#include <vector>

#include "experiments/grammar/measures/tree_shape.h"
#include "metrics/arrangement/distributions.h"
#include "metrics/arrangement/point_grid.h"
#include "metrics/arrangement/spacing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

/// Places of the elements of a set that count, and twice the mean of their radii (m).
struct CountedElements {
  std::vector<Vector3d> places;
  double spacing = 0;
};

CountedElements counted_elements(const RecordedState& state, const char* type) {
  constexpr double kCounts = 0.5;
  CountedElements out;
  for (const RecordedElement* e : state.of_type(type)) {
    if (state.parameter(*e, "size") < kCounts) continue;
    out.places.push_back(e->keys.at(0));
    out.spacing += 2 * state.parameter(*e, "radius");
  }
  if (!out.places.empty()) out.spacing /= static_cast<double>(out.places.size());
  return out;
}

std::vector<Vector3d> places_between(const CountedElements& rest, const AskedPlaces& asked) {
  std::vector<Vector3d> out;
  const PointGrid grid(rest.places);
  for (int i = 0; i < grid.size(); ++i)
    grid.visit(grid.point(i), 1.5 * rest.spacing, [&](int j, double) {
      if (j > i) out.push_back(asked.at(0.5 * (grid.point(i) + grid.point(j))));
    });
  return out;
}

}  // namespace

TreeDistributions tree_distributions(const RecordedState& state, const RecordedState& rest) {
  const auto means = level_means_of(rest);
  const BranchSamples now = branch_samples(state, means), then = branch_samples(rest, means);
  return {kolmogorov_smirnov(now.lengths, then.lengths),
          kolmogorov_smirnov(now.angles, then.angles)};
}

SetDistribution set_distribution(const RecordedState& state, const RecordedState& rest,
                                 const AskedPlaces& asked) {
  SetDistribution out;
  for (const char* type : {"item", "grain"}) {
    const CountedElements now = counted_elements(state, type);
    if (now.places.empty()) continue;
    out.spread = coefficient_of_variation(nearest_neighbour_distances(now.places));
    std::vector<Vector3d> places;
    for (const RecordedElement* surface : state.of_type("surface-set")) places = surface->keys;
    if (places.empty()) places = places_between(counted_elements(rest, type), asked);
    out.hole = largest_hole(places, now.places);
    if (out.hole) *out.hole /= now.spacing;
  }
  return out;
}

}  // namespace geoprior::grammar
