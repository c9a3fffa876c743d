#pragma once

#include <string>

namespace geoprior::sketch {

/// A number for a file that programs of others read: plain decimals with at most `decimals` places,
/// a point whatever the locale, no exponent, no "-0".
///
/// @param x  finite, below 1e15
std::string written_number(double x, int decimals = 5);

}  // namespace geoprior::sketch
