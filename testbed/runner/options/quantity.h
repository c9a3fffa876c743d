#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/terms.h"

namespace geoprior {

/// A number of one variant with its unit.
struct Quantity {
  double value = 0;
  std::string unit;
};

/// Value of a metric, "timing:<phase>" (median over repetitions) or "diagnostic:<name>" of a
/// variant: at one parameter, or reduced over the frames. Metrics of a sequence have one
/// value and take neither.
///
/// @throws Error  when the run has no such quantity, no such frame, or no value there
Quantity quantity_of(const CaseRecord& in, const VariantRecord& variant, const std::string& name,
                     std::optional<double> at_parameter, Reduction reduce);

/// The value of a metric of frames, of a diagnostic or of a timed phase at the frame of that
/// parameter; absent when there is no such frame, or no value there.
/// @throws Error  when the run has no such quantity of frames
std::optional<double> value_at(const CaseRecord& in, const VariantRecord& variant,
                               const std::string& name, double parameter);

/// The values that are there, reduced; NaN where there are none.
/// @throws Error  for `every`, which is no number
double reduced(std::vector<double> values, Reduction how);

/// Parameters are the same frame when they differ by at most 1e-9 of their size.
bool same_parameter(double a, double b);

}  // namespace geoprior
