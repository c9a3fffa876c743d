#include "solvers/embryo/rules/facts.h"

#include <algorithm>
#include <cstdint>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

std::size_t scrambled(const Fact& fact) {
  const std::uint64_t both = (std::uint64_t{static_cast<std::uint32_t>(fact[0])} << 32) |
                             static_cast<std::uint32_t>(fact[1]);
  // Fibonacci hashing (Knuth, TAOCP 3, 6.4): the high bits are the mixed ones.
  const std::uint64_t mixed = both * 0x9E3779B97F4A7C15u;
  return static_cast<std::size_t>(mixed ^ (mixed >> 29));
}

}  // namespace

std::size_t Relation::slot_of(const Fact& fact) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (scrambled(fact) >> 7) & mask;
  while (slots_[slot] >= 0 && tuples_[slots_[slot]] != fact) slot = (slot + 1) & mask;
  return slot;
}

bool Relation::contains(const Fact& fact) const {
  return !slots_.empty() && slots_[slot_of(fact)] >= 0;
}

void Relation::grow() {
  slots_.assign(std::max<std::size_t>(16, 2 * slots_.size()), -1);
  for (int t = 0; t < size(); ++t) slots_[slot_of(tuples_[t])] = t;
}

bool Relation::add(const Fact& fact) {
  if (2 * (tuples_.size() + 1) > slots_.size()) grow();
  const std::size_t slot = slot_of(fact);
  if (slots_[slot] >= 0) return false;
  const int tuple = size();
  slots_[slot] = tuple;
  tuples_.push_back(fact);
  for (int place = 0; place < arity_; ++place)
    if (chains_[place].kept) link(chains_[place], fact[place], tuple);
  return true;
}

void Relation::link(Chains& chains, Term term, int tuple) {
  if (term >= static_cast<int>(chains.first.size()))
    chains.first.resize(std::max<std::size_t>(term + 1, 2 * chains.first.size()), -1);
  chains.older.push_back(chains.first[term]);
  chains.first[term] = tuple;
}

void Relation::index(int place) {
  Chains& chains = chains_[place];
  if (chains.kept) return;
  chains.kept = true;
  Term last = -1;
  for (const Fact& fact : tuples_) last = std::max(last, fact[place]);
  chains.first.assign(last + 1, -1);
  chains.older.reserve(tuples_.size());
  for (int t = 0; t < size(); ++t) link(chains, tuples_[t][place], t);
}

Term Facts::iri(std::string_view text) {
  if (const auto known = dictionary_->find_iri(text)) return *known;
  auto larger = std::make_shared<Dictionary>(*dictionary_);
  const Term term = larger->iri(text);
  dictionary_ = std::move(larger);
  return term;
}

const Relation* Facts::find(std::string_view predicate) const {
  const auto found = std::find(names_.begin(), names_.end(), predicate);
  return found == names_.end() ? nullptr : &relations_[found - names_.begin()];
}

bool Facts::contains(std::string_view predicate, Term term) const {
  const Relation* relation = find(predicate);
  return relation != nullptr && relation->contains({term, -1});
}

bool Facts::contains(std::string_view predicate, Term first, Term second) const {
  const Relation* relation = find(predicate);
  return relation != nullptr && relation->contains({first, second});
}

std::span<const Fact> Facts::tuples(std::string_view predicate) const {
  const Relation* relation = find(predicate);
  return relation == nullptr ? std::span<const Fact>() : relation->tuples();
}

int Facts::size() const {
  int count = 0;
  for (const Relation& relation : relations_) count += relation.size();
  return count;
}

int Facts::predicate(std::string_view name, int arity) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  const int number = static_cast<int>(found - names_.begin());
  if (found == names_.end()) {
    names_.emplace_back(name);
    relations_.emplace_back(arity);
  } else if (relations_[number].arity() != arity) {
    throw Error("predicate '" + std::string(name) + "' with " + std::to_string(arity) +
                    " and with " + std::to_string(relations_[number].arity()) + " places",
                "facts", "one number of places");
  }
  return number;
}

void Facts::add_fact(std::string_view predicate_name, const Fact& fact, int arity) {
  relations_[predicate(predicate_name, arity)].add(fact);
}

}  // namespace geoprior::embryo
