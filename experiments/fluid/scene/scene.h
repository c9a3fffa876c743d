#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baselines/fluid/liquid/tank/tank.h"
#include "experiments/fluid/injected/sequence.h"
#include "experiments/fluid/scene/options.h"
#include "metrics/volume/liquid_columns.h"
#include "solvers/fluid/sculpt_scene.h"
#include "testbed/topic.h"

namespace geoprior::fluid {

/// A tank to simulate, or animations, a target and edits, or several of these: what the fluid
/// methods are given and the fluid metrics are measured on.
class FluidScene final : public ProcessScene {
 public:
  std::optional<Tank> tank;
  std::shared_ptr<const InjectedSequence> injected;  ///< with its truth, or null
  int injected_resolution = 1;                       ///< its lattice nodes per cell
  SculptScene sculpt;
  double duration = 1, frame_interval = 0.04;  ///< s
  Eigen::Vector3d gravity{0, 0, -9.81};
  /// Where wave gauges stand: over the tank, else over the first frame of target or source.
  std::optional<ColumnGrid> gauges;
  double cell = 0;  ///< length that distances are compared with: the tank's h, or the mean edge (m)

  /// @throws Error  naming the method: without the table, or without volumes and sources in it
  [[nodiscard]] const Tank& require_tank(const std::string& who) const;

  /// Width a of the water column of a dam break: one box of water against the lower x side of a
  /// tank without solids and sources; absent for other scenes.
  [[nodiscard]] std::optional<double> dam_width() const;

  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// Table "frames"; of a tank also "tank" (one row) and, a row a body, "volumes", "sources" and
  /// "solids" (kind 0 box, 1 sphere, 2 cylinder, 3 half space, 4 mesh), with the parts
  /// "volume_0000", "source_0000", "solid_0000" of those that are meshes, and "solid_transforms": a
  /// row a frame and solid that moves. Animations are input files.
  [[nodiscard]] Frame given() const override;
  [[nodiscard]] std::vector<PartShape> frame_shape() const override;
};

/// @param folder  of the experiment file, against which relative files are tried first
/// @param seed    of the experiment: of injected features, their noise, and an ocean's waves
/// @throws Error  naming key or file, and place
std::shared_ptr<FluidScene> load_fluid_scene(const FluidSceneOptions& options,
                                             const std::filesystem::path& folder,
                                             std::uint64_t seed);

}  // namespace geoprior::fluid
