#include "solvers/embryo/triples/graph.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace geoprior::embryo {

namespace {

using Member = Term Triple::*;

/// Of each term the place that its first triple has among those sorted by the member; the end last.
std::vector<int> firsts(Member member, int terms, const std::vector<Triple>& triples) {
  std::vector<int> first(terms + 1, 0);
  for (const Triple& triple : triples) ++first[triple.*member + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  return first;
}

/// A stable sort by counting, in linear time.
void sort_by(Member member, int terms, std::vector<Triple>& triples, std::vector<Triple>& scratch) {
  std::vector<int> next = firsts(member, terms, triples);
  scratch.resize(triples.size());
  for (const Triple& triple : triples) scratch[next[triple.*member]++] = triple;
  triples.swap(scratch);
}

bool same_terms(const Triple& a, const Triple& b) {
  return a.subject == b.subject && a.predicate == b.predicate && a.object == b.object;
}

/// Of sorted triples: the equal ones become one, with the least line that is not 0.
void remove_repeated(std::vector<Triple>& triples) {
  std::size_t kept = 0;
  for (const Triple& triple : triples) {
    if (kept == 0 || !same_terms(triples[kept - 1], triple)) {
      triples[kept++] = triple;
    } else if (int& line = triples[kept - 1].line; triple.line > 0) {
      line = line > 0 ? std::min(line, triple.line) : triple.line;
    }
  }
  triples.resize(kept);
}

std::span<const Triple> of_term(const std::vector<Triple>& triples, const std::vector<int>& first,
                                Term term) {
  if (term < 0 || term + 1 >= static_cast<int>(first.size())) return {};
  return std::span(triples).subspan(first[term], first[term + 1] - first[term]);
}

/// Of triples that are sorted by the member: those of one value.
std::span<const Triple> of_value(std::span<const Triple> triples, Member member, Term value) {
  const auto range = std::ranges::equal_range(triples, value, {}, member);
  return {range.begin(), range.end()};
}

int least_line(std::span<const Triple> triples) {
  int least = 0;
  for (const Triple& triple : triples) {
    if (triple.line > 0 && (least == 0 || triple.line < least)) least = triple.line;
  }
  return least;
}

}  // namespace

void Graph::add(const Triple& triple) {
  const auto known = [this](Term term) { return term >= 0 && term < dictionary_.size(); };
  if (!known(triple.subject) || !known(triple.predicate) || !known(triple.object))
    throw Error("a triple with a term that is not in the graph's dictionary");
  by_subject_.push_back(triple);
  sorted_ = false;
}

int Graph::begin_file(const std::string& name, int lines) {
  files_.push_back({name, lines_});
  lines_ += lines;
  return files_.back().before;
}

std::string Graph::place(int line) const {
  const auto after = std::ranges::lower_bound(files_, line, {}, &File::before);
  if (line <= 0 || after == files_.begin()) return {};
  const File& file = *(after - 1);
  return file.name + ":" + std::to_string(line - file.before);
}

void Graph::sort() {
  if (sorted_) return;
  const int terms = dictionary_.size();
  std::vector<Triple> scratch;
  // Each pass is stable: what is equal in its member keeps the order of the passes before.
  sort_by(&Triple::object, terms, by_subject_, scratch);
  sort_by(&Triple::predicate, terms, by_subject_, scratch);
  sort_by(&Triple::subject, terms, by_subject_, scratch);
  remove_repeated(by_subject_);
  first_subject_ = firsts(&Triple::subject, terms, by_subject_);
  first_predicate_ = firsts(&Triple::predicate, terms, by_subject_);
  by_predicate_ = by_subject_;
  sort_by(&Triple::predicate, terms, by_predicate_, scratch);
  by_object_ = by_subject_;
  sort_by(&Triple::object, terms, by_object_, scratch);
  sort_by(&Triple::predicate, terms, by_object_, scratch);
  sorted_ = true;
}

std::span<const Triple> Graph::triples() const {
  require_sorted();
  return by_subject_;
}

std::span<const Triple> Graph::of_subject(Term subject) const {
  require_sorted();
  return of_term(by_subject_, first_subject_, subject);
}

std::span<const Triple> Graph::matching(Term subject, Term predicate) const {
  return of_value(of_subject(subject), &Triple::predicate, predicate);
}

TermRange Graph::objects(Term subject, Term predicate) const {
  return {matching(subject, predicate), &Triple::object};
}

TermRange Graph::subjects(Term predicate, Term object) const {
  require_sorted();
  return {of_value(of_term(by_object_, first_predicate_, predicate), &Triple::object, object),
          &Triple::subject};
}

std::span<const Triple> Graph::with_predicate(Term predicate) const {
  require_sorted();
  return of_term(by_predicate_, first_predicate_, predicate);
}

bool Graph::contains(Term subject, Term predicate, Term object) const {
  return !of_value(matching(subject, predicate), &Triple::object, object).empty();
}

std::optional<Term> Graph::object(Term subject, Term predicate) const {
  const std::span<const Triple> found = matching(subject, predicate);
  if (found.empty()) return std::nullopt;
  return found.front().object;
}

int Graph::line_of(Term subject, Term predicate) const {
  return least_line(matching(subject, predicate));
}

int Graph::line_of(Term subject) const { return least_line(of_subject(subject)); }

void Graph::require_sorted() const {
  if (!sorted_) throw Error("the graph has triples that were added since it was sorted");
}

}  // namespace geoprior::embryo
