#include "tests/topics/turned_options.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/runner/reference/headlines.h"

namespace geoprior::test {
namespace {

using Json = nlohmann::ordered_json;

void flatten(const Json& value, const std::string& key, FlatOptions& flat) {
  if (value.is_object()) {
    if (!key.empty()) flat[key] = "table";
    for (const auto& [name, member] : value.items()) {
      flatten(member, key.empty() ? name : key + "." + name, flat);
    }
    return;
  }
  const bool is_list = value.is_array() && !value.empty() && value.front().is_object();
  if (!is_list) {
    flat[key] = value.dump();
    return;
  }
  flat[key] = std::to_string(value.size()) + " elements";
  for (std::size_t i = 0; i < value.size(); ++i) {
    flatten(value[i], key + "[" + std::to_string(i) + "]", flat);
  }
}

/// The choices that select a member: "kind" and "form" of "kind = disc | svg, form = open".
std::vector<std::string> choices_in(const std::string& when) {
  std::vector<std::string> names;
  std::istringstream parts(when);
  for (std::string part; std::getline(parts, part, ',');) {
    part.erase(0, part.find_first_not_of(' '));
    names.push_back(part.substr(0, part.find(" = ")));
  }
  return names;
}

/// The tables around a key, the outermost first: "", "a.", "a.b[0]." of "a.b[0].c".
std::vector<std::string> tables_around(const std::string& key) {
  std::vector<std::string> tables{""};
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1)) {
    tables.push_back(key.substr(0, dot + 1));
  }
  return tables;
}

/// Whether a table or list around the key is another one.
bool comes_with_table(const std::string& key, const std::set<std::string>& differ) {
  for (std::size_t i = 1; i < key.size(); ++i) {
    if ((key[i] == '.' || key[i] == '[') && differ.contains(key.substr(0, i))) return true;
  }
  return false;
}

/// Whether a choice that selects the key is another one.
bool comes_with_choice(const std::string& key, const std::set<std::string>& differ,
                       const OptionRows& rows) {
  const OptionRow* row = rows.find(row_key(key));
  if (row == nullptr) return false;
  for (const std::string& name : choices_in(row->when)) {
    for (const std::string& table : tables_around(key)) {
      const std::string choice = table + name;
      if (choice == key || !differ.contains(choice)) continue;
      const OptionRow* tag = rows.find(row_key(choice));
      if (tag != nullptr && tag->type == "choice") return true;
    }
  }
  return false;
}

std::set<std::string> differing_keys(const FlatOptions& a, const FlatOptions& b) {
  std::set<std::string> keys;
  for (const auto& [key, value] : a) {
    const auto other = b.find(key);
    if (other == b.end() || other->second != value) keys.insert(key);
  }
  for (const auto& [key, value] : b) {
    if (!a.contains(key)) keys.insert(key);
  }
  return keys;
}

/// Those keys that no other one takes along.
std::vector<std::string> turned_keys(const FlatOptions& a, const FlatOptions& b,
                                     const OptionRows& rows) {
  const std::set<std::string> differ = differing_keys(a, b);
  std::vector<std::string> keys;
  for (const std::string& key : differ) {
    const bool follows = comes_with_table(key, differ) || comes_with_choice(key, differ, rows);
    if (!follows) keys.push_back(key);
  }
  return keys;
}

/// "disc" of "\"disc\"".
std::string plain(const std::string& json) {
  return json.size() >= 2 && json.front() == '"' ? json.substr(1, json.size() - 2) : json;
}

std::vector<std::string> values_of(const OptionRow& row) {
  if (row.type != "choice") return {""};
  std::vector<std::string> values;
  std::string rest = row.range;
  for (std::size_t bar = 0; (bar = rest.find(" | ")) != std::string::npos;) {
    values.push_back(rest.substr(0, bar));
    rest.erase(0, bar + 3);
  }
  values.push_back(rest);
  return values;
}

const std::string* find_outcome(const BlessedSet& set, const std::string& in,
                                const std::string& variant) {
  const auto variants = set.outcomes.find(in);
  if (variants == set.outcomes.end()) return nullptr;
  const auto hash = variants->second.find(variant);
  return hash == variants->second.end() ? nullptr : &hash->second;
}

using Values = std::map<std::string, ReferenceValue>;

const Values* find_values(const BlessedSet& set, const std::string& in,
                          const std::string& variant) {
  const auto variants = set.values.find(in);
  if (variants == set.values.end()) return nullptr;
  const auto values = variants->second.find(variant);
  return values == variants->second.end() ? nullptr : &values->second;
}

