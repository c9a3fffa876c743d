#include "solvers/fluid/paste/options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {
namespace {

constexpr std::array<std::string_view, 3> kMappings{"automatic", "projection", "exponential"};

}  // namespace

void describe(OptionVisitor& v, PasteOptions& o) {
  describe_choice(v, "mapping", o.mapping, kMappings,
                  {.doc = "how target vertices find their place in a map: along its normal, along "
                          "geodesics, or by how steep the target is"});
  v.value("refine", o.refine, {.doc = "split target edges too long for the texels of a map"});
  v.value(
      "refine_texels", o.refine_texels,
      {.doc = "longest edge of the target under a map", .unit = "texels", .min = 0.1, .max = 100});
  v.value("projection_reach", o.projection_reach,
          {.doc = "how far along the normal the target may lie from a map's plane",
           .unit = "extents",
           .min = 0.01,
           .max = 1000});
  v.value("max_triangles", o.max_triangles,
          {.doc = "a refined target larger than this is refused", .min = 1});
  v.value(
      "velocity", o.velocity,
      {.doc = "rates of the displacements are added to the target's velocity when it is known"});
  v.value("leave_out", o.leave_out,
          {.doc = "nothing is pasted: the target less what was cut out of it (a null control)"});
}

}  // namespace geoprior::fluid
