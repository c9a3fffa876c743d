#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "core/state_bytes.h"

namespace geoprior::sound {

/// What makes a sound (thesis 3.2.3): a smooth region that snaps to the other side, a crumpled one
/// that does, a sheet that slides, a step of a tear.
enum class SoundKind { flap, crac, friction, tear };
inline constexpr std::array<std::string_view, 4> kSoundKinds{"flap", "crac", "friction", "tear"};

/// How a sheet slides at one time of a friction event.
struct Sliding {
  double time = 0;   ///< s
  double speed = 0;  ///< mean over the contact (m/s)
  double area = 0;   ///< of the contact (m^2)
  double power = 0;  ///< of friction (W)
};

/// A cell whose curvature has changed its sign in an event.
struct FlippedCell {
  int cell = 0;
  double change = 0;  ///< of the curvature, with its sign (1/m)
};

/// Something to be heard, and what it depends on.
struct SoundEvent {
  SoundKind kind = SoundKind::flap;
  double time = 0;                      ///< of its start (s)
  double duration = 0;                  ///< of the motion that makes it (s)
  Eigen::Vector3d position{0, 0, 0};    ///< m
  double energy = 0;                    ///< set free (J)
  double ruling_length = 0;             ///< l_r of its resonator (m)
  double free_border = 0;               ///< l_c (m)
  double area = 0;                      ///< of the resonator, or mean of the contact (m^2)
  double curvature = 0;                 ///< mean |k| of the resonator between creases (1/m)
  double flipped_area = 0;              ///< of what changed its sign (m^2)
  double blocked_share = 0;             ///< of the resonator's border
  std::vector<Sliding> sliding = {};    ///< of friction, in order of time
  std::vector<int> cells = {};          ///< of the resonator, ascending
  std::vector<FlippedCell> flips = {};  ///< in order of the cells
};

void save(const SoundEvent& event, StateWriter& out);
SoundEvent load_sound_event(StateReader& in);

}  // namespace geoprior::sound
