#pragma once

#include "core/options.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/several_views.h"
#include "testbed/topic.h"

namespace geoprior::sketch {

/// How a piece is laid flat.
enum class FlattenBy { rigid, lscm, abf, cgal_arap, cgal_lscm };

/// The input with that flattening. All but ours need discs, so that pieces with holes are cut open
/// for all of them.
SketchInput with_flattening(SketchInput input, FlattenBy by);

/// The surface that is compared on: that of several-views with its defaults, of which only how long
/// it goes on is asked.
struct ComparedSurface {
  int iterations = SeveralViewsOptions{}.iterations;

  [[nodiscard]] SeveralViewsOptions options() const;
};
void describe(OptionVisitor& v, ComparedSurface& options);

/// `flattened`: a whole way from a drawing to a pattern that differs from several-views in how
/// pieces are laid flat. A surface that is given is laid flat as it is.
MethodEntry flattened_method();

}  // namespace geoprior::sketch
