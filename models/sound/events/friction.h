#pragma once

#include <vector>

#include "models/paper/contact/contact.h"
#include "models/sound/events/event.h"
#include "models/sound/resonators/grid.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// What counts as sliding that is heard.
inline constexpr double kSlideMargin = 5e-4;      ///< of a contact, beyond the contact distance (m)
inline constexpr double kLeastSlideSpeed = 5e-3;  ///< along the surface (m/s)
inline constexpr double kSlidePause = 0.05;       ///< a longer one ends an event (s)

/// Finds where a sheet slides along the obstacles: one event from the first to the last moment, a
/// pause of `kSlidePause` apart, for each obstacle.
///
/// A cell slides when it is in contact and its velocity and the obstacle's differ by
/// `kLeastSlideSpeed` along the surface. Friction is mu p s there, s the slip speed and p the
/// contact's pressure k (d_c - gap) of the sheet's model (models/paper/contact/contact.h): of
/// sheets of other programs it is a guess, and the speed is not.
class SlideDetector {
 public:
  SlideDetector(const Sheet& sheet, const SoundGrid& grid);
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
  paper::ObstacleContactOptions contact_;
  std::vector<Course> courses_;  ///< one an obstacle
};

}  // namespace geoprior::sound