bool differ(const ReferenceValue& a, const ReferenceValue& b) {
  return a.value != b.value && !(std::isnan(a.value) && std::isnan(b.value));
}

std::vector<OptionRow> listed(OptionSet& set) {
  return list_options([&](OptionVisitor& visitor) { set.visit(visitor); });
}

/// Whether a claim says that one of the variants passes what the other, its null, fails there:
/// `check` holds what was blessed of it.
bool is_told_by_claim(const Experiment& experiment, const BlessedSet& blessed,
                      const std::string& in, const std::string& a, const std::string& b) {
  return std::any_of(
      experiment.claims.begin(), experiment.claims.end(), [&](const ClaimSpec& claim) {
        const bool between = claim.null && ((claim.variant == a && *claim.null == b) ||
                                            (claim.variant == b && *claim.null == a));
        const bool is_metric = claim.metric.find(':') == std::string::npos;
        if (!between || !is_metric || !blessed.claims.contains(claim.text)) return false;
        const auto& cases = blessed.claims.at(claim.text);
        const bool told = cases.contains(in) && cases.at(in).outcome == ClaimOutcome::holds;
        return told && claim.exempt == Exemption::none && claim.over == ClaimOver::case_ &&
               !claim.known_shortfall;
      });
}

/// One struct that several methods have describes its options to all of them in the same words.
bool are_described_alike(const OptionRow& a, const OptionRow& b) {
  return a.type == b.type && a.default_value == b.default_value && a.range == b.range &&
         a.unit == b.unit && a.doc == b.doc;
}

}  // namespace

OptionRows::OptionRows(std::vector<OptionRow> rows) : rows_(std::move(rows)) {
  for (std::size_t i = 0; i < rows_.size(); ++i) index_[rows_[i].key] = i;
}

const OptionRow* OptionRows::find(const std::string& key) const {
  const auto at = index_.find(key);
  return at == index_.end() ? nullptr : &rows_[at->second];
}

FlatOptions flat_options(const Json& options) {
  FlatOptions flat;
  flatten(options, "", flat);
  return flat;
}

std::string row_key(const std::string& key) {
  std::string row;
  for (std::size_t i = 0; i < key.size(); ++i) {
    row += key[i];
    if (key[i] == '[') i = key.find(']', i) - 1;
  }
  return row;
}

std::set<std::string> turned_rows(const FlatOptions& a, const FlatOptions& b,
                                  const OptionRows& rows) {
  std::set<std::string> turned;
  for (const std::string& key : turned_keys(a, b, rows)) turned.insert(row_key(key));
  return turned;
}

std::string OptionUnit::text() const {
  const std::string head = where + " " + key + ": ";
  switch (turned) {
    case Turned::never:
      return head + "never turned";
    case Turned::unknown:
      return head + "no outcome is blessed of " + columns;
    case Turned::without_effect:
      return head + "without effect in " + columns;
    case Turned::with_effect:
      break;
  }
  return head + "turned in " + columns;
}

struct TurnedOptions::Column {
  std::string in;
  const VariantSpec* variant = nullptr;
  std::uint64_t seed = 0;
  int threads = 0;
  const FlatOptions* scene = nullptr;
  FlatOptions options;
};

TurnedOptions::TurnedOptions(const Topic& topic) : topic_(topic.name), places_{"scene"} {
  rows_.emplace("scene", listed(*topic.default_scene()));
  for (const MethodEntry& method : topic.methods) {
    places_.push_back(method.name);
    rows_.emplace(method.name, listed(*method.default_options()));
  }
  for (const MetricGroup& group : topic.metrics) {
    if (!group.needs_reference) continue;
    for (const MetricEntry& row : group.rows) reference_metrics_.insert(row.name);
  }
}

const OptionRows& TurnedOptions::rows_of(const std::string& place) const { return rows_.at(place); }

void TurnedOptions::add(const Experiment& experiment, const BlessedSet* blessed) {
  std::vector<FlatOptions> scenes;
  for (const CaseSpec& in : experiment.cases) {
    scenes.push_back(flat_options(Json::parse(in.scene_json)));
  }
  std::vector<Column> columns;
  for (std::size_t i = 0; i < experiment.cases.size(); ++i) {
    const CaseSpec& in = experiment.cases[i];
    if (in.claims_only) continue;
    for (const VariantSpec& variant : in.variants) {
      columns.push_back({in.name, &variant, in.seed, in.threads, &scenes[i],
                         flat_options(Json::parse(variant.options_json))});
    }
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) compare(experiment, blessed, columns[j], columns[i]);
  }
}

