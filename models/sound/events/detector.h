#pragma once

#include <optional>
#include <vector>

#include "core/context.h"
#include "models/sound/events/event.h"
#include "models/sound/events/flips.h"
#include "models/sound/events/friction.h"
#include "models/sound/resonators/resonator.h"
#include "models/sound/resonators/shape.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// How what a sheet sounds like is found.
struct DetectionOptions {
  double spacing = 3.3e-3;  ///< 64 x 90 cells on a sheet of A4
  double radius = 4e-3;
  double least_energy = 1e-6;
  bool tears = true;
  FlipOptions flips;
  CreaseOptions resonator;
};
void describe(OptionVisitor& v, DetectionOptions& options);

/// Finds the events of an animated sheet: sudden changes of the sign of curvature with their
/// resonators, sliding, steps of tears. What is found depends on the sheet's motion, not on its
/// meshes (a grid of the pattern).
///
/// Energy of a flap or crac: what bending held in the cells that flip, D/2 k_b^2 A. All of it is
/// set free until they are flat; what the other side takes up again, and what becomes of it on the
/// way, depends on the frames that are looked at, and is left out. Of a step of a tear:
/// E_f times the section it tears.
class SoundDetector {
 public:
  SoundDetector(const Sheet& sheet, const DetectionOptions& options);
  SoundDetector(const SoundDetector&) = delete;
  SoundDetector& operator=(const SoundDetector&) = delete;
  /// Takes the next frame. @return the events that are known now, in order of time; none starts
  ///                         earlier than `latency` before the frame, friction apart
  std::vector<SoundEvent> push(const SheetSnapshot& frame, RunContext& context);
  /// What is left at the end.
  std::vector<SoundEvent> finish(RunContext& context);

  [[nodiscard]] const SoundGrid& grid() const { return sampler_.grid(); }
  /// The last frame on the grid.
  [[nodiscard]] const SheetField& field() const { return field_; }
  /// The resonator of an event of the last push, as it is in the last frame.
  [[nodiscard]] ResonatorShape shape(const SoundEvent& event) const;
  /// From an event to when it is known, friction apart, beside a frame's interval (s).
  [[nodiscard]] double latency() const {
    return options_.flips.together + options_.flips.sudden / 2;
  }

  void save(StateWriter& out) const;
  /// @param last  the frame that was pushed last before `save`
  void load(StateReader& in, const SheetSnapshot& last);

 private:
  [[nodiscard]] bool is_held(const Eigen::Vector2d& place) const;
  [[nodiscard]] Resonator resonator(const std::vector<int>& seeds);
  [[nodiscard]] SoundEvent snap(const FlipCluster& cluster);
  void add_snaps(const std::vector<FlipCluster>& clusters, std::vector<SoundEvent>& events);
  void add_tears(const SheetSnapshot& frame, std::vector<SoundEvent>& events);

  const Sheet& sheet_;
  DetectionOptions options_;
  SheetSampler sampler_;
  FlipDetector flips_;
  SlideDetector slides_;
  SheetField field_;
  std::vector<int> parts_;            ///< of the last frame between creases; empty: not yet found
  std::optional<double> torn_until_;  ///< steps of tears until then are events, or a cut (s)
};

}  // namespace geoprior::sound
