#include "solvers/embryo/ontology/vocabulary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace geoprior::embryo {
namespace {

std::set<std::string> vocabulary_words(std::string_view texts) {
  std::istringstream in{std::string(texts)};
  std::set<std::string> words;
  for (std::string word; in >> word;) words.insert(word);
  return words;
}

TEST(Vocabulary, NamesOnlyClassesThatItHas) {
  for (const ClassEntry& entry : vocabulary_classes()) {
    if (!entry.parent.empty()) {
      EXPECT_TRUE(find_class(entry.parent)) << entry.name;
    }
  }
  for (const PropertyEntry& row : vocabulary_properties()) {
    for (const std::string& name : vocabulary_words(row.domain))
      EXPECT_TRUE(find_class(name)) << row.name << ": " << name;
    if (row.type == ValueType::reference) {
      EXPECT_TRUE(find_class(row.range)) << row.name;
    }
  }
}

TEST(Vocabulary, GivesAClassOneRowOfAProperty) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const PropertyEntry& row : vocabulary_properties()) {
    for (int c = 0; c < static_cast<int>(vocabulary_classes().size()); ++c) {
      for (const std::string& name : vocabulary_words(row.domain)) {
        if (!is_subclass(c, find_class(name).value())) continue;
        const std::string class_name(vocabulary_classes()[c].name);
        EXPECT_TRUE(seen.emplace(std::string(row.name), class_name).second)
            << row.name << " of " << class_name;
      }
    }
  }
}

TEST(Vocabulary, ChoosesAmongTheUnitsAndQuantitiesOfItsTables) {
  std::set<std::string> units, quantities;
  for (const Unit& unit : vocabulary_units()) units.insert(std::string(unit.name));
  for (const Quantity& quantity : vocabulary_quantities())
    quantities.insert(std::string(quantity.name));
  for (const PropertyEntry& row : vocabulary_properties()) {
    if (row.name == "unit") {
      EXPECT_EQ(vocabulary_words(row.range), units);
    }
    if (row.name == "quantity") {
      EXPECT_EQ(vocabulary_words(row.range), quantities);
    }
  }
}

TEST(Vocabulary, IsInOrderAndSaysWhatEachMeans) {
  const auto ours = [](const PropertyEntry& row) {
    return row.name.find(':') == std::string_view::npos;
  };
  const auto rows = vocabulary_properties();
  const auto end = std::ranges::find_if_not(rows, ours);
  EXPECT_TRUE(std::is_sorted(rows.begin(), end, [](const PropertyEntry& a, const PropertyEntry& b) {
    return a.name < b.name;
  }));
  for (const PropertyEntry& row : rows) EXPECT_TRUE(row.meaning.ends_with('.')) << row.name;
  EXPECT_TRUE(std::ranges::is_sorted(vocabulary_classes(), {}, &ClassEntry::name));
  for (const ClassEntry& entry : vocabulary_classes())
    EXPECT_TRUE(entry.meaning.ends_with('.')) << entry.name;
}

TEST(Vocabulary, KnowsWhatIsBelowAClass) {
  EXPECT_TRUE(is_subclass(*find_class("Ovoid"), *find_class("GeometricalComponent")));
  EXPECT_FALSE(is_subclass(*find_class("GeometricalComponent"), *find_class("Ovoid")));
  EXPECT_FALSE(find_class("Torus"));
  EXPECT_TRUE(is_among("mm", "cm mm"));
  EXPECT_FALSE(is_among("m", "cm mm"));
  EXPECT_FALSE(is_among("", "cm mm"));
}

}  // namespace
}  // namespace geoprior::embryo
