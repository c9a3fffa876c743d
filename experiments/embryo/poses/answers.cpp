#include "experiments/embryo/poses/answers.h"

#include <algorithm>
#include <cstdint>

#include "experiments/embryo/frames/recorded.h"

namespace geoprior::embryo {
namespace {

/// FNV-1a of the rows, which are sorted: equal sets have equal numbers.
std::uint64_t hash_of(const AnswerRows& rows) {
  std::uint64_t hash = 14695981039346656037ull;
  const auto add = [&](unsigned char c) { hash = (hash ^ c) * 1099511628211ull; };
  for (const auto& row : rows) {
    for (const std::string& cell : row) {
      for (const char c : cell) add(static_cast<unsigned char>(c));
      add(0);
    }
    add(1);
  }
  return hash;
}

}  // namespace

ViewerQuestion question_of(const EmbryoScene& scene, double day) {
  ViewerQuestion question;
  question.day = day;
  const Ontology& ontology = scene.ontology;
  const bool has_system = ontology.find_structure(question.system).has_value();
  const bool has_structure = ontology.find_structure(question.structure).has_value();
  for (auto one = ontology.structures.rbegin(); one != ontology.structures.rend(); ++one) {
    if (!has_system && one->crown_rump) question.system = one->name;
    if (!has_structure && !one->develops_from.empty()) question.structure = one->name;
  }
  return question;
}

Frame answer_frame(double day, std::vector<AnswerRows> answers) {
  Frame frame;
  frame.parameter = day;
  FrameTable& table = frame.tables[recorded::kAnswers];
  table.columns = {"query [1]", "rows [1]", "hash_high [1]", "hash_low [1]"};
  table.rows.resize(std::ssize(answers), 4);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    AnswerRows& rows = answers[i];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    const std::uint64_t hash = hash_of(rows);
    table.rows.row(static_cast<Eigen::Index>(i)) << static_cast<double>(i + 1),
        static_cast<double>(rows.size()), static_cast<double>(hash >> 32),
        static_cast<double>(hash & 0xffffffffu);
  }
  return frame;
}

}  // namespace geoprior::embryo
