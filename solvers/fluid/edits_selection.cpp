#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "solvers/fluid/edits.h"

namespace geoprior {
namespace {

std::string where_of(const Edit& edit) { return "edit '" + edit.name + "'"; }

bool meets(const FeatureSummary& feature, const Edit& edit) {
  if (feature.times.empty() || feature.largest_area < edit.smallest_area) return false;
  if (edit.interval.size() == 2 &&
      (feature.times.front() > edit.interval[1] || feature.times.back() < edit.interval[0])) {
    return false;
  }
  if (edit.box.size() != 6) return true;
  return std::any_of(feature.centres.begin(), feature.centres.end(), [&](const Eigen::Vector3d& c) {
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (c[k] < edit.box[i] || c[k] > edit.box[i + 3]) return false;
    }
    return true;
  });
}

std::string known_ids(std::span<const FeatureSummary> features) {
  if (features.empty()) return "none: the source has no features";
  std::string text;
  constexpr std::size_t kShown = 40;
  for (std::size_t i = 0; i < std::min(features.size(), kShown); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(features[i].id);
  }
  if (features.size() > kShown) {
    text += ", and " + std::to_string(features.size() - kShown) + " more";
  }
  return text;
}

}  // namespace

FeatureSummary summary_of(const Feature& feature) {
  FeatureSummary result{feature.id, feature.times, {}, 0};
  for (const Eigen::Isometry3d& p : feature.placement) result.centres.push_back(p.translation());
  for (const double area : feature.area) result.largest_area = std::max(result.largest_area, area);
  return result;
}

std::vector<int> select_features(std::span<const FeatureSummary> features, const Edit& edit) {
  require_valid(edit);
  std::vector<int> result;
  for (const double id : edit.ids) {
    const auto found = std::find_if(features.begin(), features.end(), [&](const FeatureSummary& f) {
      return static_cast<double>(f.id) == id;
    });
    if (found == features.end()) {
      const bool whole = id == std::floor(id) && std::abs(id) < 1e9;
      throw Error("there is no feature " +
                      (whole ? std::to_string(static_cast<long>(id)) : std::to_string(id)),
                  where_of(edit), known_ids(features));
    }
    result.push_back(found->id);
  }
  if (edit.ids.empty()) {
    for (const FeatureSummary& f : features) {
      if (meets(f, edit)) result.push_back(f.id);
    }
    if (result.empty()) {
      throw Error("no feature meets its box, interval and smallest area", where_of(edit),
                  features.empty() ? "a source with features of at least shortest_track frames"
                                   : "ids of the source: " + known_ids(features));
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace geoprior
