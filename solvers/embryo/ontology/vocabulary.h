#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace geoprior::embryo {

/// A class of our namespace.
struct ClassEntry {
  std::string_view name;
  std::string_view parent;  ///< of the same namespace; empty: none
  bool abstract;            ///< nothing is of it alone: one of its subclasses must be named
  std::string_view meaning;
};

enum class ValueType {
  reference,  ///< a node of the class `range`
  iri,        ///< any name
  text,       ///< any literal
  choice,     ///< one of the texts of `range`, which are separated by blanks
  integer,
  number,
  vector,  ///< a list of `count` numbers; of any multiple of three where that is 0
  boolean
};

/// What a number measures; `of_quantity`: what the measurement's quantity says.
enum class Dimension { ratio, length, angle, day, of_quantity };

enum class Presence {
  optional,      ///< once at most
  required,      ///< once
  any,           ///< as often as one likes
  at_least_once  ///< once or more often
};

enum class Bound { any, positive, not_negative, direction, egg };

/// A property of some classes: what is read, what is checked and what the documentation lists.
struct PropertyEntry {
  std::string_view name;    ///< of our namespace; with a prefix of another one, as "rdfs:label"
  std::string_view domain;  ///< classes, separated by blanks; their subclasses have it too
  ValueType type;
  std::string_view range = {};
  Presence presence = Presence::optional;
  Dimension dimension = Dimension::ratio;
  int count = 1;
  Bound bound = Bound::any;
  std::string_view meaning = {};
};

/// A text that `unit` may have, and what it is in SI units (days for days).
struct Unit {
  std::string_view name;
  Dimension dimension;
  double factor;
};

struct Quantity {
  std::string_view name;
  Dimension dimension;
};

/// The vocabulary, each by name; a property of two meanings has two rows with other domains.
std::span<const ClassEntry> vocabulary_classes();
std::span<const PropertyEntry> vocabulary_properties();
std::span<const Unit> vocabulary_units();
std::span<const Quantity> vocabulary_quantities();

/// Place in `vocabulary_classes`; absent where there is no such class.
std::optional<int> find_class(std::string_view name);
/// Whether a class is another one, or below it.
bool is_subclass(int class_number, int ancestor);
/// Whether one of the texts that are separated by blanks is the word.
bool is_among(std::string_view word, std::string_view texts);
/// "length", as messages call it.
std::string_view name_of(Dimension dimension);

}  // namespace geoprior::embryo
