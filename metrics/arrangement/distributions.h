#pragma once

#include <optional>
#include <span>

namespace geoprior {

/// Kolmogorov and Smirnov's distance of two samples: the largest difference of the shares of them
/// that are at most x, over all x. 0 for the same shares of the same values, 1 where all of one
/// are under all of the other; absent where one is empty.
///
/// Two samples of n and m values of one distribution differ by about sqrt(1/n + 1/m).
std::optional<double> kolmogorov_smirnov(std::span<const double> first,
                                         std::span<const double> second);

}  // namespace geoprior
