#include "experiments/embryo/sparql.h"

#include "core/error.h"
#include "experiments/embryo/poses/answers.h"
#include "experiments/embryo/sparql/answers.h"
#include "experiments/embryo/sparql/run_sparql.h"
#include "solvers/embryo/queries/rows.h"

namespace geoprior::embryo {
namespace {

class SparqlMethod final : public PoseMethod {
 public:
  explicit SparqlMethod(const EmbryoScene& scene)
      : scene_(scene), ntriples_(to_ntriples(scene.saturated)) {}

  void solve(double parameter, RunContext& context) override {
    const Phase phase(context, "sparql");
    day_ = parameter;
    const ViewerQuestion question = question_of(scene_, day_);
    std::vector<SparqlQuery> queries;
    for (std::size_t q = 0; q < scene_.files.queries.size(); ++q)
      queries.push_back(
          {with_question(scene_.files.queries[q], question), "q" + std::to_string(q + 1) + ".rq"});
    answers_.clear();
    for (const std::string& csv : run_sparql(ntriples_, queries, {}))
      answers_.push_back(sorted_csv_rows(csv));
  }
  [[nodiscard]] Frame frame() const override { return answer_frame(day_, answers_); }

 private:
  const EmbryoScene& scene_;
  std::string ntriples_;
  double day_ = 0;
  std::vector<AnswerRows> answers_;
};

}  // namespace

void describe(OptionVisitor& /*v*/, SparqlMethodOptions& /*options*/) {}

std::unique_ptr<PoseMethod> make_sparql_method(const EmbryoScene& scene, const SparqlMethodOptions&,
                                               RunContext&) {
  if (scene.files.queries.empty())
    throw Error("there is nothing to ask", "scene.queries", "a folder of q1.rq to q8.rq");
  return std::make_unique<SparqlMethod>(scene);
}

}  // namespace geoprior::embryo
