#pragma once

#include <optional>

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"
#include "models/sketch/pattern/pattern.h"
#include "solvers/sketch/one_view.h"
#include "solvers/sketch/photo/nearest_triangles.h"
#include "solvers/sketch/photo/pixel_image.h"

namespace geoprior::sketch {

struct BakeOptions {
  std::optional<double> dpi = {};
  int most_side = 2048;
  int bleed = 4;
  double least_facing = 0.2;
  double behind = 0.01;
};
void describe(OptionVisitor& v, BakeOptions& options);

/// The photograph on the pattern.
struct BakedPattern {
  PixelImage image;     ///< white where no piece is
  PixelGrid grid;       ///< places of its pixels in the pattern (m)
  double seen = 0;      ///< share of the pieces' area that the photograph shows
  double mirrored = 0;  ///< … that is hidden, but whose mirror image is seen
  /// … that is seen so near to a silhouette that colours go on from around
  double continued = 0;
  double flat = 0;  ///< … that nothing shows, or beside silhouettes out of reach
};

/// Colours of the flat pieces from the photograph (thesis 2.1.3: the hidden half has the texture of
/// the visible one).
///
/// A pixel of a piece is a point of the surface; what was made by mirroring stands for its source.
/// Its colour is that of the photograph at its place in the picture (`TexturedSurface::texture`)
/// when the point faces the eye and nothing lies before it; else that of its mirror image, where
/// that is seen; else the mean of what is seen of its patch, or of all patches. Which side of a
/// connected surface is its outside is decided by what most of its visible area turns to the eye.
/// The result is symmetric: a sign on one half is on both, mirrored.
///
/// What lies nearer to a silhouette in the picture than photograph and drawing may disagree
/// (`OneViewResult::disagreement`), one pixel more for the mixed pixels along an edge, is not read:
/// else a traced line that is two pixels off paints the background, or what lies behind or beside,
/// along the borders of panels. Nor is what is thinner than a pixel. On the pattern the colours of
/// the rest of the patch go on there (`ContinuedPatches`), its own and those of mirror images; out
/// of their reach it counts as hidden. Silhouettes here are where the surface ends in the picture,
/// its depth jumps, or another patch begins.
///
/// Colours are those of the photograph, with its light and shade in them.
///
/// @param view   with its picture's place; @param photo its pixels
/// @throws Error on a pattern larger than 30000 pixels a side
BakedPattern bake_pattern(const View& view, const PixelImage& photo, const OneViewResult& result,
                          const Pattern& pattern, const BakeOptions& options = {});

}  // namespace geoprior::sketch
