#include "solvers/paper/hybrid.h"

#include "models/paper/meshing/outline.h"
#include "solvers/paper/meshing/hybrid_mesher.h"

namespace geoprior::paper {

std::unique_ptr<Process> make_hybrid_sheet(const Sheet& sheet, const HybridOptions& options) {
  return std::make_unique<SheetProcess>(with_outline(sheet, options.flat_size), options.stepper,
                                        std::make_unique<HybridMesher>(options));
}

}  // namespace geoprior::paper
