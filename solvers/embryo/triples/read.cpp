#include "solvers/embryo/triples/read.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "solvers/embryo/triples/nesting.h"
#include "solvers/embryo/triples/triple_sink.h"

namespace geoprior::embryo {

namespace {

constexpr std::array<std::pair<std::string_view, RdfFormat>, 5> kEndings = {
    {{".nt", RdfFormat::ntriples},
     {".owl", RdfFormat::rdfxml},
     {".rdf", RdfFormat::rdfxml},
     {".ttl", RdfFormat::turtle},
     {".xml", RdfFormat::rdfxml}}};

/// A byte that no text has, and that readers take for the end.
void require_text(std::string_view bytes, const std::string& where) {
  const std::size_t place = bytes.find('\0');
  if (place == std::string_view::npos) return;
  const auto line = 1 + std::ranges::count(bytes.substr(0, place), '\n');
  throw Error("a byte 0", where + ":" + std::to_string(line), "UTF-8 text");
}

void append_code(unsigned char c, std::string& out) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  out.append("\\u00") += kDigits[c >> 4];
  out += kDigits[c & 15];
}

void append_iri(std::string_view text, std::string& out) {
  out += '<';
  for (const char c : text) {
    const bool escaped = static_cast<unsigned char>(c) <= 0x20 ||
                         std::string_view("<>\"{}|^`\\").find(c) != std::string_view::npos;
    if (escaped) {
      append_code(static_cast<unsigned char>(c), out);
    } else {
      out += c;
    }
  }
  out += '>';
}

void append_quoted(std::string_view text, std::string& out) {
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out.append("\\") += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\r') {
      out += "\\r";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      append_code(static_cast<unsigned char>(c), out);
    } else {
      out += c;
    }
  }
  out += '"';
}

void append_term(const Dictionary& dictionary, Term term, std::string& out) {
  const std::string& text = dictionary.text(term);
  if (dictionary.kind(term) == Dictionary::Kind::iri) return append_iri(text, out);
  if (dictionary.kind(term) == Dictionary::Kind::blank) {
    out.append("_:").append(text);
    return;
  }
  append_quoted(text, out);
  const std::string datatype = dictionary.datatype(term);
  if (const std::string& language = dictionary.language(term); !language.empty()) {
    out.append("@").append(language);
  } else if (datatype != std::string(kXsd) + "string") {
    out += "^^";
    append_iri(datatype, out);
  }
}

}  // namespace

Graph read_graph(std::string_view bytes, RdfFormat format, const std::string& where,
                 const ReadLimits& limits) {
  Graph graph;
  read_into(graph, bytes, format, where, limits);
  return graph;
}

void read_into(Graph& graph, std::string_view bytes, RdfFormat format, const std::string& where,
               const ReadLimits& limits) {
  if (bytes.size() > limits.bytes)
    throw Error("a file of " + std::to_string(bytes.size()) + " bytes", where,
                std::to_string(limits.bytes));
  require_text(bytes, where);
  const int known = graph.dictionary().size();
  const std::string blank_prefix = known == 0 ? "" : "n" + std::to_string(known) + "-";
  const auto lines = 1 + std::ranges::count(bytes, '\n');
  TripleSink sink(graph, where, graph.begin_file(where, static_cast<int>(lines)), limits);
  if (format == RdfFormat::rdfxml) {
    require_shallow_xml(bytes, limits.nesting, where);
    read_by_raptor(sink, bytes, blank_prefix);
  } else {
    if (format == RdfFormat::turtle) require_shallow_turtle(bytes, limits.nesting, where);
    read_by_serd(sink, bytes, format == RdfFormat::turtle, blank_prefix);
  }
  sink.rethrow();
  graph.sort();
}

RdfFormat format_of(const std::string& file_name) {
  for (const auto& [ending, format] : kEndings) {
    if (file_name.ends_with(ending)) return format;
  }
  std::string endings;
  for (const auto& entry : kEndings)
    endings += (endings.empty() ? "" : ", ") + std::string(entry.first);
  throw Error("no format of RDF is known by that ending", file_name, endings);
}

std::string to_ntriples(const Graph& graph) {
  std::string out;
  for (const Triple& triple : graph.triples()) {
    append_term(graph.dictionary(), triple.subject, out);
    out += ' ';
    append_term(graph.dictionary(), triple.predicate, out);
    out += ' ';
    append_term(graph.dictionary(), triple.object, out);
    out += " .\n";
  }
  return out;
}

}  // namespace geoprior::embryo
