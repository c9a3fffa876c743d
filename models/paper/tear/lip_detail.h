#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/frame.h"
#include "core/options.h"
#include "models/paper/shell/state.h"
#include "models/paper/tear/tears.h"

namespace geoprior::paper {

/// Detail along the lips of tears, for the eye alone (thesis 3.2.2; after Lejemble et al. 2015):
/// parts of a frame of their own, of which the simulated sheet knows nothing. They cannot take
/// paper away: where a lip lacks what the other has, the sheet is drawn as it is.
///
/// The torn line is the tip's way displaced to its left by
///
///   d(s) = noise f(s) sum_o 2^-o (2 N_o(2^o s / kWave) - 1) / sum_o 2^-o,   o = 0 … 3,
///
/// s the arc length, N_o value noise in [0, 1), f a fade to zero at the tip and where the tear
/// began. Both lips have the one line: what one gains the other lacks. A band along one lip, where
/// the layers of the paper have split, is as wide as the tear was sheared out of the plane there.
struct LipDetailOptions {
  static constexpr double kWave = 2e-3;          ///< longest of the torn line (m); chosen
  static constexpr double kFibreSpacing = 1e-3;  ///< along a lip (m); chosen
  static constexpr double kFibreSpreadDeg = 30;  ///< most from the normal of the lip; chosen
  static constexpr double kSpacing = 5e-4;       ///< of the points along the lips (m); chosen

  bool on = false;
  double noise = 5e-4;           ///< m
  double fibre_length = 1.5e-3;  ///< m
  double bevel = 2e-3;           ///< m
};
void describe(OptionVisitor& v, LipDetailOptions& options);

/// A point of the tip's way, and what the paper tore like there.
struct TornPoint {
  double length = 0;            ///< arc length since the tear began (m)
  Eigen::Vector2d place{0, 0};  ///< of the tip's way, in the pattern (m)
  Eigen::Vector2d left{0, 0};   ///< across, to the left of the way (unit)
  double displacement = 0;      ///< of the torn line from it, to the left (m)
  double bevel = 0;             ///< width of the band (m)
  int bevel_lip = 0;            ///< that it lies on: 0 left, 1 right

  /// By how much the torn line leaves a lip longer than the mesh has it (m).
  [[nodiscard]] double gain(int lip) const {
    return std::max(0.0, lip == 0 ? -displacement : displacement);
  }
};
/// Every `kSpacing` along a tear, at its ends, and where the torn line crosses the tip's way; none
/// of a tear without length. What the sheet began with was cut and has not torn.
/// @param seed  the tear's own: `lip_seed`
std::vector<TornPoint> torn_line(const Tear& tear, const LipDetailOptions& options,
                                 std::uint64_t seed);

/// A strand that sticks out of a lip, in the pattern.
struct Fibre {
  TornPoint at;
  int lip = 0;
  Eigen::Vector2d root{0, 0}, end{0, 0};  ///< m
};
/// In the order in which the tip left them behind, those of the left lip first.
std::vector<Fibre> lip_fibres(const Tear& tear, const LipDetailOptions& options,
                              std::uint64_t seed);

/// @param texture  seed of the toughness' texture
std::uint64_t lip_seed(std::uint64_t texture, int tear);

/// Adds the parts "lip_detail" (triangles: what the lips have gained, and the band; point arrays
/// "pattern" [m] (2), "tear", "lip" [1], cell array "bevel" [1], 1 in the band) and "fibres"
/// (lines; the same point arrays). Both are there without tears too, and empty.
///
/// Points beyond a lip lie in the plane of its triangle, as far from it as in the pattern; all lie
/// in the middle surface of the sheet.
void add_lip_detail(const Tears& tears, const LipDetailOptions& options, std::uint64_t texture,
                    const ShellState& state, Frame& frame);

}  // namespace geoprior::paper
