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
/// of the second; `pooled`: a metric of the events of all cases together; `range`: the largest
/// value of the cases over the smallest; `matched`: what the cheapest rival costs at equal quality,
/// over what the variant costs.
enum class StudyKind { exponent, order, spread, within_spread, pooled, range, matched };
inline constexpr std::array<std::string_view, 7> kStudyKinds{
    "exponent", "order", "spread", "within-spread", "pooled", "range", "matched"};

/// What a claim is decided over: each of its cases by itself, or all seeds of one case together.
enum class ClaimOver { case_, seed };
inline constexpr std::array<std::string_view, 2> kClaimOvers{"case", "seed"};

/// Why a claim needs no null: times are no metric of a method's result; an oracle's own tests
/// mutate the method.
enum class Exemption { none, timing, oracle };

/// What a claim's null says of it. `unasked`: no null is named though one is due; `is_void`: the
/// null passes, or fails by less than the metric's tolerance; `undecided`: it has no value.
enum class Discrimination { unasked, exempt, discriminates, is_void, undecided };
inline constexpr std::array<std::string_view, 5> kDiscriminations{
    "unasked", "exempt", "discriminates", "void", "undecided"};

/// What a claim comes to in one case. `not_told_apart`: it holds, and so does its null, or the null
/// has no value there, or there is none.
enum class ClaimOutcome { holds, falls_short, not_told_apart };
inline constexpr std::array<std::string_view, 3> kClaimOutcomes{"holds", "falls short",
                                                                "not told apart"};

/// What a graded mutation changes: the frames, whose metrics are measured anew, or, where the
/// topology of the two differs or the metric does not follow the frames, the metric's own values.
enum class Graded { not_graded, frames, values };
inline constexpr std::array<std::string_view, 3> kGradeds{"no", "frames", "values"};

/// Which x is that of the finer discretisation: a step is smaller, a count larger.
enum class Finer { smaller, larger };
inline constexpr std::array<std::string_view, 2> kFiner{"smaller", "larger"};

/// Variants of the role "null" are there to fail claims: they are neither timed, nor drawn, nor
/// blessed.
inline bool is_null_control(const std::string& role) { return role == "null"; }

/// The words of the enumerators, as files have them.
inline std::string text_of(Comparison x) {
  return std::string(kComparisons.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(Reduction x) {
  return std::string(kReductions.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(Discrimination x) {
  return std::string(kDiscriminations.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(ClaimOutcome x) {
  return std::string(kClaimOutcomes.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(Graded x) {
  return std::string(kGradeds.at(static_cast<std::size_t>(x)));
}
inline std::string text_of(StudyKind x) {
  return std::string(kStudyKinds.at(static_cast<std::size_t>(x)));
}

}  // namespace geoprior
