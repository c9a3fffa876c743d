#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/sketch/fabrication/fabrication.h"
#include "experiments/sketch/truth/known_object.h"
#include "experiments/sketch/truth/synthetic_views.h"

namespace geoprior::sketch {

/// `scene.known`: what a drawing shows, so that its reconstruction can be measured.
struct KnownDrawingOptions {
  KnownShape shape = KnownShape::bag;
  double noise = 0;
  bool noisy_vectors = false;
  double vector_stretch = 1;  ///< of sym-a: above 1 the two vectors are of unequal length in space
  bool visible_only = false;  ///< such a drawing has no photograph
  std::optional<double> yaw_deg = {}, pitch_deg = {};  ///< the object's own when absent
  int seed = 1;
};
void describe(OptionVisitor& v, KnownDrawingOptions& options);

/// The object as it is seen.
KnownObject shown_object(const KnownDrawingOptions& options);

/// Name of a shape in options and files: "bag".
std::string known_name(KnownShape shape);

/// `bag.svg` and `bag.png`: the drawing of a known object and the photograph that it refers to.
/// These are the files beside the experiments; a run of a scene that has `known` and no drawing
/// leaves them in its folder.
std::vector<FabricationFile> known_drawing_files(const KnownDrawingOptions& options);

/// The same without files: strokes as exact as they are computed, the photograph embedded.
Drawing known_drawing(const KnownDrawingOptions& options);

/// Places in space of the points of a drawing of a known object that was read from a file.
/// @param view    its strokes; noise is added to it
/// @throws Error  when the strokes are not those of the object (names the first that differs)
SyntheticView known_truth(const View& view, const KnownDrawingOptions& options, std::uint64_t seed);

}  // namespace geoprior::sketch
