#pragma once

#include "experiments/sketch/truth/known_object.h"
#include "experiments/sketch/truth/known_view.h"
#include "solvers/sketch/photo/pixel_image.h"

namespace geoprior::sketch {

/// Photograph of a known object on its page: orthographic, lit softly, every panel of its own
/// material with a printed pattern, so that a wrong texture is seen to be wrong.
///
/// The pattern of a panel lives in its flat coordinates: distance along its rulings and along its
/// first border, or the plane of a flat panel. It is drawn by formula and without random numbers.
/// @param width  in pixels; the height follows from the page
PixelImage known_photo(KnownShape shape, const KnownObject& object, int width);

}  // namespace geoprior::sketch
