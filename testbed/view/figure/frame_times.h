#pragma once

#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// The case whose frames are drawn one by one: the view's first; null when the run has none of
/// them.
const CaseRecord* first_drawn_case(const RunRecord& record, const FigureView& view);

/// Its variants that the view draws, in the order of the experiment.
std::vector<const VariantRecord*> drawn_variants(const CaseRecord& of, const FigureView& view);

/// Parameters at which some drawn variant of the view's first case has a frame, rising.
std::vector<double> frame_parameters(const RunRecord& record, const FigureView& view);

/// Chooses at most `count` of the parameters, evenly spaced, the first and the last among them.
std::vector<double> evenly_chosen(const std::vector<double>& parameters, int count);

/// The view of a contact sheet: frames of `view.contact_sheet` evenly spaced parameters side by
/// side, of one case, without further rows and labels.
FigureView contact_sheet_view(const RunRecord& record, const FigureView& view);

}  // namespace geoprior
