#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/embryo/queries/queries.h"

namespace geoprior::embryo {

/// What the viewer's queries ask about; names are local names of our namespace.
struct ViewerQuestion {
  double day = 44;
  std::string structure = "LeftMetanephros";
  std::string system = "UrinarySystem";
};

inline constexpr int kViewerQueries = 8;

/// Names of a query's columns. @param query  1 to 8
std::span<const std::string_view> query_columns(int query);

/// The rows of a query as texts, sorted: IRIs and literals as they are written, blank nodes as
/// "_:label", nothing where nothing is said. One form for all queries, to compare engines by.
///
/// @param query  1 to 8
/// @throws Error  for another number
std::vector<std::vector<std::string>> query_rows(const ViewerQueries& queries, int query,
                                                 const ViewerQuestion& question);

}  // namespace geoprior::embryo
