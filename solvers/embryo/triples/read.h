#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "solvers/embryo/triples/graph.h"
#include "solvers/embryo/triples/limits.h"

namespace geoprior::embryo {

enum class RdfFormat { turtle, ntriples, rdfxml };

/// The triples of a file: Turtle and N-Triples by serd, RDF/XML by raptor. Nothing is opened, be it
/// a file or an address: IRIs are names, external entities are refused.
///
/// @param bytes  UTF-8
/// @param where  name of the file, for messages
/// @return       sorted; each triple has the line on which its object ends
/// @throws Error  with file and line: malformed text, a relative IRI without a base, a limit
Graph read_graph(std::string_view bytes, RdfFormat format, const std::string& where,
                 const ReadLimits& limits = {});

/// Adds them to a graph: blank nodes of another file are other nodes. The graph is sorted; after an
/// Error it is of no use.
void read_into(Graph& graph, std::string_view bytes, RdfFormat format, const std::string& where,
               const ReadLimits& limits = {});

/// Of a file's name: .ttl, .nt, .rdf, .owl, .xml. @throws Error  naming the others
RdfFormat format_of(const std::string& file_name);

/// One triple a line, by subject, predicate and object in the order of their terms' numbers.
std::string to_ntriples(const Graph& graph);

}  // namespace geoprior::embryo
