#pragma once

#include <memory>
#include <vector>

#include "core/method.h"
#include "models/torus/map.h"

namespace geoprior::torus {

/// The process around a map: a frame is a corrugation, or a view of all of them (Sampling).
///
/// Frames are what metrics read, and nothing else:
/// - "surface" (triangles): `surface` x `surface` points, closed where no view is set; point array
///   "parameters" (2); views of `zooms` are magnified as much as they are nearer, about their
///   middle point, which is moved to the origin, and turned so that their mean normal is +z;
/// - "detail" (triangles, where one is asked for): a part of the torus, upright, a unit wide;
/// - "windows" (points): squares of `kWindowSide`^2 points, one after the other, rows along y, at
///   `kSamplesPerPeriod` of the finest corrugation so far, or at the method's grid; table
///   "windows": "x [1]", "y [1]" (corner) and "step [1]";
/// - "windows_before", "windows_base": the same places one corrugation before, and where its stage
///   began (from frame 1 on);
/// - "windows_8", "windows_16", "windows_32": windows of `kCoarseSide`^2 points at so many a
/// period,
///   with tables of the same names; a method with a grid has none;
/// - "horizontal", "vertical", "diagonal" (lines): closed curves y = const, x = const and along
///   (1, 2), of `kCurveSamples` points a period;
/// - "horizontal_above", "horizontal_below" (lines): beside the first, as far as two of its points.
/// - "grid" (grid, last frame): array "position" (3) on `whole`^2 points of the whole torus.
/// Table "corrugations": "direction [1]", "number [1]", "share [1]", "base [1]", one row each so
/// far.
/// Phases: "prepare", "map" (the method alone), "record".
std::unique_ptr<Process> make_torus_process(const TorusInput& input, TorusMapFactory factory);

/// The frames of the torus of revolution, as a method that knows any point makes them, all of their
/// parts but "grid" with the point array "parameters" (2): what metrics ask for.
std::vector<Frame> asked_frames(const TorusInput& input);

}  // namespace geoprior::torus
