#include "models/torus/input.h"

#include <cmath>
#include <sstream>
#include <string>

#include "core/error.h"
#include "core/limits.h"
#include "models/torus/directions.h"

namespace geoprior::torus {
namespace {

void require_valid(const SquareWindow& view, const std::string& where) {
  if (!(view.width > 0)) throw Error("a window has no width", where + ".width");
  for (int k = 0; k < 2; ++k)
    if (!(view.centre(k) - view.width / 2 >= 0 && view.centre(k) + view.width / 2 <= 1))
      throw Error("a window reaches out of the unit square", where);
}

}  // namespace

int stage_base(const TorusInput& input, int corrugation) {
  while (!input.corrugations[corrugation].begins_stage) --corrugation;
  return corrugation;
}

double first_share(const Radii& radii) {
  const double tube = radii.tube * radii.tube, ring = radii.ring * radii.ring;
  return 4 * (ring - tube) / (3 + ring - 3 * tube);
}

void refuse_coefficient(const TorusInput& input, int corrugation, double rho,
                        const Eigen::Vector2d& at) {
  std::ostringstream text;
  text << "the coefficient rho_" << input.corrugations[corrugation].direction << " = " << rho
       << " of corrugation " << corrugation + 1 << " is not positive at x = " << at.x()
       << ", y = " << at.y()
       << ": those before leave too large an error; larger numbers, or a larger share, mend it "
          "(on a grid more points too)";
  throw Error(text.str(), "scene.corrugations[" + std::to_string(corrugation) + "]");
}

void require_valid(const TorusInput& input) {
  const Radii& radii = input.radii;
  if (!(radii.tube > 0 && radii.ring > radii.tube && radii.tube + radii.ring < 1))
    throw Error("asks for 0 < r1 < r2 and r1 + r2 < 1: the torus must be shorter than the square",
                "scene.r2");
  if (!input.corrugations.empty() && !input.corrugations[0].begins_stage)
    throw Error("the first corrugation begins no stage: it has no target", "scene.corrugations[0]");
  for (int i = 0; i < std::ssize(input.corrugations); ++i) {
    const Corrugation& c = input.corrugations[i];
    const std::string where = "scene.corrugations[" + std::to_string(i) + "]";
    if (c.direction < 0 || c.direction >= std::ssize(kDirections))
      throw Error("is no direction: 0, 1 or 2", where + ".direction");
    if (c.number < 1) throw Error("must be at least 1", where + ".number");
    if (!(c.share > 0 && c.share <= 1)) throw Error("must be in (0, 1]", where + ".share");
  }
  if (input.sampling.view) require_valid(*input.sampling.view, "scene.view");
  if (input.sampling.detail) require_valid(*input.sampling.detail, "scene.detail");
}

}  // namespace geoprior::torus
