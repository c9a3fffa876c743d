#include "experiments/embryo/scene/options.h"

namespace geoprior::embryo {

void describe(OptionVisitor& v, EmbryoSceneOptions& options) {
  v.value("ontology", options.ontology,
          {.doc = "ontology of the system (.ttl, .nt, .rdf, .owl, .xml)", .named = Named::file});
  v.value("additions", options.additions,
          {.doc = "further files whose triples are added to the ontology's", .named = Named::file});
  v.value("rules", options.rules,
          {.doc = "rules by which consequences follow (.rules)", .named = Named::file});
  v.value("parameter_set", options.parameter_set,
          {.doc = "which of the ontology's parameter sets is taken; empty: what is common to all"});
  v.value("disease", options.disease,
          {.doc = "disease of the ontology, by its local name; absent: healthy"});
  v.value("from_day", options.from_day,
          {.doc = "first day after fertilization; absent: where the data begin", .unit = "d"});
  v.value("to_day", options.to_day,
          {.doc = "last day after fertilization; absent: where the data end", .unit = "d"});
  v.value("frames", options.frames,
          {.doc = "days from the first to the last, evenly spaced, a frame each",
           .min = 1,
           .max = 10000});
  v.value("days", options.days,
          {.doc = "days after fertilization, a frame each, instead of evenly spaced ones",
           .unit = "d"});
  v.value("border_step", options.border_step,
          {.doc = "adds four frames around the middle of each stage, one and two steps before and "
                  "after it, by which jumps of velocities are measured; absent: none",
           .unit = "d",
           .min = 1e-6,
           .max = 0.1});
  v.value("only", options.only,
          {.doc = "local names of the structures that get a surface; empty: all"});
  v.value("copies", options.copies,
          {.doc = "times that the ontology stands in the graph, under other names",
           .min = 1,
           .max = 64});
  v.value("expected", options.expected,
          {.doc = "lists of what each disease is expected to change (.toml), and nothing without "
                  "one; absent: no change is held against a list",
           .named = Named::file});
  v.value("queries", options.queries,
          {.doc = "folder of the viewer's queries in SPARQL, q1.rq to q8.rq, for the method that "
                  "asks them; absent: none is asked",
           .named = Named::folder});
  v.value("count_mistakes", options.count_mistakes,
          {.doc = "whether an ontology with mistakes that leave a model is taken, and they are "
                  "counted; false: every mistake is an error"});
}

}  // namespace geoprior::embryo
