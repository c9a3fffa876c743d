#pragma once

#include <cstdint>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/judgement/interval.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// By how much a claim about a time is from failing, with the percentile bootstrap's 95 % interval
/// (2000 resamples): frames are drawn anew, of both sides the same where they have as many; of a
/// phase with one time a run, and of one frame, its repetitions. A single time says nothing of the
/// spread: the interval is NaN.
/// @throws Error  as `judge`
Interval timed_margin(const ClaimSpec& claim, const CaseRecord& in, std::uint64_t seed);

/// The same of a claim about a study of times, by the study's own interval.
Interval timed_margin(const ClaimSpec& claim, const StudyRecord& study);

/// Whether the interval says that the claim holds, or that it does not: equality is outside.
bool is_decided(const Interval& margin);

}  // namespace geoprior
