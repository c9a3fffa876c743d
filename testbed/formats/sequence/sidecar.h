#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace geoprior {

/// What meshes cannot say of themselves: {"frames_per_second": 24, "up": "y", "scale": 0.01,
/// "start": 0}, every key optional.
struct SequenceSidecar {
  std::optional<double> frames_per_second;
  std::optional<double> scale;  ///< metres a unit of the files
  std::optional<double> start;  ///< time of the first frame (s)
  std::optional<bool> y_up;
};

/// @throws Error  naming the file: no JSON object (with the byte), unknown keys, values of another
///                type or out of range
SequenceSidecar read_sidecar(const std::filesystem::path& file);
SequenceSidecar parse_sidecar(std::string_view text, const std::string& name);

}  // namespace geoprior
