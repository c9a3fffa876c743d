#pragma once

#include <stdexcept>
#include <string>

namespace geoprior {

/// The one exception of the testbed: what is wrong, where, and what would be allowed.
///
/// `where` is a file with line, or an element ("vertex 12", "joint 'knee-left'"). The command line
/// prints `what()` and exits with 2; anything that is not an Error is a defect of ours and exits
/// with 3.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& problem, const std::string& where = {},
                 const std::string& allowed = {})
      : std::runtime_error((where.empty() ? "" : where + ": ") + problem +
                           (allowed.empty() ? "" : " (allowed: " + allowed + ")")) {}
};

/// A method that a scene is not for: nothing is wrong with either. Of a run it ends the variant
/// only, and the others run.
class NotApplicable : public Error {
 public:
  using Error::Error;
};

}  // namespace geoprior
