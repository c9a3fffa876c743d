#pragma once

#include <functional>
#include <string>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// The text whose SHA-256 is `content_sha256`: frames, events, artifacts, metrics and summaries in
/// canonical order (docs/file-formats.md); no times, no thread counts, no folders.
std::string content_text(const RunRecord& record);

std::string content_sha256(const RunRecord& record);

/// The same of its halves: what the methods made (frames, events, artifacts), and what was measured
/// of it (metrics, summaries).
std::string frames_sha256(const RunRecord& record);
std::string metrics_sha256(const RunRecord& record);

/// What a variant came to beside its frames' files: events, artifacts, and those metrics and
/// summaries that count. It names neither the variant nor its case, so that two variants with the
/// same results have the same text.
std::string outcome_text(const VariantRecord& variant,
                         const std::function<bool(const std::string& name)>& counts);

/// Sets all three of the record.
void set_hashes(RunRecord& record);

}  // namespace geoprior
