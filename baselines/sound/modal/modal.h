#pragma once

#include <memory>

#include "baselines/sound/modal/eigenmodes.h"
#include "models/sound/process.h"

namespace geoprior::sound {

/// Reference: what a resonator's spectrum should be. The picked flaps and cracs sound as the
/// eigenmodes of the shell that their resonator is (baselines/sound/modal/eigenmodes.h), clamped
/// where creases and hands hold it, free at the border, bent as it is then, struck by what the
/// event has changed. It is silent for all other events: friction and tears have no modes.
///
/// Strike. The flip of a cell changes the shape of rest about which it swings: a step of the force
/// g = -dE/dx of the change dS of the shape operators (ModalOperator::curvature_load), taking tau,
/// in the form of a raised cosine. Of mode m it leaves
///
///   q_m = phi_m . g / omega_m^2 |P(f_m tau)|,       P the spectrum of the pulse dg/dt,
///
/// and all are scaled so that sum omega_m^2 q_m^2 / 2 is the energy of the event. tau is as long as
/// the snaps of the generated bank are: the comparison says nothing of it.
///
/// Radiation. Far below coincidence a mode drives the air beside it along: the pressures of both
/// sides differ as beside a plate with waves of its mean wave number (`pressure_jump`,
/// models/sound/voices/air.h). This difference is a layer of dipoles, whose pressure far away is
///
///   p(d) = i k / (4 pi r) integral of the difference (n . d) exp(-i k d . x) dA.
///
/// A mode's pressure is the root mean square over directions d, at 1 m. Air neither loads nor damps
/// the sheet (at 200 Hz it would add a fifth of its mass, and less above); the loss factor is the
/// bank's. Phases are drawn at random, as the bank's are.
struct ModalSoundOptions {
  SoundStage stage;
  double damping = 0.03;
  double highest = 16000;
  int most_modes = 150;
  int most_vertices = 2500;
};
void describe(OptionVisitor& v, ModalSoundOptions& options);

/// Each picked event is recorded with the numbers `modes`, `lowest_hz`, `resolved_hz` (below which
/// all modes are there and right: above it nothing is known) and `radiated_share` of its energy.
std::shared_ptr<const SoundVoices> modal_voices(const ModalSoundOptions& options,
                                                const PaperMaterial& material);

/// Root mean square over directions of the pressure at 1 m of each mode at the amplitude 1 of its
/// coordinate (Pa / (kg^1/2 m)), by the rule above.
/// @param directions  evenly spread over the sphere (a spiral of Fibonacci)
Eigen::VectorXd radiated_pressure(const ShellState& state, const Modes& modes, int directions);

}  // namespace geoprior::sound
