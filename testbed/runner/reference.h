#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "testbed/runner/run_record.h"
#include "testbed/runner/spec.h"

namespace geoprior {

/// One value that a metric had when it was blessed.
struct ReferenceValue {
  double value = 0;  ///< NaN: the metric had no value
  std::string unit;
  std::string reason;
  std::string commit;
};

/// Case, variant, summary name ("overlap_volume.max").
using ReferenceSet =
    std::map<std::string, std::map<std::string, std::map<std::string, ReferenceValue>>>;

/// results/reference/<id>.json: one set for full and one for quick runs. In the file a set names
/// reason, commit and units once; values that have others say so themselves.
struct Reference {
  std::map<std::string, ReferenceSet> sets;  ///< "full", "quick"
};

/// results/reference/<id>.json of the clone.
std::filesystem::path reference_file(const std::string& experiment_id);

/// Empty when there is no file. @throws Error  naming the file and what is damaged
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
};

/// How far each metric may be off: that of the experiment file, else of the metric table, by the
/// name before ".max".
using ToleranceOf = std::function<Tolerance(const std::string& summary_name)>;
ToleranceOf tolerances_of(const Experiment& experiment, const Topic& topic);

/// Every summary value of the run against the set: |value - reference| <= absolute + relative
/// |reference|. A change for the better is a mismatch too: reference values follow by `bless`, or
/// they would hide the next loss.
std::vector<Mismatch> compare_with_reference(const RunRecord& record, const ReferenceSet& reference,
                                             const ToleranceOf& tolerance_of);

/// The set that a run's values make. Values that are exactly as before keep their reason and
/// commit.
ReferenceSet bless_values(const RunRecord& record, const ReferenceSet& before,
                          const std::string& reason, const std::string& commit);

/// "experiment, case, variant, metric: problem: value …, reference …, tolerance …".
std::string mismatch_text(const std::string& experiment_id, const Mismatch& mismatch);

}  // namespace geoprior
