#pragma once

#include <string>
#include <vector>

#include "testbed/topic.h"

namespace geoprior {

/// The name of the method in every topic.
inline constexpr const char* kExternalMethod = "external";

/// Gives a topic the method whose frames come from outside: from files, or from a program that is
/// started for each case (docs/external-methods.md). Its diagnostics are added to the topic's.
void add_external_method(Topic& topic);

}  // namespace geoprior
