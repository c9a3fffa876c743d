#pragma once

#include <compare>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solvers/embryo/triples/dictionary.h"

namespace geoprior::embryo {

struct Triple {
  Term subject = -1, predicate = -1, object = -1;
  int line = 0;  ///< of all files read, one after the other, from 1 (`Graph::place`); 0: derived
};

/// One position of consecutive triples: what `Graph::objects` and `Graph::subjects` give. It reads
/// the graph's arrays, so that it lasts until the graph is changed.
class TermRange {
 public:
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Term;
    using difference_type = std::ptrdiff_t;
    using pointer = const Term*;
    using reference = Term;

    Iterator() = default;
    Iterator(const Triple* at, Term Triple::*member) : at_(at), member_(member) {}
    Term operator*() const { return at_->*member_; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++at_;
      return before;
    }
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    const Triple* at_ = nullptr;
    Term Triple::*member_ = nullptr;
  };

  TermRange() = default;
  TermRange(std::span<const Triple> triples, Term Triple::*member)
      : triples_(triples), member_(member) {}
  [[nodiscard]] Iterator begin() const { return {triples_.data(), member_}; }
  [[nodiscard]] Iterator end() const { return {triples_.data() + triples_.size(), member_}; }
  [[nodiscard]] bool empty() const { return triples_.empty(); }
  [[nodiscard]] int size() const { return static_cast<int>(triples_.size()); }
  Term operator[](int i) const { return triples_[i].*member_; }

 private:
  std::span<const Triple> triples_;
  Term Triple::*member_ = &Triple::object;
};

/// A set of triples over its own dictionary, with sorted indexes. A value: copies are independent.
///
/// Triples are added in any order; `sort` removes the repeated ones and builds the indexes that all
/// queries read. Queries change nothing and may be asked from several threads. Each costs a look-up
/// and a binary search among the triples of one subject or one predicate.
class Graph {
 public:
  [[nodiscard]] Dictionary& dictionary() { return dictionary_; }
  [[nodiscard]] const Dictionary& dictionary() const { return dictionary_; }

  void add(const Triple& triple);
  void add(Term subject, Term predicate, Term object, int line = 0) {
    add(Triple{subject, predicate, object, line});
  }
  /// Lines that are read from here on are those of a file. @return  how many there were before it
  int begin_file(const std::string& name, int lines);
  /// "file:12" of a triple's line; empty for 0.
  [[nodiscard]] std::string place(int line) const;

  /// Of equal triples the one of the least line that is not 0 stays.
  void sort();
  [[nodiscard]] bool sorted() const { return sorted_; }
  [[nodiscard]] int size() const { return static_cast<int>(by_subject_.size()); }

  // Queries. @throws Error  where triples were added since the last sort

  /// All, by subject, predicate, object.
  [[nodiscard]] std::span<const Triple> triples() const;
  /// Of one subject, by predicate and object.
  [[nodiscard]] std::span<const Triple> of_subject(Term subject) const;
  [[nodiscard]] std::span<const Triple> matching(Term subject, Term predicate) const;
  [[nodiscard]] TermRange objects(Term subject, Term predicate) const;
  [[nodiscard]] TermRange subjects(Term predicate, Term object) const;
  /// Of one predicate, by subject and object.
  [[nodiscard]] std::span<const Triple> with_predicate(Term predicate) const;
  [[nodiscard]] bool contains(Term subject, Term predicate, Term object) const;
  /// The first object; absent where there is none.
  [[nodiscard]] std::optional<Term> object(Term subject, Term predicate) const;
  /// Line of the first triple of both, or 0.
  [[nodiscard]] int line_of(Term subject, Term predicate) const;
  /// Least line of what is said of the subject, or 0.
  [[nodiscard]] int line_of(Term subject) const;

 private:
  void require_sorted() const;

  struct File {
    std::string name;
    int before = 0;  ///< lines of the files before it
  };

  Dictionary dictionary_;
  std::vector<File> files_;
  int lines_ = 0;                     ///< of all files
  std::vector<Triple> by_subject_;    ///< subject, predicate, object
  std::vector<Triple> by_predicate_;  ///< predicate, subject, object
  std::vector<Triple> by_object_;     ///< predicate, object, subject
  std::vector<int> first_subject_;    ///< of a term: its first place in by_subject_
  std::vector<int> first_predicate_;  ///< and in by_predicate_, by_object_
  bool sorted_ = true;
};

}  // namespace geoprior::embryo
