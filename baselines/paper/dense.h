#pragma once

#include <memory>

#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/process.h"
#include "models/paper/tear/growth.h"

namespace geoprior::paper {

/// Baseline: one uniform mesh from start to end.
struct DenseOptions {
  int triangles = 4096;
  UniformLayout layout = UniformLayout::automatic;
  TearOptions tearing;
  StepperOptions stepper;
};
void describe(OptionVisitor& v, DenseOptions& options);

std::unique_ptr<Process> make_dense_sheet(const Sheet& sheet, const DenseOptions& options);

}  // namespace geoprior::paper