void TurnedOptions::compare(const Experiment& experiment, const BlessedSet* blessed,
                            const Column& a, const Column& b) {
  const std::string& method = a.variant->method;
  if (method != b.variant->method || a.seed != b.seed || a.threads != b.threads) return;
  const bool same_options = a.variant->options_json == b.variant->options_json;
  const bool same_scene = a.scene == b.scene;
  const auto scene =
      same_scene ? std::vector<std::string>{} : turned_keys(*a.scene, *b.scene, rows_of("scene"));
  const auto options = same_options ? std::vector<std::string>{}
                                    : turned_keys(a.options, b.options, rows_of(method));
  if (scene.empty() == options.empty()) return;
  const std::string place = options.empty() ? "scene" : method;
  const std::vector<std::string>& keys = options.empty() ? scene : options;
  const std::string row = row_key(keys.front());
  if (std::any_of(keys.begin(), keys.end(),
                  [&](const std::string& key) { return row_key(key) != row; })) {
    return;
  }
  const std::string text = experiment.id + (experiment.quick ? " (quick)" : "") + ": " +
                           a.variant->name + ", " + a.in + " against " + b.variant->name + ", " +
                           b.in;
  const Evidence evidence{effect(experiment, blessed, a, b), text};
  const OptionRow* listed_row = rows_of(place).find(row);
  if (listed_row == nullptr || listed_row->type != "choice") {
    note(place, row, "", evidence);
    return;
  }
  for (const std::string& key : keys) {
    for (const Column* column : {&a, &b}) {
      const FlatOptions& of = options.empty() ? *column->scene : column->options;
      if (const auto value = of.find(key); value != of.end()) {
        note(place, row, plain(value->second), evidence);
      }
    }
  }
}

void TurnedOptions::note(const std::string& place, const std::string& row, const std::string& value,
                         const Evidence& evidence) {
  Evidence& best = found_[place][row][value];
  if (evidence.turned > best.turned) best = evidence;
}

Turned TurnedOptions::effect(const Experiment& experiment, const BlessedSet* blessed,
                             const Column& a, const Column& b) const {
  const std::string &name_a = a.variant->name, &name_b = b.variant->name;
  if (blessed == nullptr) return Turned::unknown;
  if (a.in == b.in && is_told_by_claim(experiment, *blessed, a.in, name_a, name_b)) {
    return Turned::with_effect;
  }
  const std::string* outcome_a = find_outcome(*blessed, a.in, name_a);
  const std::string* outcome_b = find_outcome(*blessed, b.in, name_b);
  if (outcome_a != nullptr && outcome_b != nullptr) {
    return *outcome_a != *outcome_b ? Turned::with_effect : Turned::without_effect;
  }
  const Values* values_a = find_values(*blessed, a.in, name_a);
  const Values* values_b = find_values(*blessed, b.in, name_b);
  if (values_a == nullptr || values_b == nullptr) return Turned::unknown;
  bool any = false;
  for (const auto& [metric, value] : *values_a) {
    const bool compares = reference_metrics_.contains(without_statistic(metric));
    if (compares || metric.find(':') != std::string::npos || !values_b->contains(metric)) continue;
    any = true;
    if (differ(value, values_b->at(metric))) return Turned::with_effect;
  }
  return any ? Turned::without_effect : Turned::unknown;
}

/// Of a table that may be absent and of a list of tables what is best known of it and of its
/// members: these say that it does something.
TurnedOptions::Evidence TurnedOptions::evidence_of(const std::string& place, const OptionRow& row,
                                                   const std::string& value) const {
  const auto rows = found_.find(place);
  if (rows == found_.end()) return {};
  Evidence best;
  for (const auto& [key, values] : rows->second) {
    const bool is_member = (row.type == "tables" && key.starts_with(row.key + "[].")) ||
                           (row.type == "table" && key.starts_with(row.key + "."));
    if (key != row.key && !is_member) continue;
    for (const auto& [of_value, evidence] : values) {
      if ((is_member || of_value == value) && evidence.turned > best.turned) best = evidence;
    }
  }
  return best;
}

TurnedOptions::Evidence TurnedOptions::shared_evidence_of(const std::string& place,
                                                          const OptionRow& row,
                                                          const std::string& value) const {
  Evidence best = evidence_of(place, row, value);
  if (place == "scene") return best;
  for (const std::string& other : places_) {
    const OptionRow* there = other == "scene" ? nullptr : rows_of(other).find(row.key);
    if (there == nullptr || !are_described_alike(row, *there)) continue;
    const Evidence evidence = evidence_of(other, *there, value);
    if (evidence.turned > best.turned) best = evidence;
  }
  return best;
}

