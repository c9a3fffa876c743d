#pragma once

#include <functional>
#include <string>

#include "testbed/topic.h"

namespace geoprior {

/// Copies every option of `from` into `to`, a set of the same type, and passes each text through
/// `on_text` (what it returns is stored).
void copy_options(const OptionSet& from, OptionSet& to,
                  const std::function<std::string(const std::string&)>& on_text);

}  // namespace geoprior
