#include "testbed/runner/spec/claims.h"

#include <algorithm>
#include <tuple>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/runner/names.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/overrides.h"
#include "testbed/runner/spec/sweeps.h"
#include "testbed/runner/spec/tables.h"

namespace geoprior {
namespace {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "timing:solve", "diagnostic:iterations" and "study:order" name what no table lists.
bool has_prefix(const std::string& quantity) {
  return quantity.starts_with("timing:") || quantity.starts_with("diagnostic:");
}

void require_metric(const std::string& name, const Topic& topic, const std::string& place,
                    const Names& studies) {
  if (has_prefix(name)) return;
  if (name.starts_with("study:")) {
    if (contains(studies, name.substr(6))) return;
    throw Error("unknown study '" + name.substr(6) + "'", place,
                allowed_names(name.substr(6), studies));
  }
  Names names = metric_names(topic);
  if (contains(names, name)) return;
  for (const char* prefix : {"timing:<phase>", "diagnostic:<name>", "study:<name>"}) {
    names.emplace_back(prefix);
  }
  throw Error("unknown metric '" + name + "'", place, allowed_names(name, names));
}

void require_cases(const Names& cases, const KnownNames& names, const TomlNode& node) {
  for (const std::string& name : cases) {
    if (contains(names.cases, name)) continue;
    throw Error("there is no case '" + name + "'", place_of(node, "cases"),
                allowed_names(name, names.cases));
  }
}

/// False when --variant left the variant out; throws when there never was one.
bool runs(const std::string& variant, const KnownNames& names, const std::string& place) {
  if (contains(names.variants, variant)) return true;
  if (contains(names.dropped, variant)) return false;
  Names all = names.variants;
  all.insert(all.end(), names.dropped.begin(), names.dropped.end());
  throw Error("there is no variant '" + variant + "'", place, allowed_names(variant, all));
}

/// `at = { angle_deg = 90 }`: one number under the parameter's name.
void read_at(const TomlNode* at, std::optional<double>& parameter, std::string* key) {
  if (at == nullptr) return;
  const bool one = at->kind == TomlNode::Kind::table && at->items.size() == 1;
  if (!one) {
    throw Error("does not give one parameter", at->place + ": at",
                "a table of one number, { angle_deg = 90 }");
  }
  struct At {
    std::string key;
    double value = 0;
  };
  At read{at->keys.front(), 0};
  OptionTomlReader reader(*at, "at");
  reader.value(read.key, read.value, {.doc = "parameter of the frame"});
  parameter = read.value;
  if (key != nullptr) *key = read.key;
}

/// `OfReduction` is `same`, then the enumerators of `Reduction` in their order.
Reduction reduction_of(OfReduction x) { return static_cast<Reduction>(static_cast<int>(x) - 1); }

void read_except(const ClaimTable& table, const TomlNode& node, const KnownNames& names,
                 ClaimSpec& claim) {
  for (std::size_t i = 0; i < table.except.size(); ++i) {
    const ExceptTable& except = table.except[i];
    const TomlNode& place = node.find("except")->items[i];
    require_line(except.reason, "the reason", place_of(place, "reason"));
    require_cases(except.cases, names, place);
    for (const std::string& name : except.cases) {
      if (claim.except.emplace(name, except.reason).second) continue;
      throw Error("case '" + name + "' is excepted twice", place_of(place, "cases"));
    }
  }
}

/// Of `variants`, those that run; `variant` alone without them.
Names variants_of(const ClaimTable& table, const TomlNode& node, const KnownNames& names) {
  if (table.variants.empty()) return {table.variant.value_or("")};
  if (table.variant) {
    throw Error("has both `variant` and `variants`", node.place + ": claim", "one of the two");
  }
  Names kept;
  for (const std::string& name : table.variants) {
    if (contains(kept, name)) {
      throw Error("names '" + name + "' twice", place_of(node, "variants"));
    }
    if (runs(name, names, place_of(node, "variants"))) kept.push_back(name);
  }
  return kept;
}

/// Who reads that a claim holds must read that one seed in ten may not.
void require_share_of_seeds(const ClaimTable& table, const TomlNode& node) {
  if (table.over != ClaimOver::seed || table.text.find("9 of 10") != std::string::npos) return;
  throw Error("does not say that the claim is about 9 of 10 seeds", place_of(node, "text"),
              "\"…, in 9 of 10 seeds\"");
}

ClaimSpec claim_of(const ClaimTable& table, const TomlNode& node) {
  ClaimSpec claim;
  require_line(table.text, "a claim", place_of(node, "text"));
  require_share_of_seeds(table, node);
  claim.text = table.text;
  claim.metric = table.metric;
  claim.of = table.of;
  claim.value = table.value;
  claim.is = table.is;
  claim.factor = table.factor;
  claim.offset = table.offset;
  claim.tolerance = table.tolerance;
  claim.known_shortfall = table.known_shortfall;
  if (table.slack) require_line(*table.slack, "the reason", place_of(node, "slack"));
  claim.slack = table.slack;
  claim.reduce = table.reduce;
  if (table.of_reduce != OfReduction::same) claim.of_reduce = reduction_of(table.of_reduce);
  claim.over = table.over;
  claim.null = table.null;
  read_at(node.find("at"), claim.at_parameter, &claim.at_key);
  return claim;
}

void require_sides(const ClaimSpec& claim, const TomlNode& node) {
  if (claim.of.has_value() == claim.value.has_value()) {
    throw Error(claim.of ? "has both `of` and `value`" : "is compared with nothing",
                node.place + ": claim", "either `of`, a variant, or `value`, a number");
  }
  const bool study = claim.metric.starts_with("study:");
  const bool of_cases = claim.of || claim.at_parameter || !claim.except.empty();
  if (study && (!claim.variant.empty() || of_cases)) {
    throw Error("a study has one value for the whole experiment", place_of(node, "metric"),
                "metric, is, value, factor, offset, tolerance");
  }
  if (!study && claim.variant.empty()) {
    throw Error("is missing", place_of(node, "variant"), "the variant whose value is judged");
  }
  const bool reduces = node.find("reduce") != nullptr || claim.of_reduce;
  if (claim.at_parameter && reduces) {
    throw Error("`at` picks one frame, `reduce` and `of_reduce` take all", node.place + ": claim",
                "one of the two");
  }
  if (claim.of_reduce && !claim.of) {
    throw Error("reduces the frames of no variant", place_of(node, "of_reduce"),
                "with `of`, which may be the variant itself");
  }
  if (claim.of_reduce && claim.reduce == Reduction::every) {
    throw Error("`every` compares frame by frame", place_of(node, "of_reduce"),
                "another `reduce`, or no `of_reduce`");
  }
}

/// `reference_metric` is what the claim measures, if that compares with a reference; else null.
void require_null(const ClaimSpec& claim, const std::string& variant,
                  const MetricEntry* reference_metric, const KnownNames& names,
                  const TomlNode& node) {
  const std::string place = place_of(node, "null"), &null = *claim.null;
  if (null == variant) {
    throw Error("is the variant itself", place, "another variant, one that must fail the claim");
  }
  const auto reference_of = [&](const std::string& name) {
    const auto found = names.references.find(name);
    return found == names.references.end() ? std::string() : found->second;
  };
  if (reference_metric != nullptr && reference_of(null) != reference_of(variant)) {
    throw Error("'" + reference_metric->name + "' of '" + null + "' is not measured against '" +
                    reference_of(variant) + "'",
                place, "a null with the reference of '" + variant + "'");
  }
  const bool strict = claim.is == Comparison::less || claim.is == Comparison::greater;
  if (null_is_yardstick(claim) && !strict) {
    throw Error("would pass: it is what '" + variant + "' is compared with", place_of(node, "is"),
                "\"<\" or \">\", a factor, or another null");
  }
}

/// What a method says of itself is no claim where a metric says it from outside.
void require_outside(const std::string& quantity, const Topic& topic, const TomlNode& node) {
  if (!quantity.starts_with("diagnostic:")) return;
  const DiagnosticEntry* diagnostic = find_diagnostic(topic, quantity.substr(11));
  if (diagnostic == nullptr || diagnostic->metric.empty()) return;
  throw Error("'" + quantity + "' is what the method says of itself", place_of(node, "metric"),
              "the metric '" + diagnostic->metric + "', which measures it from outside");
}

void complete(ClaimSpec& claim, const Topic& topic, const KnownNames& names,
              const std::map<std::string, Tolerance>& tolerances,
              const std::vector<StudySpec>& studies, const TomlNode& node) {
  const StudySpec* study = study_of(claim, studies);
  const std::string& quantity = study != nullptr ? study->quantity : claim.metric;
  require_outside(quantity, topic, node);
  const MetricEntry* metric = find_metric(topic, quantity);
  if (quantity.starts_with("timing:")) claim.exempt = Exemption::timing;
  if (metric != nullptr && metric->oracle) claim.exempt = Exemption::oracle;
  // The slope or the spread of a metric has another unit than it has.
  if (metric != nullptr && study == nullptr) {
    const auto own = tolerances.find(metric->name);
    claim.metric_tolerance = own == tolerances.end() ? metric->tolerance : own->second;
  }
  // Without a null that --variant left out the claim is decided, and nothing is said of its worth.
  if (claim.null && !runs(*claim.null, names, place_of(node, "null"))) claim.null.reset();
  if (!claim.null) return;
  const bool compares = metric != nullptr && group_of(topic, *metric).needs_reference;
  require_null(claim, study != nullptr ? study->variant : claim.variant,
               compares ? metric : nullptr, names, node);
}

/// The value that a claim judges, and what it is held against.
auto number_of(const ClaimSpec& claim) {
  return std::tie(claim.metric, claim.variant, claim.of, claim.value, claim.is, claim.factor,
                  claim.offset, claim.at_parameter, claim.reduce, claim.of_reduce);
}

/// No claim says in other words, or of other cases, what another says: it is decided in all cases.
void require_own_claim(const ClaimSpec& claim, const std::vector<ClaimSpec>& before,
                       const TomlNode& node) {
  for (const ClaimSpec& other : before) {
    if (other.text == claim.text) {
      throw Error("two claims say '" + claim.text + "'", place_of(node, "text"),
                  "texts of their own");
    }
    if (number_of(other) != number_of(claim)) continue;
    throw Error("'" + other.text + "' claims the same of the same number", place_of(node, "metric"),
                "one claim, which is decided in every case");
  }
}

/// Whether a sweep runs the variant under further seeds, for claims alone.
bool runs_under_seeds(const TomlNode& root, const std::string& variant) {
  for (const TomlNode& node : tables_of(root, "sweep")) {
    const SweepTable sweep = read_sweep_table(node);
    const bool has = sweep.variants.empty() || contains(sweep.variants, variant);
    if (sweep.key == "seed" && sweep.claims_only && has) return true;
  }
  return false;
}

/// What is drawn by chance is decided over its seeds, not by the one of the file.
void require_seeds(const ClaimSpec& claim, const TomlNode& root, const Topic& topic,
                   const TomlNode& node) {
  if (claim.over == ClaimOver::seed || has_prefix(claim.metric)) return;
  const MetricEntry* row = find_metric(topic, claim.metric);
  if (row == nullptr || row->oracle || !runs_under_seeds(root, claim.variant)) return;
  throw Error("'" + claim.variant + "' runs under further seeds, and one would decide the claim",
              place_of(node, "over"), "over = \"seed\"");
}

/// False where --variant left out what the claim is about; throws for a mistake of the file.
bool is_decidable(const ClaimSpec& claim, const TomlNode& root, const Topic& topic,
                  const KnownNames& names, const TomlNode& node) {
  bool decidable = true;
  if (claim.metric.starts_with("study:") && !contains(names.studies, claim.metric.substr(6))) {
    // A study about a variant that --variant left out is no mistake of the file.
    for (const TomlNode& study : tables_of(root, "study")) {
      const TomlNode* name = study.find("name");
      if (name != nullptr && name->text == claim.metric.substr(6)) decidable = false;
    }
  }
  if (decidable) require_metric(claim.metric, topic, place_of(node, "metric"), names.studies);
  if (!claim.variant.empty()) {
    decidable = runs(claim.variant, names, place_of(node, "variant")) && decidable;
  }
  if (claim.of) decidable = runs(*claim.of, names, place_of(node, "of")) && decidable;
  return decidable;
}

}  // namespace

std::vector<ClaimSpec> read_claims(const TomlNode& root, const Topic& topic,
                                   const KnownNames& names,
                                   const std::map<std::string, Tolerance>& tolerances,
                                   const std::vector<StudySpec>& decided_studies) {
  std::vector<ClaimSpec> claims;
  for (const TomlNode& node : tables_of(root, "claim")) {
    TomlNode plain = node;
    plain.erase("at");
    ClaimTable table;
    read_options(plain, "claim", table);
    ClaimSpec claim = claim_of(table, node);
    read_except(table, node, names, claim);
    const Names variants = variants_of(table, node, names);
    if (variants.empty()) continue;
    claim.variants = table.variants;
    std::vector<ClaimSpec> made;
    for (const std::string& variant : variants) {
      claim.variant = variant;
      require_sides(claim, node);
      require_own_claim(claim, claims, node);
      require_seeds(claim, root, topic, node);
      if (!is_decidable(claim, root, topic, names, node)) continue;
      made.push_back(claim);
      complete(made.back(), topic, names, tolerances, decided_studies, node);
    }
    claims.insert(claims.end(), made.begin(), made.end());
  }
  return claims;
}

namespace {

/// Of a study of the kind "pooled": its quantity of events. @throws Error  where it needs more
std::function<std::optional<double>(const std::vector<Event>&)> pooled_quantity(
    const StudyTable& table, const Topic& topic, const TomlNode& node) {
  if (table.kind != StudyKind::pooled) return {};
  Names pooled;
  for (const MetricGroup& group : topic.metrics) {
    for (std::size_t i = 0; group.of_events && i < group.rows.size(); ++i) {
      pooled.push_back(group.rows[i].name);
      if (pooled.back() != table.quantity) continue;
      return [of_events = group.of_events, i](const std::vector<Event>& events) {
        return of_events(events).at(i);
      };
    }
  }
  throw Error("'" + table.quantity + "' is not measured of events alone",
              place_of(node, "quantity"),
              pooled.empty() ? "another kind: topic " + topic.name + " has no such metric"
                             : allowed_names(table.quantity, pooled));
}

/// What only one kind of study has: `of` of "within-spread" and "matched", quality and rivals of
/// "matched".
void require_members(const StudyTable& table, const Topic& topic, const TomlNode& node) {
  const bool matched = table.kind == StudyKind::matched;
  const bool compares = table.kind == StudyKind::within_spread;
  if (!matched && compares != table.of.has_value()) {
    throw Error(compares ? "is missing" : "has no meaning for this kind", place_of(node, "of"),
                "the variant whose spread is the yardstick, for kind = \"within-spread\"");
  }
  if (matched != table.match.has_value()) {
    throw Error(matched ? "is missing" : "has no meaning for this kind", place_of(node, "match"),
                "the metric in which rivals are to be equal, for kind = \"matched\"");
  }
  if (matched == table.families.empty()) {
    throw Error(matched ? "is missing" : "has no meaning for this kind", place_of(node, "families"),
                "[{ variants = […] }, …], from coarse to fine, for kind = \"matched\"");
  }
  if (table.keep.has_value() != table.keep_within.has_value() || (!matched && table.keep)) {
    throw Error(matched ? "is missing" : "has no meaning for this kind",
                place_of(node, table.keep ? "keep_within" : "keep"),
                "`keep`, a metric, and `keep_within`, a number, for kind = \"matched\"");
  }
  if (!matched) return;
  require_metric(*table.match, topic, place_of(node, "match"), {});
  for (const FamilyTable& family : table.families) {
    if (!family.variants.empty()) continue;
    throw Error("has no members", place_of(node, "families"), "variants from coarse to fine");
  }
  if (!table.keep) return;
  const MetricEntry* kept = find_metric(topic, *table.keep);
  if (kept == nullptr || kept->direction == Direction::none) {
    throw Error("'" + *table.keep + "' has no better and worse", place_of(node, "keep"),
                "a metric with a direction");
  }
}

/// False when --variant left one of the study's variants out.
bool all_run(const StudyTable& table, const KnownNames& names, const TomlNode& node) {
  bool all = runs(table.variant, names, place_of(node, "variant"));
  if (table.of) all = runs(*table.of, names, place_of(node, "of")) && all;
  for (const FamilyTable& family : table.families) {
    for (const std::string& member : family.variants)
      all = runs(member, names, place_of(node, "families")) && all;
  }
  return all;
}

/// Most frames of a figure, each a row or a column of panels.
constexpr double kMostFigureFrames = 100;

/// What a figure and a row of another part over or under it may ask for.
void require_target_and_frames(const std::vector<double>& target,
                               const std::vector<double>& parameters, const TomlNode& node) {
  if (!target.empty() && target.size() != 3) {
    throw Error("has " + std::to_string(target.size()) + " elements", place_of(node, "target"),
                "an array of 3 numbers");
  }
  require_count(static_cast<double>(parameters.size()), "frames of a figure", kMostFigureFrames,
                place_of(node, "parameters"));
}

}  // namespace

std::vector<StudySpec> read_studies(const TomlNode& root, const Topic& topic,
                                    const KnownNames& names) {
  std::vector<StudySpec> studies;
  Names seen;
  for (const TomlNode& node : tables_of(root, "study")) {
    StudyTable table;
    read_options(node, "study", table);
    require_text_name(table.name, "a study", place_of(node, "name"));
    if (contains(seen, table.name)) {
      throw Error("two studies are called '" + table.name + "'", place_of(node, "name"),
                  "names of their own");
    }
    seen.push_back(table.name);
    require_cases(table.cases, names, node);
    if (table.quantity.starts_with("study:")) {
      throw Error("a study of a study", place_of(node, "quantity"), "a metric");
    }
    require_metric(table.quantity, topic, place_of(node, "quantity"), {});
    for (const auto& [reduce, key] :
         {std::pair(table.reduce, "reduce"), std::pair(table.match_reduce, "match_reduce")}) {
      if (reduce != Reduction::every) continue;
      throw Error("a study needs one value a case", place_of(node, key),
                  "max, min, median, p95, p99, mean, sum, last");
    }
    const bool slope = table.kind == StudyKind::exponent || table.kind == StudyKind::order;
    if (slope && !table.against) {
      throw Error("is missing", place_of(node, "against"),
                  "a fact of the scene or a swept key, the x of the slope");
    }
    require_members(table, topic, node);
    auto of_events = pooled_quantity(table, topic, node);
    if (!all_run(table, names, node)) continue;
    studies.push_back({table.name, table.kind, table.variant, table.quantity,
                       table.against.value_or(""), table.reduce, table.cases, table.finer,
                       table.of.value_or(""), std::move(of_events), table.match.value_or(""),
                       table.match_reduce});
    for (const FamilyTable& family : table.families)
      studies.back().families.push_back(family.variants);
    if (!table.keep) continue;
    studies.back().keep = *table.keep;
    studies.back().keep_direction = find_metric(topic, *table.keep)->direction;
    studies.back().keep_within = *table.keep_within;
  }
  return studies;
}

std::map<std::string, Tolerance> read_tolerances(const TomlNode& root, const Topic& topic) {
  std::map<std::string, Tolerance> tolerances;
  const TomlNode* table = root.find("tolerance");
  if (table == nullptr) return tolerances;
  Names names = metric_names(topic);
  for (const TomlNode& study : tables_of(root, "study")) {
    if (const TomlNode* name = study.find("name")) names.push_back("study:" + name->text);
  }
  for (std::size_t i = 0; i < table->keys.size(); ++i) {
    const std::string& metric = table->keys[i];
    const TomlNode& node = table->items[i];
    if (!contains(names, metric)) {
      throw Error("unknown metric '" + metric + "'", node.place + ": tolerance",
                  allowed_names(metric, names));
    }
    ToleranceTable read;
    read_options(node, "tolerance." + metric, read);
    tolerances[metric] = {read.absolute, read.relative};
  }
  return tolerances;
}

FigureView read_figure_view(const TomlNode& root, const Topic& topic) {
  FigureViewTable table(topic.view);
  FigureView& view = table.view;
  if (const TomlNode* node = root.find("figure_view")) {
    for (const char* key : {"target", "direction", "up", "height_m"}) {
      if (node->find(key) != nullptr) view.camera_is_free = false;
    }
    // The topic's classes are those of its own array.
    if (node->find("color_by") != nullptr) view.classes.clear();
    TomlNode plain = *node;
    plain.erase("at");
    read_options(plain, "figure_view", table);
    read_at(node->find("at"), view.at_parameter, nullptr);
    require_target_and_frames(table.target, view.parameters, *node);
    for (const auto& [key, row] :
         {std::pair{"above", view.above}, std::pair{"below", view.below}}) {
      const TomlNode* table_of_row = node->find(key);
      if (row && table_of_row != nullptr)
        require_target_and_frames(row->target, row->parameters, *table_of_row);
    }
    if (view.color_by && view.color_by->empty()) view.color_by.reset();
    if (!view.classes.empty() && !view.color_by) {
      throw Error("names the values of no array", place_of(*node, "classes"), "with `color_by`");
    }
    for (const std::string& name : view.pattern) {
      if (contains(view.overlays, name)) continue;
      throw Error("'" + name + "' is not drawn over the sheet", place_of(*node, "pattern"),
                  allowed_names(name, view.overlays));
    }
    if (view.expected && (view.pattern.empty() || view.expected->points.size() < 2)) {
      throw Error("is no curve in a pattern", place_of(*node, "expected"),
                  "at least two points, with `pattern`");
    }
  }
  view.target.reset();
  if (table.target.size() == 3) view.target = {table.target[0], table.target[1], table.target[2]};
  return view;
}

}  // namespace geoprior
