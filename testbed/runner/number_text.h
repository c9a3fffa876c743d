#pragma once

#include <string>

namespace geoprior {

/// The shortest text that reads back as the same double: "0.1", "25", "1e-12", "nan".
std::string number_text(double x);

/// Rounded to so many significant digits, for people.
std::string rounded_text(double x, int digits = 4);

}  // namespace geoprior
