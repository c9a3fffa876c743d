#pragma once

#include <span>
#include <string>
#include <vector>

namespace geoprior::embryo {

/// A SPARQL query and the name it goes by in messages.
struct SparqlQuery {
  std::string text;
  std::string where;
};

struct SparqlOptions {
  enum class Format { csv, json };
  Format format = Format::csv;
  double timeout_s = 60;  ///< for reading the graph, and for each query
  int memory_mb = 2000;   ///< address space of the engine
};

/// Answers of SPARQL 1.1 queries over a graph, by rdflib (Debian's python3-rdflib) in a process of
/// its own: no engine in C++ that Debian has is right. Queries only read the graph: SERVICE, FROM,
/// updates and files are refused.
///
/// @param ntriples  the graph; blank nodes come back under their labels
/// @return          one text a query. CSV with a line of names (blank nodes as "_:label"), or
/// SPARQL
///                  1.1 Query Results JSON; triples of CONSTRUCT as rows of three columns
/// @throws Error    naming the query and, of a syntax error, the place; the limit that was
/// exceeded;
///                  the package that is absent
std::vector<std::string> run_sparql(const std::string& ntriples,
                                    std::span<const SparqlQuery> queries,
                                    const SparqlOptions& options);

}  // namespace geoprior::embryo
