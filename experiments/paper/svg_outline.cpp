#include "experiments/paper/svg_outline.h"

#include "core/error.h"
#include "models/paper/pattern.h"
#include "testbed/formats/svg_path.h"

namespace geoprior::paper {

std::vector<Eigen::Vector2d> flatten_svg_path(std::string_view d, double tolerance,
                                              const std::string& where) {
  std::vector<SvgSubpath> subpaths = flatten_svg_subpaths(d, tolerance, where);
  if (subpaths.size() > 1) {
    throw Error("a second subpath begins",
                where + ", character " + std::to_string(subpaths[1].character),
                "one closed outline");
  }
  std::vector<Eigen::Vector2d> outline;
  if (!subpaths.empty()) outline = std::move(subpaths[0].points);
  while (outline.size() > 1 && outline.front() == outline.back()) outline.pop_back();
  if (outline.size() < 3) throw Error("the outline has fewer than three points", where, "an area");
  if (outline.size() > kMostCorners) {
    throw Error("the outline has too many corners", where, std::to_string(kMostCorners));
  }
  return outline;
}

}  // namespace geoprior::paper
