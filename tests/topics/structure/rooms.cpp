#include "tests/topics/structure/rooms.h"

#include <algorithm>
#include <map>
#include <set>

namespace geoprior::test::structure {
namespace {

/// What each room may include of the others; tests, benchmarks and examples stand outside.
const std::map<std::string, std::set<std::string>>& rooms_below() {
  static const std::map<std::string, std::set<std::string>> below{
      {"core", {}},
      {"metrics", {"core"}},
      {"testbed", {"core"}},
      {"models", {"core"}},
      {"baselines", {"core", "models"}},
      {"solvers", {"core", "models", "baselines"}},
      {"experiments", {"core", "metrics", "models", "baselines", "solvers", "testbed"}}};
  return below;
}

/// Room and topic of a path; without a topic in rooms that have none, and of
/// experiments/topics.cpp.
struct Place {
  explicit Place(const std::string& path) {
    const std::vector<std::string> parts = path_parts(path);
    room = parts[0];
    static const std::set<std::string> of_topics{"models", "baselines", "solvers", "experiments"};
    if (of_topics.contains(room) && parts.size() > 2) topic = parts[1];
    is_table = room == "experiments" && parts.size() == 3;
  }
  std::string room;
  std::string topic;
  bool is_table = false;  ///< directly in experiments/<topic>
};

/// Why one may not include the other; empty when it may.
std::string objection(const SourceTree& tree, const Place& from, const Place& to) {
  const auto allowed = rooms_below().find(from.room);
  if (allowed == rooms_below().end() || !rooms_below().contains(to.room)) return "";
  if (from.room != to.room && !allowed->second.contains(to.room)) {
    return from.room + " does not see " + to.room;
  }
  if (from.topic.empty() || to.topic.empty()) return "";
  if (from.topic == to.topic) {
    return to.is_table && !from.is_table ? "a folder below the tables includes a table" : "";
  }
  const auto uses = tree.uses.find(from.topic);
  if (uses == tree.uses.end() || !uses->second.contains(to.topic)) {
    return "CMakeLists.txt does not say " + from.topic + " USES " + to.topic;
  }
  return to.is_table ? "the tables of " + to.topic + " are its own" : "";
}

/// Rooms that use a unit, those of the models that use it included.
class ModelUsers {
 public:
  explicit ModelUsers(const IncludeGraph& graph) : users_(users_of(graph)) {}

  [[nodiscard]] std::set<std::string> rooms_of(const std::string& unit) const {
    std::set<std::string> seen{unit}, rooms;
    collect(unit, seen, rooms);
    return rooms;
  }

 private:
  void collect(const std::string& unit, std::set<std::string>& seen,
               std::set<std::string>& rooms) const {
    static const std::set<std::string> sides{"baselines", "solvers", "experiments"};
    for (const std::string& user : users_.at(unit)) {
      const std::string room = path_parts(user)[0];
      if (sides.contains(room)) rooms.insert(room);
      if (room == "models" && seen.insert(user).second) collect(user, seen, rooms);
    }
  }

  IncludeGraph users_;
};

}  // namespace

std::vector<std::string> crowded_folders(const SourceTree& tree, std::size_t most) {
  std::map<std::string, std::size_t> count;
  for (const SourceFile& file : tree.files) ++count[file.path.substr(0, file.path.rfind('/'))];
  std::vector<std::string> crowded;
  for (const auto& [folder, sources] : count) {
    if (sources > most) crowded.push_back(folder + ": " + std::to_string(sources) + " sources");
  }
  return crowded;
}

std::vector<std::string> arrows_back(const SourceTree& tree) {
  std::vector<std::string> back;
  for (const SourceFile& file : tree.files) {
    const Place from(file.path);
    for (const std::string& include : file.includes) {
      const std::string why = objection(tree, from, Place(include));
      if (!why.empty()) back.push_back(file.path + " -> " + include + ": " + why);
    }
  }
  return back;
}

std::vector<std::string> models_of_one_side(const IncludeGraph& graph) {
  const ModelUsers users(graph);
  std::vector<std::string> one_sided;
  for (const auto& [unit, includes] : graph) {
    if (!unit.starts_with("models/")) continue;
    const std::set<std::string> rooms = users.rooms_of(unit);
    if (rooms.size() > 1) continue;
    one_sided.push_back(unit + ": used by " +
                        (rooms.empty() ? "nobody" : *rooms.begin() + " alone"));
  }
  return one_sided;
}

std::vector<std::string> methods_without_header(const SourceTree& tree,
                                                const std::vector<MethodName>& methods) {
  std::vector<std::string> without;
  for (const MethodName& method : methods) {
    std::string name = method.name;
    std::replace(name.begin(), name.end(), '-', '_');
    const std::string folder =
        (method.is_baseline ? "baselines/" : "solvers/") + method.topic + "/";
    const std::string header = "/" + name + ".h";
    const bool found =
        method.is_baseline
            ? tree.headers.contains(folder + name + ".h") ||
                  tree.headers.contains(folder + name + header) ||
                  tree.headers.contains("experiments/" + method.topic + header)
            : std::any_of(tree.headers.begin(), tree.headers.end(), [&](const std::string& path) {
                return path.starts_with(folder) && path.ends_with(header);
              });
    if (!found)
      without.push_back(method.topic + "/" + method.name + ": no " + folder + name + ".h");
  }
  return without;
}

}  // namespace geoprior::test::structure
