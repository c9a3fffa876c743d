#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior::embryo {

/// Number of an RDF term in its dictionary, from 0 in the order in which terms were met.
using Term = int;

inline constexpr std::string_view kNamespace = "urn:geoprior:embryo#";
inline constexpr std::string_view kRdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
inline constexpr std::string_view kRdfs = "http://www.w3.org/2000/01/rdf-schema#";
inline constexpr std::string_view kOwl = "http://www.w3.org/2002/07/owl#";
inline constexpr std::string_view kSkos = "http://www.w3.org/2004/02/skos/core#";
inline constexpr std::string_view kXsd = "http://www.w3.org/2001/XMLSchema#";

/// RDF terms and their numbers: equal terms have one number. A value: copies are independent.
///
/// The index is a table of term numbers with open addressing, so that looking up a term allocates
/// nothing. Numbers stay when terms are added; references to texts do not.
class Dictionary {
 public:
  enum class Kind { iri, literal, blank };

  /// The number of a term, which is added when it is new.
  Term iri(std::string_view text);
  /// A literal without a datatype is an xsd:string, one with a language an rdf:langString.
  Term literal(std::string_view text, std::string_view datatype_iri = {},
               std::string_view language = {});
  Term blank(std::string_view label);

  [[nodiscard]] std::optional<Term> find_iri(std::string_view text) const;
  /// The term of our namespace with that local name: "Ovoid" is urn:geoprior:embryo#Ovoid.
  [[nodiscard]] std::optional<Term> find_local(std::string_view local) const;

  [[nodiscard]] Kind kind(Term term) const { return entries_[term].kind; }
  /// IRI, lexical form or label.
  [[nodiscard]] const std::string& text(Term term) const { return entries_[term].text; }
  /// What follows the last '#', '/' or ':' of an IRI; a literal's text; "_:label" of a blank node.
  [[nodiscard]] std::string local_name(Term term) const;
  /// Whether it is an IRI of our namespace.
  [[nodiscard]] bool is_ours(Term term) const;
  /// IRI of a literal's datatype; empty for other terms.
  [[nodiscard]] std::string datatype(Term term) const;
  /// Of a literal, lower case; empty for most.
  [[nodiscard]] const std::string& language(Term term) const;
  [[nodiscard]] int size() const { return static_cast<int>(entries_.size()); }
  /// Room for so many terms.
  void reserve(int terms);

 private:
  struct Entry {
    std::string text;
    std::uint64_t hash;
    Kind kind;
    int qualifier;  ///< of a literal: into `qualifiers_`; 0 for other terms
  };
  /// Datatype or language of literals: few, found by a walk.
  struct Qualifier {
    std::string datatype, language;
  };

  [[nodiscard]] int find_slot(std::string_view text, Kind kind, int qualifier,
                              std::uint64_t hash) const;
  Term intern(std::string_view text, Kind kind, int qualifier);
  [[nodiscard]] int qualifier_of(std::string_view datatype, std::string_view language);
  void grow(std::size_t slots);

  std::vector<Entry> entries_;
  std::vector<int> slots_;  ///< a term's number, or -1
  std::vector<Qualifier> qualifiers_ = {{}};
};

}  // namespace geoprior::embryo
