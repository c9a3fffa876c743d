#include <algorithm>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

void check_span(const Chronology& chronology, Term process, Findings& findings) {
  const std::optional<Term> from = findings.graph().reference(process, "from");
  const std::optional<Term> to = findings.graph().reference(process, "to");
  if (!from || !to || !chronology.order_of_stage.contains(*from) ||
      !chronology.order_of_stage.contains(*to))
    return;
  const int first = chronology.order_of_stage.at(*from), last = chronology.order_of_stage.at(*to);
  const std::string span = findings.quoted(process) + " goes from " + findings.quoted(*from) +
                           " to " + findings.quoted(*to);
  if (first > last)
    findings.add("process_span_reversed", process, span + ", which is before", "to");
  const bool takes_time =
      !findings.graph().is_a(process, "Interaction") && !findings.graph().is_a(process, "Fixation");
  if (first == last && takes_time)
    findings.add("process_span_empty", process, span + ": it needs two stages", "to");
}

void check_products(const Chronology& chronology, Term division, const std::vector<Term>& products,
                    Findings& findings) {
  const TypedGraph& graph = findings.graph();
  const std::optional<Term> positive = graph.reference(division, "positive");
  if (positive && std::ranges::find(products, *positive) == products.end())
    findings.add("division_positive_no_product", division,
                 findings.quoted(*positive) + " is no product of " + findings.quoted(division),
                 "positive");
  const std::optional<Term> to = graph.reference(division, "to");
  for (const Term product : products) {
    if (chronology.keys.contains(product))
      findings.add("product_with_keys", product,
                   findings.quoted(product) + " has keys, and its shape from the division " +
                       findings.quoted(division));
    const auto lifetime = chronology.lifetimes.find(product);
    if (lifetime == chronology.lifetimes.end() || !to || !chronology.order_of_stage.contains(*to))
      continue;
    if (lifetime->second.first != chronology.order_of_stage.at(*to))
      findings.add("product_begins_elsewhere", product,
                   findings.quoted(product) + " does not begin at " + findings.quoted(*to) +
                       ", to which " + findings.quoted(division) + " goes",
                   "existsFrom");
  }
}

void check_division(const Chronology& chronology, Term division, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  const int wholes = graph.values(division, "actsOn").size();
  if (wholes > 1)
    findings.add(
        "division_wholes", division,
        findings.quoted(division) + " divides " + std::to_string(wholes) + " structures, not one",
        "actsOn");
  const int products = graph.values(division, "produces").size();
  if (products != 2)
    findings.add(
        "division_products", division,
        findings.quoted(division) + " has " + std::to_string(products) + " products, not two",
        "produces");
  const std::vector<Term> known = graph.references(division, "produces");
  if (products == 2 && known.size() == 2) check_products(chronology, division, known, findings);
}

/// A condition on two structures, a fusion of two or more, or both.
void check_interaction(Term process, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  const int fused = graph.values(process, "fuses").size();
  if (fused == 1)
    findings.add("fusion_of_one", process,
                 findings.quoted(process) + " fuses one structure, not two or more", "fuses");
  const auto missing = [&](std::string_view name) {
    if (!graph.has(process, name))
      findings.add("missing_property", process,
                   findings.quoted(process) + " has no " + std::string(name));
  };
  if (fused > 0) missing("blend");
  const bool is_condition =
      graph.has(process, "inducer") || graph.has(process, "target") || graph.has(process, "within");
  if (fused > 0 && !is_condition) return;
  for (const std::string_view name : {"inducer", "target", "within"}) missing(name);
}

/// Only ducts have ends that can be fixed.
void check_fixation(const Chronology& chronology, Term process, Findings& findings) {
  for (const Term structure : findings.graph().references(process, "actsOn")) {
    const auto keys = chronology.keys.find(structure);
    if (keys == chronology.keys.end()) continue;
    const bool is_duct = std::ranges::any_of(keys->second, [&](const FoundKey& key) {
      const int found = findings.graph().class_of(key.geometry);
      return found < 0 || vocabulary_classes()[found].abstract ||
             vocabulary_classes()[found].name == "Duct";
    });
    if (!is_duct)
      findings.add(
          "fixation_without_duct", process,
          findings.quoted(process) + " fixes " + findings.quoted(structure) + ", which is no duct",
          "actsOn");
  }
}

}  // namespace

void check_processes(const Chronology& chronology, Findings& findings) {
  for (const Term process : findings.graph().instances("Process")) {
    check_span(chronology, process, findings);
    if (findings.graph().is_a(process, "Division")) check_division(chronology, process, findings);
    if (findings.graph().is_a(process, "Interaction")) check_interaction(process, findings);
    if (findings.graph().is_a(process, "Fixation")) check_fixation(chronology, process, findings);
  }
}

void check_diseases(Findings& findings) {
  const TypedGraph& graph = findings.graph();
  for (const Term disease : graph.instances("Disease")) {
    if (!graph.has(disease, "disables") && !graph.has(disease, "enables"))
      findings.add("disease_without_effect", disease,
                   findings.quoted(disease) + " disables and enables nothing");
    for (const Term process : graph.references(disease, "enables")) {
      if (graph.graph().contains(disease, graph.property("disables").value_or(-1), process))
        findings.add("disease_contradicts_itself", disease,
                     findings.quoted(disease) + " enables and disables " + findings.quoted(process),
                     "enables");
    }
  }
}

void check_measurements(Findings& findings) {
  const TypedGraph& graph = findings.graph();
  for (const Term node : graph.instances("Measurement")) {
    if (!graph.has(node, "low") && !graph.has(node, "high") && !graph.has(node, "mean"))
      findings.add("measurement_without_value", node,
                   findings.quoted(node) + " has no low, high or mean");
    const std::optional<double> low = graph.number(node, "low"), high = graph.number(node, "high");
    if (low && high && *low > *high)
      findings.add("measurement_reversed", node,
                   "the low of " + findings.quoted(node) + " is above its high", "low");
  }
}

}  // namespace geoprior::embryo
