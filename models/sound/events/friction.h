#pragma once

#include <vector>

#include "core/options.h"
#include "models/paper/contact/contact.h"
#include "models/sound/events/event.h"
#include "models/sound/resonators/grid.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// When a sheet slides audibly.
struct FrictionOptions {
  double margin = 5e-4;       ///< farther from an obstacle than the contact distance, at most (m)
  double least_speed = 5e-3;  ///< of a cell that slides (m/s)
  double pause = 0.05;        ///< a longer one ends an event (s)
};
void describe(OptionVisitor& v, FrictionOptions& options);

/// Finds where a sheet slides along the obstacles: one event from the first to the last moment, a
/// pause of `pause` apart, for each obstacle.
///
/// A cell slides when it is in contact and its velocity and the obstacle's differ by `least_speed`
/// along the surface. Friction is mu p s there, s the slip speed and p the contact's pressure
/// k (d_c - gap) of the sheet's model (models/paper/contact/contact.h): of sheets of other programs
/// it is a guess, and the speed is not.
class SlideDetector {
 public:
  SlideDetector(const Sheet& sheet, const SoundGrid& grid, const FrictionOptions& options);
  /// Takes the next frame. @return the events that are over
  std::vector<SoundEvent> push(const SheetField& field);
  std::vector<SoundEvent> finish();

  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  struct Course {
    std::vector<Sliding> sliding;
    Eigen::Vector3d weighted_place{0, 0, 0};  ///< by area (m^3)
    double weight = 0;                        ///< m^2
  };
  [[nodiscard]] SoundEvent event_of(const Course& course) const;

  const Sheet& sheet_;
  const SoundGrid& grid_;
  FrictionOptions options_;
  paper::ObstacleContactOptions contact_;
  std::vector<Course> courses_;  ///< one an obstacle
};

}  // namespace geoprior::sound
