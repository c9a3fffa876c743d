#include "experiments/sketch/texture_measures.h"

#include <algorithm>
#include <vector>

#include "testbed/formats/svg/color.h"

namespace geoprior::sketch {

std::optional<double> background_texels(const SketchScene& scene, const Frame& frame) {
  if (!scene.background || frame.find_part("texels") == nullptr) return {};
  const auto& colours = frame.require_part("texels", Part::Kind::points)
                            .require_array("colour", NamedArray::On::points, 3)
                            .values;
  if (colours.rows() == 0) return {};
  const SvgColour named = *parse_svg_colour(*scene.background);
  const Eigen::RowVector3d background(named.red, named.green, named.blue);
  Eigen::RowVector3d median;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values(colours.col(k).begin(), colours.col(k).end());
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    median(k) = values[values.size() / 2];
  }
  constexpr double kShare = 0.3, kLeast = 40;
  const double near = std::max(kShare * (median - background).norm(), kLeast);
  double count = 0;
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    count += (colours.row(i) - background).norm() < near ? 1 : 0;
  return count / static_cast<double>(colours.rows());
}

}  // namespace geoprior::sketch
