#include "tests/topics/structure/include_graph.h"

#include <algorithm>

namespace geoprior::test::structure {
namespace {

/// Tarjan's walk. `low` is the earliest unit on the stack that is reached from below a unit.
class CircleWalk {
 public:
  explicit CircleWalk(const IncludeGraph& graph) : graph_(graph) {
    for (const auto& [unit, includes] : graph_) {
      if (!number_.contains(unit)) visit(unit);
    }
  }
  [[nodiscard]] const std::vector<std::string>& circles() const { return circles_; }

 private:
  void visit(const std::string& unit) {
    const int own = static_cast<int>(number_.size());
    number_[unit] = low_[unit] = own;
    stack_.push_back(unit);
    on_stack_.insert(unit);
    for (const std::string& included : graph_.at(unit)) {
      if (!number_.contains(included)) {
        visit(included);
        low_[unit] = std::min(low_[unit], low_[included]);
      } else if (on_stack_.contains(included)) {
        low_[unit] = std::min(low_[unit], number_[included]);
      }
    }
    if (low_[unit] == own) close(unit);
  }

  void close(const std::string& first) {
    const auto begin = std::find(stack_.begin(), stack_.end(), first);
    std::vector<std::string> members(begin, stack_.end());
    stack_.erase(begin, stack_.end());
    for (const std::string& member : members) on_stack_.erase(member);
    if (members.size() < 2) return;
    std::sort(members.begin(), members.end());
    std::string text;
    for (const std::string& member : members) text += (text.empty() ? "" : ", ") + member;
    circles_.push_back(text);
  }

  const IncludeGraph& graph_;
  std::map<std::string, int> number_, low_;
  std::vector<std::string> stack_;
  std::set<std::string> on_stack_;
  std::vector<std::string> circles_;
};

}  // namespace

IncludeGraph include_graph(const SourceTree& tree) {
  IncludeGraph graph;
  for (const SourceFile& file : tree.files) graph[unit_of(file.path)];
  for (const SourceFile& file : tree.files) {
    const std::string unit = unit_of(file.path);
    for (const std::string& include : file.includes) {
      const std::string included = unit_of(include);
      if (included != unit && graph.contains(included)) graph[unit].insert(included);
    }
  }
  return graph;
}

IncludeGraph users_of(const IncludeGraph& graph) {
  IncludeGraph users;
  for (const auto& [unit, includes] : graph) {
    users[unit];
    for (const std::string& included : includes) users[included].insert(unit);
  }
  return users;
}

std::vector<std::string> include_circles(const IncludeGraph& graph) {
  std::vector<std::string> circles = CircleWalk(graph).circles();
  std::sort(circles.begin(), circles.end());
  return circles;
}

}  // namespace geoprior::test::structure
