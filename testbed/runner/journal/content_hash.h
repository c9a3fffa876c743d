#pragma once

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

/// Sets all three of the record.
void set_hashes(RunRecord& record);

}  // namespace geoprior
