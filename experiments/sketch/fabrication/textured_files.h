#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/sketch/fabrication/fabrication.h"
#include "solvers/sketch/photo/bake_texture.h"

namespace geoprior::sketch {

/// `scene.textures`: files that carry the photograph's colours.
struct TexturedFileOptions {
  BakeOptions bake;
};
void describe(OptionVisitor& v, TexturedFileOptions& options);

struct TexturedFiles {
  std::vector<FabricationFile> files;
  std::map<std::string, double> diagnostics;  ///< texture_seen, texture_mirrored, texture_flat
};

/// Files of a reconstruction from one view:
///
/// - `texture.png`: the pieces with their colours, at true scale (its resolution says so);
/// - `textured-pattern.svg`: that picture with the outlines of the pieces, in millimetres;
/// - `model.obj`, `model.mtl`: the surface (m), one group a piece, textured with `texture.png`.
///
/// @param photo   of the view
/// @throws Error  as `bake_pattern`
TexturedFiles textured_files(const View& view, const PixelImage& photo, const OneViewResult& result,
                             const Pattern& pattern, const TexturedFileOptions& options);

}  // namespace geoprior::sketch
