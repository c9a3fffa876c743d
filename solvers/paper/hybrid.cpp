#include "solvers/paper/hybrid.h"

#include <algorithm>
#include <cmath>

#include "models/paper/meshing/outline.h"
#include "solvers/paper/meshing/hybrid_mesher.h"

namespace geoprior::paper {
namespace {

/// Longest edges on flat ground and of the guide, in the width of a band: rows of a lattice lie
/// half a root of three of its edge apart and keep half an edge from the border, so that one of
/// them fits between the sides wherever it falls.
const double kOfWidth = 2 / (2 + std::sqrt(3.0));
/// Least part of what was asked for: an outline of notches makes a wide sheet look narrow.
constexpr double kLeastSize = 0.25;

/// A band has room for few edges across: a mesh of longer ones bends in pleats.
HybridOptions fitted(HybridOptions options, const Pattern& pattern) {
  const double most = kOfWidth * band_width(pattern);
  for (double* size : {&options.flat_size, &options.guide_edge})
    *size = std::clamp(most, kLeastSize * *size, *size);
  return options;
}

}  // namespace

std::unique_ptr<Process> make_hybrid_sheet(const Sheet& sheet, const HybridOptions& given) {
  const HybridOptions options = fitted(given, sheet.pattern);
  return std::make_unique<SheetProcess>(with_outline(sheet, options.flat_size), options.stepper,
                                        std::make_unique<HybridMesher>(options));
}

}  // namespace geoprior::paper
