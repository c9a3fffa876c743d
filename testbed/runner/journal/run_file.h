#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// The texts of a run that are root attributes of run.h5; any further one is provenance.
inline constexpr std::array<std::pair<std::string_view, std::string RunRecord::*>, 9> kRootTexts{{
    {"experiment_id", &RunRecord::experiment_id},
    {"title", &RunRecord::title},
    {"figure", &RunRecord::figure},
    {"topic", &RunRecord::topic},
    {"experiment", &RunRecord::experiment_toml},
    {"spec_hash", &RunRecord::spec_hash},
    {"content_sha256", &RunRecord::content_sha256},
    {"frames_sha256", &RunRecord::frames_sha256},
    {"metrics_sha256", &RunRecord::metrics_sha256},
}};

/// As `write_run_file(record, file)`, with the tables of the frames, which are read from
/// `run_folder`. Throws Error naming the table's file that is missing or damaged.
void write_run_file(const RunRecord& record, const std::filesystem::path& file,
                    const std::filesystem::path& run_folder);

}  // namespace geoprior
