#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/embryo/triples/dictionary.h"

namespace geoprior::embryo {

/// A tuple of terms; of a relation over one term the second is -1.
using Fact = std::array<Term, 2>;

/// The tuples of one predicate, each once, in the order in which they came.
///
/// Membership is a hash table of tuple numbers. An index over a place chains the tuples of equal
/// term, the newest first: a walk over a chain may go on while tuples are added.
class Relation {
 public:
  explicit Relation(int arity) : arity_(arity) {}

  [[nodiscard]] int arity() const { return arity_; }
  [[nodiscard]] int size() const { return static_cast<int>(tuples_.size()); }
  [[nodiscard]] std::span<const Fact> tuples() const { return tuples_; }
  [[nodiscard]] const Fact& operator[](int tuple) const { return tuples_[tuple]; }
  [[nodiscard]] bool contains(const Fact& fact) const;
  /// False where it was there.
  bool add(const Fact& fact);

  /// Makes the index over a place; from then on it is kept.
  void index(int place);
  /// Newest tuple with that term at an indexed place, or -1.
  [[nodiscard]] int newest(int place, Term term) const {
    const std::vector<int>& first = chains_[place].first;
    return term < static_cast<int>(first.size()) ? first[term] : -1;
  }
  /// The next older one, or -1.
  [[nodiscard]] int older(int place, int tuple) const { return chains_[place].older[tuple]; }

 private:
  struct Chains {
    bool kept = false;
    std::vector<int> first;  ///< of a term
    std::vector<int> older;  ///< of a tuple
  };

  [[nodiscard]] std::size_t slot_of(const Fact& fact) const;
  void grow();
  static void link(Chains& chains, Term term, int tuple);

  int arity_;
  std::vector<Fact> tuples_;
  std::vector<int> slots_;  ///< tuple number or -1; a power of two of them
  std::array<Chains, 2> chains_;
};

/// Facts: predicates of one or two places over the terms of a dictionary. A value.
class Facts {
 public:
  Facts() : Facts(std::make_shared<const Dictionary>()) {}
  explicit Facts(std::shared_ptr<const Dictionary> dictionary)
      : dictionary_(std::move(dictionary)) {}

  [[nodiscard]] const Dictionary& dictionary() const { return *dictionary_; }
  /// Number of an IRI, which is added where it is new.
  Term iri(std::string_view text);

  void add(std::string_view predicate, Term term) { add_fact(predicate, {term, -1}, 1); }
  void add(std::string_view predicate, Term first, Term second) {
    add_fact(predicate, {first, second}, 2);
  }
  [[nodiscard]] bool contains(std::string_view predicate, Term term) const;
  [[nodiscard]] bool contains(std::string_view predicate, Term first, Term second) const;
  /// Empty for an unknown predicate.
  [[nodiscard]] std::span<const Fact> tuples(std::string_view predicate) const;
  /// Of all predicates.
  [[nodiscard]] int size() const;

  // By number, in the order in which predicates were met.
  [[nodiscard]] int predicates() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] const std::string& name(int predicate) const { return names_[predicate]; }
  [[nodiscard]] const Relation& relation(int predicate) const { return relations_[predicate]; }
  [[nodiscard]] Relation& relation(int predicate) { return relations_[predicate]; }
  /// @throws Error  where it is known with another number of places
  int predicate(std::string_view name, int arity);

 private:
  [[nodiscard]] const Relation* find(std::string_view predicate) const;
  void add_fact(std::string_view predicate, const Fact& fact, int arity);

  std::shared_ptr<const Dictionary> dictionary_;
  std::vector<std::string> names_;
  std::vector<Relation> relations_;
};

}  // namespace geoprior::embryo
