#pragma once

#include <memory>
#include <optional>

#include "core/method.h"
#include "core/options.h"
#include "experiments/embryo/scene/scene.h"
#include "solvers/embryo/state/development.h"

namespace geoprior::embryo {

/// Options of the methods, and what makes them of a scene, which must outlive them.
struct OntologyOptions {
  bool rules = true;
  bool healthy = false;
  Interpolation interpolation = Interpolation::monotone;
  int stage_shift = 0;
  int triangles = 2000;
};
void describe(OptionVisitor& v, OntologyOptions& options);
std::unique_ptr<PoseMethod> make_ontology_method(const EmbryoScene& scene,
                                                 const OntologyOptions& options, RunContext&);

struct KeyframesMethodOptions {};
void describe(OptionVisitor& v, KeyframesMethodOptions& options);
std::unique_ptr<PoseMethod> make_keyframes_method(const EmbryoScene& scene,
                                                  const KeyframesMethodOptions&, RunContext&);

struct TableOptions {};
void describe(OptionVisitor& v, TableOptions& options);
std::unique_ptr<PoseMethod> make_table_method(const EmbryoScene& scene, const TableOptions&,
                                              RunContext&);

struct UnionOptions {
  int triangles = 2000;
};
void describe(OptionVisitor& v, UnionOptions& options);
std::unique_ptr<PoseMethod> make_union_method(const EmbryoScene& scene, const UnionOptions& options,
                                              RunContext&);

struct ViewerQueryOptions {
  /// Levels that hierarchies are followed for, as joins of a fixed depth do; absent: all.
  std::optional<int> levels;
};
void describe(OptionVisitor& v, ViewerQueryOptions& options);
std::unique_ptr<PoseMethod> make_query_method(const EmbryoScene& scene,
                                              const ViewerQueryOptions& options, RunContext&);

}  // namespace geoprior::embryo
