#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "experiments/embryo/scene/scene.h"

namespace geoprior::embryo {

/// The viewer's queries as SPARQL over the saturated graph, by another engine in a process of its
/// own (sparql/run_sparql.h). The scene must outlive the method.
struct SparqlMethodOptions {};
void describe(OptionVisitor& v, SparqlMethodOptions& options);
std::unique_ptr<PoseMethod> make_sparql_method(const EmbryoScene& scene, const SparqlMethodOptions&,
                                               RunContext&);

}  // namespace geoprior::embryo
