#pragma once

#include <Eigen/Core>
#include <optional>

#include "baselines/sound/modal/operator.h"

namespace geoprior::sound {

/// Reference for the sound of a sheet: the eigenmodes of the dense solver's shell (its stiffness,
/// its mass: modal_operator.h) about a shape, flat, clamped along edges or bent,
///
///   K phi = omega^2 M phi,   phi' M phi = 1,   in vacuo and undamped.
///
/// Rigid motions that the supports allow are left out (six of a free sheet). Motions in the plane
/// of the sheet are modes as well; they are high, and silent.
///
/// Of a mesh with edges of length l, plate waves are right up to `resolved_frequency`; above it
/// frequencies come out too low or too high by more than a hundredth, and membrane stiffness of a
/// strongly bent sheet needs edges shorter than about sqrt(h / kappa).
///
/// Lanczos' method on P (K - sigma M)^-1 P, P the projection that takes out rigid motions and modes
/// already found, sigma = -100 D / (rho_s A^2) below all modes, so that the matrix is positive
/// definite; in units of -sigma, because the solver's tolerance is absolute below 1e-11.
/// Sylvester's law of inertia then counts the modes below the highest one found, and those that
/// Lanczos missed (it sees one vector of a multiple eigenvalue) are searched again.
struct Modes {
  Eigen::VectorXd frequency;  ///< Hz, k ascending
  Eigen::MatrixXd shape;      ///< phi, 3 n x k by vertices x0 y0 z0 x1 ... (kg^-1/2)
  Eigen::VectorXd mass;       ///< of each vertex (kg)
};

struct ModalOptions {
  int most = 60;                     ///< modes, from the lowest on
  std::optional<double> up_to = {};  ///< only modes below this frequency (Hz)
  paper::BendingLaw bending = {};
};

/// The lowest modes of a sheet about the places `state.x`.
/// @throws Error  from ModalOperator; when `most` is not positive, or without `up_to` more than the
///                mesh has
Modes eigenmodes(const PaperMaterial& material, const ShellState& state,
                 const ModalSupports& supports = {}, const ModalOptions& options = {});

/// Frequency (Hz) at which a bending wave of the flat plate is eight mean edges long, k = 2 pi /
/// (8 l), omega = k^2 sqrt(D / rho_s).
double resolved_frequency(const PaperMaterial& material, const ShellMesh& mesh);

}  // namespace geoprior::sound
