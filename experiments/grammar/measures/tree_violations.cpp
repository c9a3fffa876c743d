#include <cmath>
#include <map>
#include <vector>

#include "experiments/grammar/measures/tree_shape.h"
#include "experiments/grammar/measures/violations.h"
#include "metrics/arrangement/crossings.h"
#include "metrics/arrangement/lengths.h"

namespace geoprior::grammar {
namespace {

constexpr double kShortest = 0.5, kLongest = 1.5;  // of the mean of the level
/// Branches that leave one branch at the same place, up to so much of its length, meet there.
constexpr double kSameNode = 1e-9;

void measure_attachment(const RecordedState& state, const RecordedElement& branch, Tally& out) {
  const RecordedElement* parent = state.find(branch.parent);
  if (parent == nullptr || parent->keys.empty()) return;
  const double attach = state.parameter(branch, "attach");
  const Eigen::Vector3d& base = branch.keys.at(0);
  out.add(parent->keys.size() == 1 ? (base - parent->keys[0]).norm()
                                   : attachment_gap(base, parent->keys[0], parent->keys[1], attach),
          {branch.number});
}

}  // namespace

TreeViolations tree_violations(const RecordedState& state, const RecordedState& rest) {
  TreeViolations out;
  const auto branches = state.of_type("branch");
  if (branches.empty()) return out;
  const std::map<int, double> means = level_means_of(rest);
  std::vector<ThickSegment> axes;
  std::vector<double> attach;
  for (const RecordedElement* branch : branches) {
    const double mean = level_mean(state, *branch, means);
    out.length.add(out_of_range(branch_length(*branch), kShortest * mean, kLongest * mean),
                   {branch->number});
    measure_attachment(state, *branch, out.attachment);
    axes.push_back({branch->keys.at(0), branch->keys.at(1), state.parameter(*branch, "radius")});
    attach.push_back(state.parameter(*branch, "attach"));
  }
  const auto meet = [&](int i, int j) {
    const RecordedElement &a = *branches[i], &b = *branches[j];
    if (a.parent == b.number || b.parent == a.number) return true;
    return a.parent == b.parent && std::abs(attach[i] - attach[j]) <= kSameNode;
  };
  const auto crossed = crossings(axes, Tally::kHolds, meet);
  out.crossings.broken = static_cast<int>(crossed.size());
  out.crossings.worst = out.crossings.broken;
  for (const auto& [i, j] : crossed)
    out.crossings.elements.insert(out.crossings.elements.end(),
                                  {branches[i]->number, branches[j]->number});
  return out;
}

}  // namespace geoprior::grammar
