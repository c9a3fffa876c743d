#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// The tables of one name of all frames of a variant, one below the other.
struct StackedTable {
  std::vector<std::string> columns;  ///< "frame" (index from 0), then "name [unit]" of the tables
  std::vector<double> values;        ///< rows x columns, row by row
};

/// Reads the tables of a variant's frames back from its run folder, by name. A column that only
/// some frames have is NaN in the others.
/// @throws Error  naming the file that is missing, damaged or no table
std::map<std::string, StackedTable> stacked_tables(const VariantRecord& variant,
                                                   const std::filesystem::path& run_folder);

}  // namespace geoprior
