#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/formats/sequence/find.h"
#include "testbed/formats/sequence/mesh_sequence.h"

namespace geoprior {

/// What options and sidecar say of time.
struct Clock {
  std::optional<double> frames_per_second;
  std::optional<double> start;  ///< of the first frame (s)
};

/// Gives every frame its time: start + (number - first number) / rate when a rate is given, else
/// the times of the collection or of the files (TimeValue of .vtp, which reads them), else 25
/// frames a second.
/// @param warnings  added: frames that are missing between two numbers, times of more than one
///                  interval, a rate that was assumed
std::vector<FrameFile> timed(const std::vector<FoundFile>& files, const Clock& clock,
                             const std::string& name, std::vector<std::string>& warnings);

/// Numbers that are missing in an increasing list, "3, 7 to 9"; empty for none. Numbers in regular
/// steps (0, 5, 10) miss none.
std::string missing_numbers(const std::vector<int>& numbers);

/// What is uneven about increasing times, empty for even ones: a frame rate that changes, or gaps
/// that the numbers of the frames do not explain.
std::string uneven_times(const std::vector<double>& times, const std::vector<int>& numbers);

}  // namespace geoprior
