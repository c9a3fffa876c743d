#pragma once

#include <optional>
#include <vector>

#include "experiments/paper/measures.h"
#include "metrics/tracks/tear_path.h"

namespace geoprior::paper {

/// The tears of a frame: paths in the pattern, cuts that the sheet begins with left out.
struct TornSheet {
  std::vector<TearPath> paths;     ///< of each tear what has grown, from where it began to grow
  std::vector<TearPath> outlines;  ///< of each, with the cut it began with
  [[nodiscard]] double length() const;  ///< grown, of all (m)
};
/// Absent when the method records no tears. @throws Error  when the part is not as documented
std::optional<TornSheet> torn_sheet(const Frame& frame);

/// What a sheet torn by two hands is measured by; absent values have no meaning in the scene.
struct TearMeasures {
  double length = 0;  ///< grown, of all tears (m)
  int parts = 0;      ///< that the sheet has fallen into
  Value drift;        ///< focal_drift of the longest tear, of two hands
  Value deviation;    ///< of its chord from the bisector at its start (deg), of two hands
  Value bow;          ///< path_bow of the longest tear
  double energy = 0;  ///< that the tears took: E_f over the torn section (J)
};
/// Absent when the method records no tears.
std::optional<TearMeasures> tear_measures(const SheetFrame& f);

/// What becomes of the work of the hands of a sheet that tears, relative to it: what is left of it
/// once elastic and kinetic energy, that of hands that give (F^2 / 2k each) and that of the tears
/// are taken away. What time stepping damps is left; below 0 the tears took more than there was.
/// Absent before a tear has grown.
Value energy_gap(FitMemo& fits, const SheetFrame& f);

/// Forces of the hands that tear a sheet.
struct TearingForces {
  Value onset;    ///< largest, over the closed form of two hands, in the last frame before growth
  Value growing;  ///< median over the frames with growth, of the mean over the hands (N)
};
/// Absent when the method records no tears.
std::optional<TearingForces> tearing_forces(const PaperScene& scene, const FrameSequence& frames);

/// The longest tear beside that of the reference, in the pattern; absent before both have grown.
std::optional<PathComparison> tear_beside_reference(const SheetFrame& f,
                                                    const SheetFrame& reference);

}  // namespace geoprior::paper
