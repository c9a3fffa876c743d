#include "solvers/embryo/triples/triple_sink.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace geoprior::embryo {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_letter_or_digit(char c) { return is_letter(c) || (c >= '0' && c <= '9'); }

/// Whether a byte is in no IRI (RFC 3987; the grammar of N-Triples). A table: most of a file's
/// bytes are looked up.
constexpr std::array<bool, 256> kForeignToIris = [] {
  std::array<bool, 256> foreign{};
  for (int c = 0; c <= 0x20; ++c) foreign[c] = true;
  for (const char c : std::string_view("<>\"{}|^`\\"))
    foreign[static_cast<unsigned char>(c)] = true;
  return foreign;
}();

bool is_foreign_to_iris(char c) { return kForeignToIris[static_cast<unsigned char>(c)]; }

/// "urn:", "http:": what an IRI that is not relative begins with.
bool has_scheme(std::string_view iri) {
  const std::size_t colon = iri.find(':');
  if (colon == 0 || colon == std::string_view::npos || !is_letter(iri[0])) return false;
  return std::ranges::all_of(iri.substr(0, colon), [](char c) {
    return is_letter_or_digit(c) || c == '+' || c == '-' || c == '.';
  });
}

/// "en", "de-AT".
bool is_language(std::string_view text) {
  return text.front() != '-' && text.back() != '-' &&
         std::ranges::all_of(text, [](char c) { return c == '-' || is_letter_or_digit(c); });
}

}  // namespace

Term TripleSink::iri(std::string_view text, int line) {
  require_iri(text, line);
  return graph_.dictionary().iri(text);
}

Term TripleSink::literal(std::string_view text, std::string_view datatype,
                         std::string_view language, int line) {
  require_short(text, line);
  if (!datatype.empty()) require_iri(datatype, line);
  if (!language.empty() && !is_language(language))
    refuse("malformed: the language '" + std::string(language) + "'", line);
  return graph_.dictionary().literal(text, datatype, language);
}

Term TripleSink::blank(std::string_view label, int line) {
  require_short(label, line);
  if (label.ends_with('.')) refuse("malformed: a label that ends with a dot", line);
  return graph_.dictionary().blank(label);
}

void TripleSink::add(Term subject, Term predicate, Term object, int line) {
  if (++count_ > limits_.triples) refuse("too many triples", line, std::to_string(limits_.triples));
  graph_.add(subject, predicate, object, before_ + line);
}

void TripleSink::require_short(std::string_view text, int line) const {
  if (text.size() > static_cast<std::size_t>(limits_.text))
    refuse("a text of " + std::to_string(text.size()) + " bytes", line,
           std::to_string(limits_.text));
}

void TripleSink::require_iri(std::string_view text, int line) const {
  require_short(text, line);
  if (std::ranges::any_of(text, is_foreign_to_iris))
    refuse("malformed: the IRI <" + std::string(text) + ">", line);
  if (!has_scheme(text)) refuse("the relative IRI <" + std::string(text) + ">", line, "whole IRIs");
}

void TripleSink::refuse(const std::string& problem, int line, const std::string& allowed) const {
  throw Error(problem, where_ + ":" + std::to_string(line), allowed);
}

}  // namespace geoprior::embryo
