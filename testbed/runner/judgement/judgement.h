#pragma once

#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// A claim's inequality with its sides put in, in one case: at one frame or reduction, or (`every`)
/// frame by frame.
struct Judgement {
  /// One comparison. Of all that are made the one nearest to failing speaks for the claim.
  struct Trial {
    double left = 0;
    double right = 0;
    bool holds = false;
    double margin = 0;  ///< how far it is from failing; negative when it fails
    std::string detail;
  };
  std::vector<Trial> trials;  ///< at least one

  [[nodiscard]] const Trial& worst() const;
  [[nodiscard]] bool holds() const { return worst().holds; }
  /// Whether it fails by more than the tolerance: at the one frame, or in at least half of all.
  [[nodiscard]] bool fails_clearly(const Tolerance& tolerance) const;
};

/// How far the two sides are from failing the claim; negative when they fail it.
double margin_of(const ClaimSpec& claim, double left, double right);

/// Puts `variant` in the place of the claim's; `of` stays that of the claim.
/// @throws Error  when a side has no value, no such frame or phase, or failed
Judgement judge(const ClaimSpec& claim, const CaseRecord& in, const std::string& variant);

/// The same for a claim about a study: `studies` are those of the run, or made anew with another
/// variant.
Judgement judge_study(const ClaimSpec& claim, const std::vector<StudyRecord>& studies);

}  // namespace geoprior
