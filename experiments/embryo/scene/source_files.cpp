#include "experiments/embryo/scene/source_files.h"

#include <set>

#include "core/error.h"
#include "solvers/embryo/queries/rows.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/home.h"

namespace geoprior::embryo {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28;

std::filesystem::path find_below(const std::string& name, const std::filesystem::path& folder,
                                 const std::string& key) {
  const auto file = find_file(name, folder, "experiments/embryo", key);
  if (std::filesystem::is_regular_file(file) && std::filesystem::file_size(file) > kMostBytes)
    throw Error("is too large", file.string(), std::to_string(kMostBytes) + " bytes");
  return file;
}

/// The name of a thing in the copy of that number; what has no local name of ours stays.
class Renaming {
 public:
  Renaming(const Graph& from, Graph& to) : from_(from), to_(to) {
    const auto type = from.dictionary().find_iri(std::string(kRdf) + "type");
    for (const Triple& t : from.triples()) renamed_.insert(t.subject);
    for (const char* shared : {"TemporalEntity", "Source"}) {
      const auto name = from.dictionary().find_local(shared);
      if (!name || !type) continue;
      for (const Term each : from.subjects(*type, *name)) renamed_.erase(each);
    }
  }
  Term operator()(Term term, int copy) const {
    const Dictionary& names = from_.dictionary();
    const std::string suffix = "_" + std::to_string(copy);
    switch (names.kind(term)) {
      case Dictionary::Kind::iri:
        return to_.dictionary().iri(renamed_.contains(term) ? names.text(term) + suffix
                                                            : names.text(term));
      case Dictionary::Kind::blank:
        return to_.dictionary().blank(names.text(term) + suffix);
      case Dictionary::Kind::literal:
        break;
    }
    return term;  // literals have the numbers that they had: the copy began as the original
  }

 private:
  const Graph& from_;
  Graph& to_;
  std::set<Term> renamed_;
};

}  // namespace

SourceFiles read_source_files(const EmbryoSceneOptions& options,
                              const std::filesystem::path& folder) {
  SourceFiles files;
  std::vector<std::string> names{options.ontology};
  names.insert(names.end(), options.additions.begin(), options.additions.end());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string key = i == 0 ? "scene.ontology" : "scene.additions." + std::to_string(i - 1);
    const auto file = find_below(names[i], folder, key);
    files.triples.push_back({file.string(), read_text_file(file), format_of(file.string())});
    files.paths.push_back(file);
  }
  const auto rules = find_below(options.rules, folder, "scene.rules");
  files.rules = read_text_file(rules);
  files.rules_where = rules.string();
  files.paths.push_back(rules);
  for (int q = 1; options.queries && q <= kViewerQueries; ++q) {
    const auto query =
        find_below(*options.queries + "/q" + std::to_string(q) + ".rq", folder, "scene.queries");
    files.queries.push_back(read_text_file(query));
    files.paths.push_back(query);
  }
  return files;
}

Graph read_graph_of(const SourceFiles& files) {
  Graph graph;
  for (const SourceFiles::Triples& one : files.triples)
    read_into(graph, one.bytes, one.format, one.where);
  return graph;
}

Graph replicated(const Graph& graph, int copies) {
  Graph all = graph;
  const Renaming renamed(graph, all);
  for (int copy = 2; copy <= copies; ++copy) {
    for (const Triple& t : graph.triples()) {
      all.add(
          {renamed(t.subject, copy), renamed(t.predicate, copy), renamed(t.object, copy), t.line});
    }
  }
  all.sort();
  return all;
}

}  // namespace geoprior::embryo
