#include "experiments/embryo/sparql/run_sparql.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "experiments/embryo/sparql/scratch_folder.h"
#include "testbed/home.h"
#include "testbed/view/child_process.h"

namespace geoprior::embryo {
namespace {

namespace fs = std::filesystem;

const std::string kInstallRdflib =
    "apt-get install python3-rdflib, or set GEOPRIOR_PYTHON to an interpreter that has rdflib";

void write_scratch(const fs::path& file, std::string_view bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw Error("cannot be written", file.string(), "a folder for temporary files");
}

std::string read_scratch(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The first python3 on PATH is often another build without Debian's packages.
std::vector<std::string> interpreters() {
  if (const char* chosen = std::getenv("GEOPRIOR_PYTHON"); chosen != nullptr && *chosen != '\0')
    return {chosen};
  return {"/usr/bin/python3", "python3"};
}

/// What run_sparql.py said last: "query NUMBER", or "error KIND NUMBER LINE COLUMN TEXT".
struct LastWords {
  std::string kind;
  int query = 0, line = 0, column = 0;
  std::string text;
};

LastWords last_words(const ChildResult& result) {
  std::vector<std::string> fields(1);
  for (const char c : result.reason()) {
    if (c == '\t')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  if (fields.size() == 2 && fields[0] == "query")
    return {"query", std::atoi(fields[1].c_str()), 0, 0, {}};
  if (fields.size() != 6 || fields[0] != "error") return {"unknown", 0, 0, 0, result.reason()};
  return {fields[1], std::atoi(fields[2].c_str()), std::atoi(fields[3].c_str()),
          std::atoi(fields[4].c_str()), fields[5]};
}

std::string seconds_text(double seconds) {
  std::string text = std::to_string(seconds);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

[[noreturn]] void report(const ChildResult& result, std::span<const SparqlQuery> queries,
                         const SparqlOptions& options) {
  const LastWords last = last_words(result);
  const bool known = last.query >= 0 && last.query < std::ssize(queries);
  const std::string where = known ? queries[last.query].where : "query";
  if (result.exit_code == 128 + SIGALRM)
    throw Error("the query takes longer than " + seconds_text(options.timeout_s), where,
                "a larger timeout_s, or a query that matches less");
  if (last.kind == "memory" || result.exit_code == 128 + SIGKILL)
    throw Error("the query takes more than " + std::to_string(options.memory_mb) + " MB", where,
                "a larger memory_mb, or a query that matches less");
  if (last.kind == "syntax")
    throw Error("syntax error at '" + last.text + "'",
                where + ":" + std::to_string(last.line) + ":" + std::to_string(last.column),
                "a query of SPARQL 1.1");
  if (last.kind == "refused")
    throw Error("the query has " + last.text, where, "SELECT, ASK, CONSTRUCT over the given graph");
  throw Error(last.kind == "query" ? "the engine refuses the query: " + last.text
                                   : "the engine failed: " + last.text,
              where);
}

/// Runs the script with the interpreter that has rdflib.
ChildResult run_engine(const std::vector<std::string>& arguments) {
  const fs::path script = geoprior_home() / "experiments/embryo/sparql/run_sparql.py";
  if (!fs::exists(script)) throw Error("no such script", script.string());
  std::string tried;
  for (const std::string& python : interpreters()) {
    std::vector<std::string> command{python, "-B", "-E", script.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ChildResult result = run_child(command);
    const bool is_absent = result.exit_code == 127 || last_words(result).kind == "absent";
    if (!is_absent) return result;
    tried += (tried.empty() ? "" : "; ") + python + ": " + last_words(result).text;
  }
  throw Error("no Python with rdflib (" + tried + ")", "SPARQL queries", kInstallRdflib);
}

}  // namespace

std::vector<std::string> run_sparql(const std::string& ntriples,
                                    std::span<const SparqlQuery> queries,
                                    const SparqlOptions& options) {
  const ScratchFolder scratch;
  const fs::path graph = scratch.path() / "graph.nt", answers = scratch.path() / "answer";
  write_scratch(graph, ntriples);
  std::vector<std::string> arguments{graph.string(), answers.string(),
                                     options.format == SparqlOptions::Format::csv ? "csv" : "json",
                                     std::to_string(options.timeout_s),
                                     std::to_string(options.memory_mb)};
  for (std::size_t i = 0; i < queries.size(); ++i) {
    arguments.push_back((scratch.path() / ("query." + std::to_string(i))).string());
    write_scratch(arguments.back(), queries[i].text);
  }
  const ChildResult result = run_engine(arguments);
  if (result.exit_code != 0) report(result, queries, options);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < queries.size(); ++i)
    texts.push_back(read_scratch(answers.string() + "." + std::to_string(i)));
  return texts;
}

}  // namespace geoprior::embryo
