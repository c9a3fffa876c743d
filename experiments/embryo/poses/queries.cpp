#include "solvers/embryo/queries/queries.h"

#include "experiments/embryo/poses/answers.h"
#include "experiments/embryo/poses/methods.h"
#include "solvers/embryo/queries/rows.h"
#include "solvers/embryo/rules/program.h"

namespace geoprior::embryo {
namespace {

using Rows = AnswerRows;

/// Times that what takes microseconds is asked in a row, so that the clock sees it.
constexpr int kRepeats = 1000;

/// Reads the ontology, closes it under the rules and answers the viewer's queries, all anew on each
/// day: each is a phase.
class QueryMethod final : public PoseMethod {
 public:
  QueryMethod(const EmbryoScene& scene, const ViewerQueryOptions& options)
      : scene_(scene),
        options_(options),
        copied_(scene.options.copies == 1 ? "" : to_ntriples(scene.graph)) {}

  void solve(double parameter, RunContext& context) override {
    day_ = parameter;
    Graph graph;
    {
      const Phase phase(context, "read");
      graph = load();
    }
    Graph saturated;
    {
      const Phase phase(context, "saturate");
      saturated = saturated_graph(
          graph,
          saturate(parse_rules(scene_.files.rules, scene_.files.rules_where),
                   base_facts(graph, {scene_.options.disease, scene_.options.parameter_set})));
    }
    const ViewerQueries queries(saturated);
    ask_often(queries, context);
    answers_ = all_answers(graph, queries);
  }
  [[nodiscard]] Frame frame() const override { return answer_frame(day_, answers_); }

 private:
  [[nodiscard]] Graph load() const {
    if (scene_.options.copies == 1) return read_graph_of(scene_.files);
    return read_graph(copied_, RdfFormat::ntriples, "copies");
  }

  void ask_often(const ViewerQueries& queries, RunContext& context) {
    const auto system = queries.graph().dictionary().find_local(question_of(scene_, day_).system);
    found_ = 0;
    {
      const Phase phase(context, "path");
      for (int i = 0; i < kRepeats && system; ++i) found_ += queries.parts(*system).size();
    }
    {
      const Phase phase(context, "existence");
      for (int i = 0; i < kRepeats; ++i) found_ += queries.existing(day_).size();
    }
    const Phase phase(context, "bundle");
    for (int i = 0; i < kRepeats; ++i) found_ += queries.bundle(day_).entries.size();
  }

  [[nodiscard]] std::vector<Rows> all_answers(const Graph& graph,
                                              const ViewerQueries& queries) const {
    const ViewerQuestion question = question_of(scene_, day_);
    std::vector<Rows> answers;
    for (int q = 1; q <= kViewerQueries; ++q) answers.push_back(query_rows(queries, q, question));
    if (!options_.levels) return answers;
    answers[2] = to_levels(graph, question.system, "partOf", true);
    answers[3] = to_levels(graph, question.structure, "developsFrom", false);
    return answers;
  }

  [[nodiscard]] Rows to_levels(const Graph& graph, const std::string& start, const char* property,
                               bool downward) const {
    const Dictionary& names = graph.dictionary();
    const auto from = names.find_local(start), by = names.find_local(property);
    Rows rows;
    if (!from || !by) return rows;
    for (const Term term : followed(graph, *from, *by, downward, *options_.levels))
      rows.push_back({names.text(term)});
    return rows;
  }

  const EmbryoScene& scene_;
  ViewerQueryOptions options_;
  std::string copied_;  ///< N-Triples of all copies; empty for one
  double day_ = 0;
  std::size_t found_ = 0;
  std::vector<Rows> answers_;
};

}  // namespace

void describe(OptionVisitor& v, ViewerQueryOptions& options) {
  v.value(
      "levels", options.levels,
      {.doc = "levels that parts and progenitors are followed for, as joins of a fixed depth do; "
              "absent: all",
       .min = 1,
       .max = 10});
}

std::unique_ptr<PoseMethod> make_query_method(const EmbryoScene& scene,
                                              const ViewerQueryOptions& options, RunContext&) {
  return std::make_unique<QueryMethod>(scene, options);
}

}  // namespace geoprior::embryo
