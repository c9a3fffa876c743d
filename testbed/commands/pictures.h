#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

struct Pictures {
  std::optional<std::filesystem::path> figure;
  std::vector<std::filesystem::path> spectrograms;  ///< of a run with sound, one a drawn case
  std::optional<std::filesystem::path> summary;
  std::optional<std::filesystem::path> report;
  std::string error;  ///< what kept the rest from being made; the run itself is complete
};

/// figure.png, spectrograms of a run with sound, metrics.svg, summary.md and report.html in the
/// folder of a run.
Pictures make_pictures(const std::filesystem::path& run_folder, const FigureView& view);

/// One page about several runs. @throws Error  as run_python does
void make_report(const std::vector<std::filesystem::path>& run_folders,
                 const std::filesystem::path& page, Unverified unverified = Unverified::refused);

/// One page about all records in results/published. @throws Error  as run_python does
void make_published_report(const std::filesystem::path& page);

}  // namespace geoprior
