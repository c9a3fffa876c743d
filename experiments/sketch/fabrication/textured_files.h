#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/options.h"
#include "experiments/sketch/fabrication/fabrication.h"
#include "solvers/sketch/photo/bake_texture.h"

namespace geoprior::sketch {

/// `scene.textures`: files that carry the photograph's colours.
struct TexturedFileOptions {
  BakeOptions bake;
  /// Where it is known, of a test picture: "#rrggbb".
  std::optional<std::string> background = {};
};
void describe(OptionVisitor& v, TexturedFileOptions& options);

struct TexturedFiles {
  std::vector<FabricationFile> files;
  /// texture_seen, texture_mirrored, texture_flat, texture_continued
  std::map<std::string, double> diagnostics;
  Part texels;  ///< as `border_texels`, where the background's colour is known
};

/// Pixels of a pattern's picture within two of them from the border of a piece: their places in the
/// pattern (points) and the array "colour" (3, 0 to 255).
Part border_texels(const PixelImage& image, const PixelGrid& grid, const Pattern& pattern);

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
