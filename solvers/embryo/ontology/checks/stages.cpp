#include <algorithm>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

struct FoundStage {
  Term node;
  int order;
  double start, end;
};

std::vector<FoundStage> found_stages(const TypedGraph& graph) {
  std::vector<FoundStage> stages;
  for (const Term node : graph.instances("TemporalEntity")) {
    const std::optional<Term> order = graph.value(node, "order");
    const std::optional<double> start = graph.number(node, "startDay");
    const std::optional<double> end = graph.number(node, "endDay");
    if (!order || !start || !end || !is_integer(graph.graph().dictionary(), *order)) continue;
    stages.push_back(
        {node, static_cast<int>(*number_of(graph.graph().dictionary(), *order)), *start, *end});
  }
  return stages;
}

/// The first gap, and none where an order is repeated: that one may belong into it.
bool check_orders(std::vector<FoundStage> stages, Findings& findings) {
  const int before = findings.size();
  std::ranges::stable_sort(stages, {}, &FoundStage::order);
  const auto about = [&](const FoundStage& stage) {
    return findings.quoted(stage.node) + " (" + std::to_string(stage.order) + ")";
  };
  const FoundStage *gap_begin = nullptr, *gap_end = nullptr;
  for (std::size_t i = 1; i < stages.size(); ++i) {
    const FoundStage &last = stages[i - 1], &stage = stages[i];
    if (stage.order == last.order)
      findings.add("stage_order_repeated", stage.node,
                   "the stages " + about(last) + " and " + about(stage) + " have one order",
                   "order");
    if (gap_begin != nullptr || stage.order <= last.order + 1) continue;
    gap_begin = &last;
    gap_end = &stage;
  }
  if (gap_begin != nullptr && findings.size() == before)
    findings.add("stage_order_gap", gap_end->node,
                 "no stage is between " + about(*gap_begin) + " and " + about(*gap_end), "order");
  return findings.size() == before;
}

void check_next(const std::vector<FoundStage>& stages, Findings& findings) {
  for (const FoundStage& stage : stages) {
    const std::optional<Term> next = findings.graph().reference(stage.node, "next");
    if (!next) continue;
    const auto found = std::ranges::find(stages, *next, &FoundStage::node);
    if (found != stages.end() && found->order != stage.order + 1)
      findings.add("stage_next_against_order", stage.node,
                   findings.quoted(*next) + " does not follow " + findings.quoted(stage.node),
                   "next");
  }
}

}  // namespace

void check_stages(Findings& findings) {
  std::vector<FoundStage> stages = found_stages(findings.graph());
  const bool has_all = findings.graph().instances("TemporalEntity").size() == stages.size();
  const bool in_order = has_all && check_orders(stages, findings);
  if (in_order) check_next(stages, findings);
  std::ranges::stable_sort(stages, {}, &FoundStage::start);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const FoundStage& stage = stages[i];
    if (stage.start >= stage.end) {
      findings.add("stage_reversed", stage.node,
                   findings.quoted(stage.node) + " ends before it starts", "endDay");
    } else if (i + 1 < stages.size() && stage.end > stages[i + 1].start) {
      findings.add("stages_overlap", stages[i + 1].node,
                   findings.quoted(stages[i + 1].node) + " starts before " +
                       findings.quoted(stage.node) + " ends",
                   "startDay");
    } else if (i + 1 < stages.size() && in_order && stages[i + 1].order < stage.order) {
      findings.add("stage_order_against_days", stages[i + 1].node,
                   findings.quoted(stages[i + 1].node) + " has a lower order than " +
                       findings.quoted(stage.node) + " and starts later",
                   "order");
    }
  }
}

}  // namespace geoprior::embryo
