#pragma once

#include <string>

#include "models/sketch/pattern/pattern.h"
#include "solvers/sketch/layers/articulated_layers.h"

namespace geoprior::sketch {

/// What a layer, from 0, is called: as the edge at its rear; "layer 1" where that has no name.
std::string layer_name(const ArticulatedLayers& layers, std::size_t layer);

/// The flat pieces of articulated layers, in closed form: no piece is flattened numerically.
///
/// A piece a band (`FrustumBand::unrolled`), the strip that lies below the band before it included:
/// seen from outside, the front upwards. Its triangles and vertices are those of the bands' sheets
/// one after the other, its four free edges are the rear rim, one side, the front rim, the other
/// side. It has a hole for each rivet, and a placement line where the rear rim of the band before
/// it lies at rest. Pieces stand on shelves (`lay_on_shelves`).
///
/// @param gap  between the boxes of pieces (m)
Pattern layer_pattern(const ArticulatedLayers& layers, const LayerOptions& options, double gap);

}  // namespace geoprior::sketch
