#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/topic.h"

namespace geoprior {

/// "lower_is_better", …: the words of run.h5.
std::string direction_text(Direction direction);

/// Index of the frame of equal parameter (relative difference at most 1e-9), or -1.
int frame_of_parameter(const std::vector<FrameRecord>& frames, double parameter);

/// Values of the topic's frame metrics at a frame; those without meaning there are absent.
/// @throws Error  naming the metric, or those of the group when its measurement fails
std::map<std::string, double> measure_frame(const Topic& topic, const Scene& scene,
                                            const Frame& frame, const Frame* reference);

/// The same of one group; none where it measures sequences, or there is no reference that it needs.
std::map<std::string, double> measure_frame(const MetricGroup& group, const Scene& scene,
                                            const Frame& frame, const Frame* reference);

/// Values of the topic's sequence metrics. @throws Error  as measure_frame
std::map<std::string, double> measure_sequence(const Topic& topic, const Scene& scene,
                                               const FrameSequence& frames);
/// The same of one group; none where it measures frames.
std::map<std::string, double> measure_sequence(const MetricGroup& group, const Scene& scene,
                                               const FrameSequence& frames);

/// @throws Error  naming a diagnostic of the frame that is not in the topic's table
void require_declared(const Topic& topic, const Frame& frame, const std::string& method);

bool has_sequence_metrics(const Topic& topic);
bool has_reference_metrics(const Topic& topic);
/// What the metrics look at in a reference frame; absent: all of it.
std::optional<std::set<std::string>> reference_parts(const Topic& topic);

/// Adds "<metric>.max", ".min", ".median" and ".last" to the summary, and unit, definition and
/// direction from the topic's tables to every column.
void summarise(const Topic& topic, VariantRecord& variant);

}  // namespace geoprior
