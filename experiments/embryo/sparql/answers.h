#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "solvers/embryo/queries/rows.h"

namespace geoprior::embryo {

/// The rows of a CSV text (RFC 4180) below its names, sorted.
std::vector<std::vector<std::string>> sorted_csv_rows(std::string_view csv);

/// A query of experiments/embryo/queries that asks another question: the constants of
/// `BIND (… AS ?day)`, `VALUES ?structure { … }` and `VALUES ?system { … }`, where it has these.
std::string with_question(std::string query, const ViewerQuestion& question);

}  // namespace geoprior::embryo
