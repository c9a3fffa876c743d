#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "experiments/details/scene/options.h"
#include "models/details/scene.h"
#include "testbed/topic.h"

namespace geoprior::details {

/// A surface that moves with details on it: what the methods are given and the metrics are measured
/// on.
class DetailsScene final : public ProcessScene {
 public:
  DetailScene input;  ///< what a method is given
  /// Details that the scene's own process of placing gives with other seeds, for noise floors; none
  /// where details come from a file.
  std::vector<std::vector<Detail>> resamples;
  std::vector<char> region;  ///< a flag a triangle: where the pattern is
  int pair_frames = 4;       ///< at which the pair correlation is measured
  int pair_sources = 1000;   ///< details that distances are then measured from
  std::optional<DetailDrawingOptions> drawing;
  TriMesh instance;                     ///< mesh of a detail, when the drawing takes one of a file
  std::optional<double> chosen_height;  ///< of a detail of weight 1 (m)

  /// The frame of a method that has done nothing yet: surface and M_d at rest. Made when it is
  /// first asked for; safe from several threads.
  [[nodiscard]] const Frame& rest() const;
  /// Mean edge of M_d among details at rest (m); 0 without such edges.
  [[nodiscard]] double rest_edge() const;
  /// Whether the pair correlation is measured in the frame with that parameter.
  [[nodiscard]] bool measures_pairs(double parameter) const;
  [[nodiscard]] bool is_drawn(double parameter) const;
  /// Whether popping of the drawing is measured there, since the frame before.
  [[nodiscard]] bool measures_drawn_pop(double parameter) const;

  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// Parts "surface" at rest with the array "region" (1 where the pattern is), "details" and their
  /// "detail_mesh" as a frame has them, and "motion_0000" …: points of the surface in every frame;
  /// table "frames" with their times.
  [[nodiscard]] Frame given() const override;
  [[nodiscard]] std::vector<PartShape> frame_shape() const override;

 private:
  /// Whether the frame is one of `count`, evenly over the motion without its first.
  [[nodiscard]] bool is_one_of(int count, double parameter) const;

  mutable std::once_flag rest_made_;
  mutable Frame rest_;
};

/// @param folder  of the experiment file, against which relative files are tried first
/// @param seed    of the experiment: of the pattern, beside the pattern's own
/// @throws Error  naming key or file, and place
std::shared_ptr<DetailsScene> load_details_scene(const DetailSceneOptions& options,
                                                 const std::filesystem::path& folder,
                                                 std::uint64_t seed);

}  // namespace geoprior::details
