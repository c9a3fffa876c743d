#include "models/paper/shell/stepper_options.h"

#include <array>
#include <string_view>

namespace geoprior::paper {
namespace {

constexpr std::array<std::string_view, 2> kBendingNames{"shape-operator", "hinge"};
constexpr std::array<std::string_view, 2> kIntegrationNames{"linear", "newton"};

void describe_contact(OptionVisitor& v, StepperOptions& o) {
  v.value("contact_distance", o.contact_distance,
          {.doc = "gap at which an obstacle begins to push", .unit = "m", .min = 1e-6, .max = 0.1});
  v.value("contact_stiffness", o.contact_stiffness,
          {.doc = "push of an obstacle per depth and area of sheet",
           .unit = "N/m^3",
           .min = 1,
           .max = 1e12});
  v.value("contact_spacing", o.contact_spacing,
          {.doc = "greatest distance of the points of a triangle that are tested against obstacles",
           .unit = "m",
           .min = 1e-4,
           .max = 10});
  v.value("creep_speed", o.creep_speed,
          {.doc = "slip speed at which friction reaches 0.7 of Coulomb's",
           .unit = "m/s",
           .min = 1e-9,
           .max = 1});
}

}  // namespace

void describe(OptionVisitor& v, StepperOptions& o) {
  describe_choice(v, "integration", o.integration, kIntegrationNames,
                  {.doc = "one linear solve a step, or implicit Euler solved by Newton's method"});
  describe_choice(v, "bending", o.bending.model, kBendingNames,
                  {.doc = "bending energy: that of a plate with the fitted shape operator, or "
                          "hinges at the edges"});
  v.value(
      "hinge_calibration", o.bending.hinge_calibration,
      {.doc =
           "factor of the bending energy of hinges; 4 makes equilateral ones as stiff as the plate",
       .min = 1e-3,
       .max = 1e3});
  v.value("fit_residual", o.bending.fit_residual,
          {.doc = "stiffness against angles at borders and folds that the fitted curvature leaves, "
                  "relative to the plate's",
           .min = 1e-6,
           .max = 10});
  v.value(
      "plasticity", o.plasticity,
      {.doc =
           "whether the sheet creases where its elastic curvature exceeds the material's yield"});
  v.value("newton_iterations", o.newton_iterations,
          {.doc = "most linear solves of a step by Newton's method", .min = 1, .max = 1000});
  v.value("newton_tolerance", o.newton_tolerance,
          {.doc = "residual at which Newton's method ends, relative to the forces of the step",
           .min = 1e-14,
           .max = 1});
  describe_contact(v, o);
}

}  // namespace geoprior::paper
