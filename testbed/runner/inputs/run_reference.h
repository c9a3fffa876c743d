#pragma once

#include <string>

namespace geoprior {

/// A text option "run:<experiment id>/<variant>" or "run:<experiment id>/<case>/<variant>"; the id
/// has two parts, "fluid/boat-wake". "#<file>" behind it means an artifact of the variant.
struct RunReference {
  std::string experiment_id;
  std::string case_name = "default";
  std::string variant;
  std::string artifact;  ///< empty: the frames
};

bool is_run_reference(const std::string& text);
/// @throws Error  when the text has not three or four parts, or no file name behind "#"
RunReference parse_run_reference(const std::string& text);

}  // namespace geoprior
