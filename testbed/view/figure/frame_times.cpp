#include "testbed/view/figure/frame_times.h"

#include <algorithm>

#include "testbed/runner/options/quantity.h"

namespace geoprior {

const CaseRecord* first_drawn_case(const RunRecord& record, const FigureView& view) {
  for (const CaseRecord& c : record.cases) {
    const auto& wanted = view.cases;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), c.name) != wanted.end()) {
      return &c;
    }
  }
  return nullptr;
}

std::vector<const VariantRecord*> drawn_variants(const CaseRecord& of, const FigureView& view) {
  std::vector<const VariantRecord*> drawn;
  for (const VariantRecord& variant : of.variants) {
    const auto& wanted = view.variants;
    const bool is_wanted =
        wanted.empty() || std::find(wanted.begin(), wanted.end(), variant.name) != wanted.end();
    if (is_wanted && !is_null_control(variant.role)) drawn.push_back(&variant);
  }
  return drawn;
}

std::vector<double> frame_parameters(const RunRecord& record, const FigureView& view) {
  std::vector<double> parameters;
  const CaseRecord* c = first_drawn_case(record, view);
  if (c == nullptr) return parameters;
  for (const VariantRecord* variant : drawn_variants(*c, view)) {
    for (const FrameRecord& frame : variant->frames) parameters.push_back(frame.parameter);
  }
  std::sort(parameters.begin(), parameters.end());
  parameters.erase(std::unique(parameters.begin(), parameters.end(), same_parameter),
                   parameters.end());
  return parameters;
}

std::vector<double> evenly_chosen(const std::vector<double>& parameters, int count) {
  const std::size_t wanted = std::max(count, 1);
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
  sheet.labels.clear();
  sheet.plain = false;
  sheet.above.reset();
  sheet.below.reset();
  if (const CaseRecord* c = first_drawn_case(record, view)) sheet.cases = {c->name};
  return sheet;
}

}  // namespace geoprior
