#include "solvers/embryo/state/development.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

void require_fit(const Ontology& ontology, const Effects& effects) {
  if (effects.inactive.size() == ontology.processes.size() &&
      effects.exists.size() == ontology.structures.size())
    return;
  throw Error("the effects are of " + std::to_string(effects.inactive.size()) + " processes and " +
                  std::to_string(effects.exists.size()) + " structures",
              "development",
              std::to_string(ontology.processes.size()) + " and " +
                  std::to_string(ontology.structures.size()));
}

void hold(std::optional<double>& held, double day) { held = std::min(held.value_or(day), day); }

/// What a process that was switched off leaves as it was.
void add_hold(BodyPlan& plan, const ProcessEntry& process, double from) {
  for (const int s : process.acts_on) {
    PlannedStructure& structure = plan.structures[s];
    if (process.kind == ProcessKind::growth) hold(structure.sizes_held, from);
    if (process.kind == ProcessKind::migration) hold(structure.place_held, from);
    if (process.kind == ProcessKind::fixation) hold(structure.ends_held, from);
  }
}

/// Processes that run in no body unless a disease wakes them: dormant ones, and what requires them.
std::vector<bool> sleeping(const Ontology& ontology, const Effects& effects) {
  std::vector<bool> asleep(ontology.processes.size(), false);
  for (bool more = true; more;) {
    more = false;
    for (std::size_t p = 0; p < asleep.size(); ++p) {
      const ProcessEntry& process = ontology.processes[p];
      if (asleep[p] || !effects.inactive[p]) continue;
      asleep[p] = process.dormant || std::any_of(process.requires_.begin(), process.requires_.end(),
                                                 [&](int needed) { return asleep[needed]; });
      more = more || asleep[p];
    }
  }
  return asleep;
}

void add_division(BodyPlan& plan, const ProcessEntry& process, const PlannedProcess& span) {
  PlannedDivision division;
  division.active = span.active;
  division.whole = process.acts_on[0];
  division.from = span.from;
  division.to = span.to;
  division.normal = process.normal;
  division.descent = process.descent;
  division.thickness = process.thickness;
  for (const int product : process.produces) {
    const bool first = product == process.positive.value_or(process.produces[0]);
    division.products.push_back({product, first ? 1.0 : -1.0});
  }
  plan.divisions.push_back(std::move(division));
}

/// What a process does.
void add_action(BodyPlan& plan, const ProcessEntry& process, const PlannedProcess& span) {
  if (process.kind == ProcessKind::rotation)
    for (const int s : process.acts_on)
      plan.structures[s].turns.push_back({process.about, process.angle, span.from, span.to});
  if (process.stops_at)
    for (const int s : process.acts_on) plan.structures[s].stops.push_back(*process.stops_at);
}

PlannedProcess planned(const Ontology& ontology, const ProcessEntry& process, bool active) {
  PlannedProcess out;
  out.active = active;
  out.from = ontology.stages[process.from_stage].middle();
  out.to = process.kind == ProcessKind::division ? ontology.stages[process.to_stage].start_day
                                                 : ontology.stages[process.to_stage].middle();
  out.from = std::min(out.from, out.to);
  out.interacts = process.kind == ProcessKind::interaction;
  out.inducer = process.inducer;
  out.target = process.target;
  out.within = process.within;
  out.fuses = process.fuses;
  out.blend = process.blend;
  return out;
}

}  // namespace

BodyPlan body_plan(const Ontology& ontology, const Effects& effects, const StateOptions& options) {
  require_fit(ontology, effects);
  BodyPlan plan;
  plan.stages = ontology.stages;
  plan.crown_rump_length = ontology.crown_rump_length;
  plan.interpolation = options.interpolation;
  for (std::size_t s = 0; s < ontology.structures.size(); ++s) {
    const Structure& structure = ontology.structures[s];
    PlannedStructure out;
    out.name = structure.name;
    out.keys = structure.keys;
    out.exists = effects.exists[s];
    plan.structures.push_back(std::move(out));
    if (structure.fused_with.empty()) continue;
    FusedGroup group{structure.fused_with, structure.blend};
    group.members.insert(group.members.begin(), static_cast<int>(s));
    plan.fused.push_back(std::move(group));
  }
  const std::vector<bool> asleep = sleeping(ontology, effects);
  for (std::size_t p = 0; p < ontology.processes.size(); ++p) {
    const ProcessEntry& process = ontology.processes[p];
    const bool active = !effects.inactive[p];
    plan.processes.push_back(planned(ontology, process, active));
    const PlannedProcess& span = plan.processes.back();
    if (process.kind == ProcessKind::division && !process.acts_on.empty())
      add_division(plan, process, span);
    if (active) add_action(plan, process, span);
    if (!active && !asleep[p]) add_hold(plan, process, span.from);
  }
  return plan;
}

Development::Development(const Ontology& ontology, const Effects& effects,
                         const StateOptions& options)
    : body_(body_plan(ontology, effects, options)) {}

}  // namespace geoprior::embryo
