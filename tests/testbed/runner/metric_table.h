#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "testbed/topic.h"

namespace geoprior::test {

/// A topic's metric table, of which tests ask single rows.
class MetricTable {
 public:
  explicit MetricTable(std::vector<MetricGroup> groups) : groups_(std::move(groups)) {}

  /// @throws Error  when there is no such row, or what the group's measurement throws
  [[nodiscard]] std::optional<double> of_frame(const std::string& name, const Scene& scene,
                                               const Frame& frame,
                                               const Frame* reference = nullptr) const {
    const Row row = find(name);
    return row.group->of_frame(scene, frame, reference).at(row.index);
  }

  [[nodiscard]] std::optional<double> of_sequence(const std::string& name, const Scene& scene,
                                                  const std::vector<Frame>& frames) const {
    const Row row = find(name);
    return row.group->of_sequence(scene, FramesInMemory(frames)).at(row.index);
  }

 private:
  struct Row {
    const MetricGroup* group;
    std::size_t index;
  };

  [[nodiscard]] Row find(const std::string& name) const {
    for (const MetricGroup& group : groups_) {
      for (std::size_t i = 0; i < group.rows.size(); ++i) {
        if (group.rows[i].name == name) return {&group, i};
      }
    }
    throw Error("no metric '" + name + "' in the table");
  }

  std::vector<MetricGroup> groups_;
};

}  // namespace geoprior::test
