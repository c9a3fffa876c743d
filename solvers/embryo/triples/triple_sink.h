#pragma once

#include <exception>
#include <string>
#include <string_view>

#include "solvers/embryo/triples/graph.h"
#include "solvers/embryo/triples/limits.h"

namespace geoprior::embryo {

/// Where the readers put what they read: a graph, within limits. What they let pass though it
/// cannot be written as N-Triples is refused here.
///
/// The libraries are C: no exception may pass through them. The first one is kept, and thrown when
/// they have returned.
class TripleSink {
 public:
  /// @param before  lines of the graph's other files
  TripleSink(Graph& graph, const std::string& where, int before, const ReadLimits& limits)
      : graph_(graph), where_(where), before_(before), limits_(limits) {}

  Term iri(std::string_view text, int line);
  Term literal(std::string_view text, std::string_view datatype, std::string_view language,
               int line);
  Term blank(std::string_view label, int line);
  void add(Term subject, Term predicate, Term object, int line);

  /// Runs what may throw. @return  whether all has gone well so far
  template <class Action>
  bool keep_error(Action action) {
    if (error_) return false;
    try {
      action();
    } catch (...) {
      error_ = std::current_exception();
    }
    return !error_;
  }
  [[nodiscard]] bool failed() const { return error_ != nullptr; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }
  /// "file:12". @throws Error
  [[noreturn]] void refuse(const std::string& problem, int line,
                           const std::string& allowed = {}) const;

 private:
  void require_short(std::string_view text, int line) const;
  void require_iri(std::string_view text, int line) const;

  Graph& graph_;
  const std::string& where_;
  int before_;
  const ReadLimits& limits_;
  int count_ = 0;
  std::exception_ptr error_;
};

/// @param blank_prefix  begins the labels of this file's blank nodes; may be empty
void read_by_serd(TripleSink& sink, std::string_view bytes, bool turtle,
                  const std::string& blank_prefix);
void read_by_raptor(TripleSink& sink, std::string_view bytes, const std::string& blank_prefix);

}  // namespace geoprior::embryo
