#include "solvers/fluid/paste/options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {
namespace {

constexpr std::array<std::string_view, 3> kMappings{"automatic", "projection", "exponential"};

}  // namespace

void describe(OptionVisitor& v, PasteOptions& o) {
  describe_choice(v, "mapping", o.mapping, kMappings,
                  {.doc = "how vertices find their place in a map: along its normal, geodesics, or "
                          "by the target's slope"});
  v.value("refine", o.refine,
          {.doc = "splits edges of the target that are too long for the texels of a map"});
  v.value(
      "refine_texels", o.refine_texels,
      {.doc = "longest edge of the target under a map", .unit = "texels", .min = 0.1, .max = 100});
  v.value("projection_reach", o.projection_reach,
          {.doc = "distance along the normal within which the target is found from a map's plane",
           .unit = "extents",
           .min = 0.01,
           .max = 1000});
  v.value("max_triangles", o.max_triangles,
          {.doc = "triangles beyond which a refined target is refused", .min = 1});
  v.value("leave_out", o.leave_out,
          {.doc = "pastes nothing: the target less what was cut out of it (a null control)"});
}

}  // namespace geoprior::fluid
