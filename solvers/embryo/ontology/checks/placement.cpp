#include <Eigen/Geometry>
#include <algorithm>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

constexpr double kLeastSine = 1e-6;  ///< of the angle between an axis and `up`

void check_directions(Term geometry, Findings& findings) {
  const std::optional<Eigen::Vector3d> axis = findings.graph().vector(geometry, "axis");
  const std::optional<Eigen::Vector3d> up = findings.graph().vector(geometry, "up");
  if (!axis || !up || axis->norm() == 0 || up->norm() == 0) return;
  if (axis->normalized().cross(up->normalized()).norm() < kLeastSine)
    findings.add("axis_parallel_to_up", geometry,
                 "the axis and the up of " + findings.quoted(geometry) + " are parallel", "up");
}

/// An end is on a structure, at coordinates of it, or at a point.
void check_end(Term duct, const std::string& end, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  const bool is_on = graph.has(duct, end + "sOn");
  const bool is_free = graph.has(duct, end + "Point");
  if (!is_on && !is_free)
    findings.add("duct_without_end", duct,
                 findings.quoted(duct) + " has neither " + end + "sOn nor " + end + "Point");
  if (is_on && is_free)
    findings.add("duct_with_two_ends", duct,
                 findings.quoted(duct) + " has both " + end + "sOn and " + end + "Point",
                 end + "Point");
  if (is_on && !graph.has(duct, end + "At"))
    findings.add("missing_property", duct, findings.quoted(duct) + " has no " + end + "At");
}

/// What a geometry is placed on must be there, when its own structure is.
void check_supports(const Chronology& chronology, const FoundKey& key, Findings& findings) {
  const auto own = chronology.lifetimes.find(key.structure);
  if (own != chronology.lifetimes.end() && !own->second.has(key.order)) return;
  for (const std::string_view property : {"frame", "startsOn", "endsOn"}) {
    const std::optional<Term> support = findings.graph().reference(key.geometry, property);
    if (!support) continue;
    const auto lifetime = chronology.lifetimes.find(*support);
    if (lifetime != chronology.lifetimes.end() && !lifetime->second.has(key.order))
      findings.add("placed_on_absent", key.geometry,
                   findings.quoted(key.geometry) + " is placed on " + findings.quoted(*support) +
                       ", which does not exist at its stage",
                   property);
  }
}

void check_primitives(const Chronology& chronology, Term structure, Findings& findings) {
  for (const std::optional<Term>& set : chronology.sets) {
    std::optional<int> first;
    for (const FoundKey& key : chronology.keys_of(structure, set)) {
      const int found = findings.graph().class_of(key.geometry);
      if (found < 0 || vocabulary_classes()[found].abstract) continue;
      if (!first) first = found;
      if (found == *first) continue;
      findings.add("primitive_changes", key.node,
                   findings.quoted(structure) + " is " +
                       with_article(vocabulary_classes()[*first].name) + ", and " +
                       with_article(vocabulary_classes()[found].name) + " in " +
                       findings.quoted(key.node));
      return;
    }
  }
}

/// Where what is relative to the one structure is placed, the other must be placed first.
void check_cycles_of_placement(const Chronology& chronology, Findings& findings) {
  std::map<Term, std::string_view> reported;
  for (const std::optional<Term>& set : chronology.sets) {
    std::map<Term, std::vector<Term>> frames, all;
    for (const auto& entry : chronology.keys) {
      for (const FoundKey& key : chronology.keys_of(entry.first, set)) {
        for (const std::string_view property : {"frame", "startsOn", "endsOn"}) {
          const std::optional<Term> support = findings.graph().reference(key.geometry, property);
          if (!support) continue;
          all[key.structure].push_back(*support);
          if (property == "frame") frames[key.structure].push_back(*support);
        }
      }
    }
    for (auto [edges, kind] :
         {std::pair{&frames, "frame_cycle"}, std::pair{&all, "anchor_cycle"}}) {
      for (const std::vector<Term>& cycle : cycles_of(*edges)) {
        if (!reported.try_emplace(cycle.front(), kind).second) continue;
        std::string path;
        for (const Term node : cycle) path += findings.quoted(node) + ", ";
        findings.add(kind, cycle.front(),
                     "each is placed on the next one: " + path + "and again " +
                         findings.quoted(cycle.front()));
      }
    }
  }
}

}  // namespace

void check_placement(const Chronology& chronology, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  for (const Term geometry : graph.instances("GeometricalComponent")) {
    check_directions(geometry, findings);
    if (!graph.is_a(geometry, "Duct")) continue;
    check_end(geometry, "start", findings);
    check_end(geometry, "end", findings);
  }
  for (const auto& [structure, keys] : chronology.keys) {
    for (const FoundKey& key : keys) check_supports(chronology, key, findings);
    check_primitives(chronology, structure, findings);
  }
  check_cycles_of_placement(chronology, findings);
}

}  // namespace geoprior::embryo
