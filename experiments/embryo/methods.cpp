#include "experiments/embryo/poses/methods.h"

#include "experiments/embryo/sparql.h"
#include "experiments/embryo/topic.h"

namespace geoprior::embryo {

std::vector<MethodEntry> methods() {
  using S = EmbryoScene;
  return {
      method_entry<S, OntologyOptions>(
          "development", false,
          "the state of a day that an ontology and its rules give, as a surface a structure",
          "thesis 2.3; Rabattu et al. 2015", make_ontology_method),
      method_entry<S, KeyframesMethodOptions>(
          "keyframes", true, "meshes of the healthy stages, interpolated vertex by vertex",
          "key frames of an atlas, as in de Bakker et al. 2016", make_keyframes_method),
      method_entry<S, TableOptions>(
          "direct-table", true,
          "the same system as a table of C++ with a function for each disease",
          "a program without ontology and rules", make_table_method),
      method_entry<S, UnionOptions>("plain-union", true, "the surface of a union without blends",
                                    "Lorensen and Cline 1987", make_union_method),
      method_entry<S, ViewerQueryOptions>("queries", false,
                                          "the viewer's queries as joins over the saturated graph",
                                          "thesis 2.3", make_query_method),
      method_entry<S, SparqlMethodOptions>("sparql", true,
                                           "the same queries as SPARQL, answered by rdflib",
                                           "SPARQL 1.1; rdflib", make_sparql_method),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  DiagnosticTable table;
  table.unmeasured(
      "a process has no surface: what it does to structures is measured",
      {{"active_processes", "1", "processes that are under way on the day and active"}});
  return table.rows();
}

}  // namespace geoprior::embryo
