#include "experiments/grammar/measures/tree_shape.h"

#include <cmath>

#include "metrics/arrangement/angles.h"

namespace geoprior::grammar {
namespace {

int level_of(const RecordedState& state, const RecordedElement& branch) {
  return static_cast<int>(std::lround(state.parameter(branch, "level")));
}

}  // namespace

double branch_length(const RecordedElement& branch) {
  return (branch.keys.at(1) - branch.keys.at(0)).norm();
}

std::map<int, double> level_means_of(const RecordedState& rest) {
  std::map<int, double> out, count;
  for (const RecordedElement* branch : rest.of_type("branch")) {
    const int level = level_of(rest, *branch);
    out[level] += branch_length(*branch);
    count[level] += 1;
  }
  for (auto& [level, mean] : out) mean /= count[level];
  return out;
}

double level_mean(const RecordedState& state, const RecordedElement& branch,
                  const std::map<int, double>& means_at_rest) {
  const auto found = means_at_rest.find(level_of(state, branch));
  return found != means_at_rest.end() ? found->second : state.parameter(branch, "mean");
}

BranchSamples branch_samples(const RecordedState& state,
                             const std::map<int, double>& means_at_rest) {
  BranchSamples out;
  for (const RecordedElement* branch : state.of_type("branch")) {
    out.lengths.push_back(branch_length(*branch) / level_mean(state, *branch, means_at_rest));
    const RecordedElement* parent = state.find(branch->parent);
    if (parent == nullptr || parent->type != branch->type) continue;
    out.angles.push_back(
        angle_between(branch->keys[1] - branch->keys[0], parent->keys[1] - parent->keys[0]));
  }
  return out;
}

}  // namespace geoprior::grammar
