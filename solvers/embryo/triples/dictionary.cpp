#include "solvers/embryo/triples/dictionary.h"

namespace geoprior::embryo {

namespace {

constexpr std::size_t kFirstSlots = 64;

/// FNV-1a over eight bytes at a time, with a final mix: texts of one namespace differ late.
std::uint64_t hash_of_term(std::string_view text, int salt) {
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ (static_cast<std::uint64_t>(salt) << 32);
  for (; text.size() >= 8; text.remove_prefix(8)) {
    std::uint64_t word = 0;
    text.copy(reinterpret_cast<char*>(&word), 8);
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29;
  }
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  hash ^= hash >> 32;
  return hash * 0x9e3779b97f4a7c15ULL;
}

int salt_of(Dictionary::Kind kind, int qualifier) { return 3 * qualifier + static_cast<int>(kind); }

}  // namespace

Term Dictionary::iri(std::string_view text) { return intern(text, Kind::iri, 0); }

Term Dictionary::blank(std::string_view label) { return intern(label, Kind::blank, 0); }

Term Dictionary::literal(std::string_view text, std::string_view datatype_iri,
                         std::string_view language) {
  return intern(text, Kind::literal, qualifier_of(datatype_iri, language));
}

std::optional<Term> Dictionary::find_iri(std::string_view text) const {
  if (slots_.empty()) return std::nullopt;
  const int term = slots_[find_slot(text, Kind::iri, 0, hash_of_term(text, salt_of(Kind::iri, 0)))];
  if (term < 0) return std::nullopt;
  return term;
}

std::optional<Term> Dictionary::find_local(std::string_view local) const {
  return find_iri(std::string(kNamespace).append(local));
}

std::string Dictionary::local_name(Term term) const {
  const std::string& text = entries_[term].text;
  if (kind(term) == Kind::literal) return text;
  if (kind(term) == Kind::blank) return "_:" + text;
  const std::size_t hash = text.rfind('#');
  const std::size_t end = hash != std::string::npos ? hash : text.find_last_of("/:");
  return end == std::string::npos ? text : text.substr(end + 1);
}

bool Dictionary::is_ours(Term term) const {
  return kind(term) == Kind::iri && text(term).starts_with(kNamespace);
}

std::string Dictionary::datatype(Term term) const {
  if (kind(term) != Kind::literal) return {};
  return qualifiers_[entries_[term].qualifier].datatype;
}

const std::string& Dictionary::language(Term term) const {
  return qualifiers_[entries_[term].qualifier].language;
}

void Dictionary::reserve(int terms) {
  entries_.reserve(terms);
  std::size_t slots = kFirstSlots;
  while (slots < 2 * static_cast<std::size_t>(terms)) slots *= 2;
  if (slots > slots_.size()) grow(slots);
}

int Dictionary::find_slot(std::string_view text, Kind kind, int qualifier,
                          std::uint64_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t slot = hash & mask;; slot = (slot + 1) & mask) {
    if (slots_[slot] < 0) return static_cast<int>(slot);
    const Entry& entry = entries_[slots_[slot]];
    if (entry.hash == hash && entry.kind == kind && entry.qualifier == qualifier &&
        entry.text == text)
      return static_cast<int>(slot);
  }
}

Term Dictionary::intern(std::string_view text, Kind kind, int qualifier) {
  if (2 * (entries_.size() + 1) > slots_.size())
    grow(slots_.empty() ? kFirstSlots : 2 * slots_.size());
  const std::uint64_t hash = hash_of_term(text, salt_of(kind, qualifier));
  int& slot = slots_[find_slot(text, kind, qualifier, hash)];
  if (slot < 0) {
    slot = size();
    entries_.push_back({std::string(text), hash, kind, qualifier});
  }
  return slot;
}

int Dictionary::qualifier_of(std::string_view datatype, std::string_view language) {
  std::string lower;
  for (const char c : language) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  std::string of_language;
  if (!lower.empty()) of_language = std::string(kRdf) + "langString";
  if (datatype.empty() && lower.empty()) of_language = std::string(kXsd) + "string";
  if (!of_language.empty()) datatype = of_language;
  for (int i = 1; i < static_cast<int>(qualifiers_.size()); ++i) {
    if (qualifiers_[i].datatype == datatype && qualifiers_[i].language == lower) return i;
  }
  qualifiers_.push_back({std::string(datatype), lower});
  return static_cast<int>(qualifiers_.size()) - 1;
}

void Dictionary::grow(std::size_t slots) {
  slots_.assign(slots, -1);
  for (int term = 0; term < size(); ++term) {
    std::size_t slot = entries_[term].hash & (slots - 1);
    while (slots_[slot] >= 0) slot = (slot + 1) & (slots - 1);
    slots_[slot] = term;
  }
}

}  // namespace geoprior::embryo
