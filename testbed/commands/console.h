#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "testbed/streams.h"

namespace geoprior {

/// Words for people go to stderr (`say`), coloured on a terminal only; JSON for programs goes to
/// stdout.

enum class Tint { good, bad, strong, faint };
/// The text in a colour when stderr is a terminal (and NO_COLOR is not set).
std::string tinted(const std::string& text, Tint tint);

/// Rows of cells, columns aligned; the first row is a heading.
void say_table(const std::vector<std::vector<std::string>>& rows, const std::string& indent = "  ");

void print_json(const nlohmann::ordered_json& json);

/// The number, or null where it is none: JSON has no NaN and no infinities.
nlohmann::ordered_json json_number(double x);

}  // namespace geoprior
