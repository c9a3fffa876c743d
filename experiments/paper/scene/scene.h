#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/paper/scene/options.h"
#include "models/paper/sheet/sheet.h"
#include "testbed/topic.h"

namespace geoprior::paper {

/// A sheet, what moves it and what is in its way: what every paper method is given and every paper
/// metric is measured on.
class PaperScene final : public ProcessScene {
 public:
  Sheet sheet;
  double fold_radius = 0.03;  ///< of the discs within which folds cancel (m)

  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// Parts "sheet" (about 2,000 triangles, flat where the sheet starts, without the waves of the
  /// imperfection; point arrays "pattern" and "handle", -1: none) and "outline" (lines of the
  /// pattern, z = 0; "kind" 0 border, 1 hole, 2 cut); tables "frames", "handle_transforms" (a row a
  /// frame and handle that moves: whether it holds, and the 3 x 4 matrix that moves what it holds
  /// from the start) and "handle_forces" of those that pull (N).
  [[nodiscard]] Frame given() const override;
  [[nodiscard]] std::vector<PartShape> frame_shape() const override;
  /// No files: the part "drawn", of every method alike.
  [[nodiscard]] std::vector<Artifact> files_of(Frame& frame) const override;
};

/// The sheet that the options describe. @throws Error  naming the key
Sheet make_sheet(const PaperSceneOptions& options, const Pattern& pattern, std::uint64_t seed);

/// Reads the pattern and makes the sheet; handles that pull it apart by more than 0.1 %, or
/// that are faster than it can follow (fast_handles.h), are warnings of the scene.
/// @param folder  of the experiment file, against which relative files are tried first
/// @param seed    of the experiment, for what the scene draws
/// @throws Error  naming key or file, and place (see require_valid)
std::shared_ptr<PaperScene> load_paper_scene(const PaperSceneOptions& options,
                                             const std::filesystem::path& folder,
                                             std::uint64_t seed);

}  // namespace geoprior::paper
