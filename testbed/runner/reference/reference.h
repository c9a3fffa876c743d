#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "testbed/runner/reference/blessed.h"
#include "testbed/runner/reference/gates.h"

namespace geoprior {

/// results/reference/<id>.txt of the clone.
std::filesystem::path reference_file(const std::string& experiment_id);

/// Empty when there is no file.
/// @throws Error  naming the file, the line and what is wrong there: a file of an older form, one
/// that
///                is cut off, a row that is there twice
Reference read_reference(const std::filesystem::path& file);

/// Whole or not at all; the same reference gives the same bytes.
void write_reference(const Reference& reference, const std::filesystem::path& file);

/// A value that is not what it was.
struct Mismatch {
  std::string case_name;
  std::string variant;
  std::string metric;
  std::string problem;  ///< "changed for the worse", "has no reference value", "is gone", …
  double value = 0;
  double reference = 0;
  double tolerance = 0;  ///< |value - reference| that is allowed
  std::string unit;
  bool fails = true;  ///< false: a notice
};

/// Every gated value against the set: |value - reference| <= absolute + relative |reference|, and
/// no headline metric worse by more than `headline_limit`. A change for the better is a mismatch
/// too: reference values follow by `bless`, or they would hide the next loss. Of counted work only
/// more fails; less is a notice, and so is a metric that the set has nowhere.
std::vector<Mismatch> compare_with_reference(const GatedValues& now, const ReferenceSet& reference,
                                             const Gates& gates);

/// Of a run's frames, events and artifacts, and of its metrics.
ContentHash content_of(const RunRecord& record);

/// How the bytes of a run stand to those blessed.
enum class SameBytes { all, frames, none, incomparable };
SameBytes compare_bytes(const RunRecord& record, const ContentHash& blessed);

/// How many values there are.
std::size_t count_values(const GatedValues& values);

/// Leaves what a ContentHash does not cover: counted work, studies, shortfalls.
void keep_outside_content(GatedValues& values);
void keep_outside_content(ReferenceSet& values);

/// The value with as many digits (at most 9) as move it by no more than a tenth of its tolerance;
/// the value itself where 9 are too few.
double rounded_for(double value, const Tolerance& tolerance);

/// The set that a run's values make, rounded.
ReferenceSet bless_values(const GatedValues& now, const Gates& gates);

/// "experiment, case, variant, metric: problem: value …, reference …, tolerance …".
std::string mismatch_text(const std::string& experiment_id, const Mismatch& mismatch);

}  // namespace geoprior
