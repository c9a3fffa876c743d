#pragma once

#include <array>
#include <string>
#include <string_view>

namespace geoprior {

/// The words of claims and studies: read from a file once, enumerators from there on.

enum class Comparison { less_equal, less, greater_equal, greater, equal };
inline constexpr std::array<std::string_view, 5> kComparisons{"<=", "<", ">=", ">", "=="};

/// Of the values of all frames, those without a value left out. `every` is no number: the claim
/// must hold at each frame.
enum class Reduction { max, min, median, p95, p99, mean, sum, last, every };
inline constexpr std::array<std::string_view, 9> kReductions{"max",  "min", "median", "p95",  "p99",
                                                             "mean", "sum", "last",   "every"};

/// `exponent`: slope of log y against log x; `order`: observed order of convergence; `spread`:
/// standard deviation; `within_spread`: distance of the medians of two variants over half the range
/// of the second.
enum class StudyKind { exponent, order, spread, within_spread };
inline constexpr std::array<std::string_view, 4> kStudyKinds{"exponent", "order", "spread",
                                                             "within-spread"};

/// Which x is that of the finer discretisation: a step is smaller, a count larger.
enum class Finer { smaller, larger };
inline constexpr std::array<std::string_view, 2> kFiner{"smaller", "larger"};

/// The words of the enumerators, as files have them.
inline std::string text_of(Comparison x) {
  return std::string(kComparisons.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(Reduction x) {
  return std::string(kReductions.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(StudyKind x) {
  return std::string(kStudyKinds.at(static_cast<std::size_t>(x)));
}

}  // namespace geoprior
