#include "experiments/sketch/texture_measures.h"

#include <algorithm>

#include "testbed/formats/svg/color.h"

namespace geoprior::sketch {

double key_excess(const Eigen::RowVector3d& colour, const Eigen::RowVector3d& background) {
  Eigen::Index key = 0;
  background.maxCoeff(&key);
  return colour(key) - std::max(colour((key + 1) % 3), colour((key + 2) % 3));
}

std::optional<double> background_texels(const SketchScene& scene, const Frame& frame) {
  if (!scene.background || frame.find_part("texels") == nullptr) return {};
  const auto& colours = frame.require_part("texels", Part::Kind::points)
                            .require_array("colour", NamedArray::On::points, 3)
                            .values;
  if (colours.rows() == 0) return {};
  const SvgColour named = *parse_svg_colour(*scene.background);
  const Eigen::RowVector3d background(named.red, named.green, named.blue);
  constexpr double kShare = 0.15;
  const double least = kShare * key_excess(background, background);
  double count = 0;
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    count += key_excess(colours.row(i), background) > least ? 1 : 0;
  return count / static_cast<double>(colours.rows());
}

}  // namespace geoprior::sketch
