#include "testbed/view/frame_times.h"

#include <algorithm>

#include "testbed/runner/quantity.h"

namespace geoprior {
namespace {

/// The first case that is drawn; null when the run has none of them.
const CaseRecord* first_case(const RunRecord& record, const FigureView& view) {
  for (const CaseRecord& c : record.cases) {
    const auto& wanted = view.cases;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), c.name) != wanted.end()) {
      return &c;
    }
  }
  return nullptr;
}

bool is_drawn(const VariantRecord& variant, const FigureView& view) {
  if (is_null_control(variant.role)) return false;
  return view.variants.empty() ||
         std::find(view.variants.begin(), view.variants.end(), variant.name) != view.variants.end();
}

}  // namespace

std::vector<double> frame_parameters(const RunRecord& record, const FigureView& view) {
  std::vector<double> parameters;
  const CaseRecord* c = first_case(record, view);
  if (c == nullptr) return parameters;
  for (const VariantRecord& variant : c->variants) {
    if (!is_drawn(variant, view)) continue;
    for (const FrameRecord& frame : variant.frames) parameters.push_back(frame.parameter);
  }
  std::sort(parameters.begin(), parameters.end());
  parameters.erase(std::unique(parameters.begin(), parameters.end(), same_parameter),
                   parameters.end());
  return parameters;
}

std::vector<double> evenly_chosen(const std::vector<double>& parameters, int count) {
  const auto wanted = static_cast<std::size_t>(std::max(count, 1));
  if (parameters.size() <= wanted) return parameters;
  std::vector<double> chosen;
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t last = parameters.size() - 1;
    chosen.push_back(parameters[wanted == 1 ? last : (i * last + (wanted - 1) / 2) / (wanted - 1)]);
  }
  return chosen;
}

FigureView contact_sheet_view(const RunRecord& record, const FigureView& view) {
  FigureView sheet = view;
  sheet.at_parameter.reset();
  sheet.parameters = evenly_chosen(frame_parameters(record, view), view.contact_sheet);
  sheet.across = FigureView::Across::states;
  sheet.section.reset();
  sheet.plain = false;
  sheet.above.reset();
  sheet.below.reset();
  if (const CaseRecord* c = first_case(record, view)) sheet.cases = {c->name};
  return sheet;
}

}  // namespace geoprior