void TurnedOptions::share_scene(const TurnedOptions& used,
                                const std::vector<UsersChoice>& choices) {
  const std::string where = used.topic_ + "/scene";
  for (const OptionRow& row : rows_of("scene").rows()) {
    const OptionRow* there = used.rows_of("scene").find(row.key);
    if (there == nullptr || !are_described_alike(row, *there)) continue;
    for (const std::string& value : values_of(row)) {
      note("scene", row.key, value, used.evidence_of("scene", *there, value));
      for (const UsersChoice& choice : choices) {
        const bool is_value = choice.key == row.key || choice.key == row.key + "=" + value;
        if (choice.where != where || !is_value) continue;
        note("scene", row.key, value, {Turned::with_effect, choice.place});
      }
    }
  }
}

std::vector<OptionUnit> TurnedOptions::units() const {
  std::vector<OptionUnit> units;
  for (const std::string& place : places_) {
    for (const OptionRow& row : rows_of(place).rows()) {
      // A table that is always there has no value of its own.
      if (row.type == "table" && !row.may_be_absent) continue;
      for (const std::string& value : values_of(row)) {
        const Evidence found = shared_evidence_of(place, row, value);
        units.push_back({topic_ + "/" + place, value.empty() ? row.key : row.key + "=" + value,
                         found.turned, found.columns});
      }
    }
  }
  return units;
}

std::vector<UsersChoice> users_choices(const std::string& text, const std::string& source) {
  std::vector<UsersChoice> choices;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = source + ":" + std::to_string(++number);
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    UsersChoice choice;
    std::string more;
    words >> choice.where >> choice.key >> choice.file >> choice.test;
    if (choice.test.empty() || words >> more || choice.test.find('.') == std::string::npos) {
      throw Error("is no user's choice", place,
                  "<topic>/<method or \"scene\"> <key> <test file> <Suite.Test>");
    }
    choice.place = place;
    choices.push_back(choice);
  }
  return choices;
}

namespace {

/// "" where the file has the test and says the option's name.
std::string problem_of_test(const UsersChoice& choice, const std::filesystem::path& root) {
  const std::filesystem::path file = root / choice.file;
  if (!std::filesystem::is_regular_file(file)) return "there is no file " + choice.file;
  const std::string text = read_whole_file(file);
  const std::size_t dot = choice.test.find('.');
  const std::regex test("TEST(_F|_P)?\\(\\s*" + choice.test.substr(0, dot) + "\\s*,\\s*" +
                        choice.test.substr(dot + 1) + "\\s*\\)");
  if (!std::regex_search(text, test)) return choice.file + " has no test " + choice.test;
  const std::string key = choice.key.substr(0, choice.key.find('='));
  std::string name = key.substr(key.rfind('.') + 1);
  name.erase(std::min(name.find('['), name.size()));
  const std::regex word("(\\b|\\\\n)" + name + "\\b");  // a line of a text in a source, too
  return std::regex_search(text, word) ? "" : choice.file + " never says " + name;
}

/// The choice is the option itself, or the whole of which the unit is one value.
bool is_chosen(const OptionUnit& unit, const UsersChoice& choice) {
  return unit.where == choice.where &&
         (unit.key == choice.key || unit.key.starts_with(choice.key + "="));
}

}  // namespace

std::vector<std::string> option_problems(const std::vector<OptionUnit>& units,
                                         const std::vector<UsersChoice>& choices,
                                         const std::filesystem::path& root) {
  std::vector<std::string> problems;
  for (const OptionUnit& unit : units) {
    const bool chosen = std::any_of(choices.begin(), choices.end(), [&](const UsersChoice& choice) {
      return is_chosen(unit, choice);
    });
    if (!chosen && unit.turned != Turned::with_effect) problems.push_back(unit.text());
  }
  for (const UsersChoice& choice : choices) {
    const auto is_unit = [&](const OptionUnit& unit) { return is_chosen(unit, choice); };
    const auto is_needed = [&](const OptionUnit& unit) {
      return is_unit(unit) && unit.turned != Turned::with_effect;
    };
    const std::string head = choice.place + ": " + choice.where + " " + choice.key + ": ";
    if (std::none_of(units.begin(), units.end(), is_unit)) {
      problems.push_back(head + "there is no such option");
    } else if (std::none_of(units.begin(), units.end(), is_needed)) {
      problems.push_back(head + "an experiment turns it: the line may go");
    }
    const std::string test = problem_of_test(choice, root);
    if (!test.empty()) problems.push_back(head + test);
  }
  return problems;
}

}  // namespace geoprior::test
