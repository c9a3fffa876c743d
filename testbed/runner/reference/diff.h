#pragma once

#include <limits>
#include <string>
#include <vector>

#include "testbed/runner/reference/reference.h"

namespace geoprior {

/// A reference value before and after a blessing.
struct ReferenceChange {
  enum class Kind { moved, added, removed };
  Kind kind = Kind::moved;
  std::string case_name;
  std::string variant;
  std::string metric;
  std::string unit;
  double before = std::numeric_limits<double>::quiet_NaN();
  double after = std::numeric_limits<double>::quiet_NaN();
  double tolerances =
      0;  ///< |after - before| in tolerances of the metric; infinite with tolerance 0
};

/// What differs between two sets: moved values first, the farthest on top, then those that came and
/// those that went.
std::vector<ReferenceChange> changes_of(const ReferenceSet& before, const ReferenceSet& after,
                                        const Gates& gates);

/// A line a moved value, "metric, variant, case: before -> after unit (n tolerances)", at most
/// `most` of them; the number of the others, of added and of removed values, by metric.
std::vector<std::string> difference_lines(const std::vector<ReferenceChange>& changes,
                                          std::size_t most);

}  // namespace geoprior
