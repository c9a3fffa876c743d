#include "testbed/runner/spec/left_out.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "testbed/runner/spec/overrides.h"
#include "testbed/runner/spec/sweeps.h"

namespace geoprior {

namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Takes texts out of a list of a table; a list of which nothing is left goes, too.
template <class Left>
void leave_out(TomlNode& table, const std::string& key, Left is_left_out) {
  TomlNode* list = table.find(key);
  if (list == nullptr || list->items.empty()) return;
  std::erase_if(list->items, [&](const TomlNode& name) { return is_left_out(name.text); });
  if (list->items.empty()) table.erase(key);
}

bool is_grid(const TomlNode& sweep) {
  const TomlNode* grid = sweep.find("grid");
  return grid != nullptr && grid->boolean;
}

bool is_made(const std::string& name, const std::vector<CaseSpec>& cases) {
  return std::any_of(cases.begin(), cases.end(),
                     [&](const CaseSpec& made) { return made.name == name; });
}

}  // namespace

KnownNames known_names(const TomlNode& root, const TomlNode& written,
                       const std::vector<std::string>& selected, bool quick) {
  KnownNames names;
  for (const TomlNode& node : tables_of(root, "variant")) {
    const std::string& name = node.find("name")->text;
    const bool runs = selected.empty() || holds(selected, name);
    (runs ? names.variants : names.dropped).push_back(name);
    if (const TomlNode* to = node.find("reference")) names.references[name] = to->text;
  }
  for (const SweptCase& swept : expand_sweeps(written, quick)) names.cases.push_back(swept.name);
  if (!quick) return names;
  const std::set<std::string> known(names.cases.begin(), names.cases.end());
  for (const SweptCase& swept : expand_sweeps(written, false)) {
    if (!known.contains(swept.name)) names.cases.push_back(swept.name);
  }
  return names;
}

void require_claimed_variants(const TomlNode& root, const std::vector<std::string>& dropped) {
  const auto require = [&](const TomlNode& table, const TomlNode& claim) {
    const auto require_one = [&](const TomlNode& name, const char* member) {
      if (!holds(dropped, name.text)) return;
      throw Error("quick runs leave variant '" + name.text + "' out", place_of(table, member),
                  "`quick = false` of the claim at " + claim.place + ", too");
    };
    for (const char* member : {"variant", "of", "null"}) {
      if (const TomlNode* name = table.find(member)) require_one(*name, member);
    }
  };
  for (const TomlNode& claim : tables_of(root, "claim")) {
    require(claim, claim);
    const TomlNode* metric = claim.find("metric");
    for (const TomlNode& study : tables_of(root, "study")) {
      const TomlNode* name = study.find("name");
      const bool read =
          metric != nullptr && name != nullptr && metric->text == "study:" + name->text;
      if (read) require(study, claim);
    }
  }
}

void drop_sweeps(TomlNode& root, const std::vector<std::string>& dropped) {
  TomlNode* sweeps = root.find("sweep");
  if (sweeps == nullptr) return;
  const auto runs_dropped_alone = [&](const TomlNode& sweep) {
    const TomlNode* names = sweep.find("variants");
    return names != nullptr && !names->items.empty() &&
           std::all_of(names->items.begin(), names->items.end(),
                       [&](const TomlNode& name) { return holds(dropped, name.text); });
  };
  const bool grid_goes = std::all_of(
      sweeps->items.begin(), sweeps->items.end(),
      [&](const TomlNode& sweep) { return !is_grid(sweep) || runs_dropped_alone(sweep); });
  std::erase_if(sweeps->items, [&](const TomlNode& sweep) {
    const TomlNode* key = sweep.find("key");
    const bool of_dropped =
        key != nullptr && std::any_of(dropped.begin(), dropped.end(), [&](const auto& name) {
          return key->text.starts_with("variant." + name + ".");
        });
    return of_dropped || (is_grid(sweep) ? grid_goes : runs_dropped_alone(sweep));
  });
  for (TomlNode& sweep : sweeps->items) {
    leave_out(sweep, "variants", [&](const std::string& name) { return holds(dropped, name); });
  }
}

void drop_cases(std::vector<StudySpec>& studies, const std::vector<CaseSpec>& cases) {
  std::erase_if(studies, [&](StudySpec& study) {
    if (study.cases.empty()) return false;
    std::erase_if(study.cases, [&](const std::string& name) { return !is_made(name, cases); });
    return study.cases.empty();
  });
}

void drop_cases(std::vector<ClaimSpec>& claims, const std::vector<CaseSpec>& cases) {
  for (ClaimSpec& claim : claims) {
    std::erase_if(claim.except,
                  [&](const auto& excepted) { return !is_made(excepted.first, cases); });
  }
}

void leave_out_of_view(TomlNode& root, const KnownNames& names,
                       const std::vector<CaseSpec>& cases) {
  TomlNode* view = root.find("figure_view");
  if (view == nullptr) return;
  const auto is_dropped = [&](const std::string& name) { return holds(names.dropped, name); };
  leave_out(*view, "variants", is_dropped);
  for (const char* row : {"above", "below"}) {
    if (TomlNode* further = view->find(row)) leave_out(*further, "variants", is_dropped);
  }
  leave_out(*view, "cases", [&](const std::string& name) {
    return holds(names.cases, name) && !is_made(name, cases);
  });
}

}  // namespace geoprior
