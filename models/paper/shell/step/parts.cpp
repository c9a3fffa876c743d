#include "models/paper/shell/step/parts.h"

#include "models/paper/shell/lumped_mass.h"

namespace geoprior::paper {

StepParts::StepParts(const Sheet& of, const StepperOptions& how, std::uint64_t seed,
                     const ShellState& state)
    : sheet(of),
      options(how),
      elements(state.mesh, of.material, how.bending),
      handles(of, state, seed),
      mass(lumped_masses(state.mesh, of.material.area_density)),
      contact(of, how, state.mesh),
      friction(of, how),
      matrix(elements, vertices(), how) {}

void StepParts::pose(const ShellState& state, double dt) {
  problem.pose(sheet, handles, mass, matrix, state, dt);
  contact.find(problem, sheet.gravity);
  friction.find(problem, contact);
}

}  // namespace geoprior::paper
