// Good CSV files with what spreadsheets leave open varied at random.

#include <gtest/gtest.h>

#include <optional>

#include "testbed/formats/text/csv_table.h"
#include "tests/support/perturbed.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/formats/perturbed/surface_sample.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::chance;

struct TableRow {
  double x = 0;
  std::string name;
  std::optional<double> weight;
};

/// Writes a table with columns x, name, perhaps weight, and others.
class TableWriter {
 public:
  explicit TableWriter(RandomStream& random) : random_(random) {
    constexpr std::array<const char*, 3> kSeparators{",", ";", "\t"};
    separator_ = kSeparators[random_.below(3)];
    decimal_comma_ = separator_ == ";" && chance(random_, 0.7);
    columns_ = {"x", "name"};
    has_weight_ = chance(random_, 0.7);
    if (has_weight_) columns_.emplace_back("weight");
    if (chance(random_, 0.5)) columns_.emplace_back("notes");
    test::shuffle(random_, columns_);
  }

  std::vector<TableRow> rows;

  std::string write() {
    std::string text = chance(random_, 0.3) ? "# a table; of things, in m\n" : "";
    std::vector<std::string> cells;
    for (const std::string& column : columns_) cells.push_back(cell(in_some_case(column)));
    text += joined_cells(cells);
    const std::uint32_t count = 1 + random_.below(20);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (chance(random_, 0.1)) text += chance(random_, 0.5) ? "\n" : "# 9, 9; 9\n";
      text += row();
    }
    if (chance(random_, 0.3)) text.pop_back();
    return text;
  }

 private:
  std::string in_some_case(std::string text) {
    const std::uint32_t kind = random_.below(3);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (kind == 1 || (kind == 2 && i == 0)) text[i] = static_cast<char>(text[i] - 'a' + 'A');
    }
    return text;
  }

  std::string row() {
    TableRow& now = rows.emplace_back();
    now.x = (static_cast<int>(random_.below(20000)) - 10000) / 64.0;
    now.name = some_text();
    if (has_weight_ && chance(random_, 0.6)) now.weight = random_.below(64) / 64.0;
    std::vector<std::string> cells;
    for (const std::string& column : columns_) {
      if (column == "x") cells.push_back(cell(number(now.x)));
      if (column == "name") cells.push_back(cell(now.name));
      if (column == "weight") cells.push_back(now.weight ? cell(number(*now.weight)) : "");
      if (column == "notes") cells.push_back(cell("7"));
    }
    return joined_cells(cells);
  }

  std::string some_text() {
    constexpr std::array<const char*, 6> kTexts{
        "a", "wide, and; far", "\"quoted\"", "# no comment", "two\nlines", "tab\tbetween"};
    return kTexts[random_.below(kTexts.size())];
  }

  std::string number(double x) {
    std::string text = test::number_text(random_, x);
    if (decimal_comma_ && text.find('.') != std::string::npos && chance(random_, 0.9))
      text[text.find('.')] = ',';
    return text;
  }

  /// In quotes where it must be, and sometimes where it need not.
  std::string cell(const std::string& text) {
    const bool must = text.find_first_of("\"#\n\t" + separator_) != std::string::npos;
    if (!must && !chance(random_, 0.2)) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
  }

  std::string joined_cells(const std::vector<std::string>& cells) {
    std::string text;
    for (const std::string& c : cells) {
      if (!text.empty() || &c != cells.data()) text += separator_;
      if (separator_ != "\t" && chance(random_, 0.1)) text += "  ";
      text += c;
      if (separator_ != "\t" && chance(random_, 0.1)) text += " ";
    }
    if (chance(random_, 0.1)) text += " # said, in passing;";
    return text + "\n";
  }

  RandomStream& random_;
  std::string separator_;
  bool decimal_comma_ = false, has_weight_ = false;
  std::vector<std::string> columns_;
};

using LongPerturbedTables = test::ScratchFolder;

TEST_F(LongPerturbedTables, AreReadRight) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "csv");
    TableWriter writer(random);
    const std::vector<test::TextForm> forms = test::text_forms(writer.write());
    const std::string& text = forms[random.below(5)].bytes;
    const CsvTable table(write("a.csv", text), {"x", "name"}, {"weight"});
    ASSERT_EQ(table.rows().size(), writer.rows.size()) << text;
    for (std::size_t i = 0; i < writer.rows.size(); ++i) {
      EXPECT_EQ(table.number(table.rows()[i], "x"), writer.rows[i].x);
      EXPECT_EQ(table.text(table.rows()[i], "name"), writer.rows[i].name);
      EXPECT_EQ(table.number(table.rows()[i], "weight"), writer.rows[i].weight);
    }
    if (::testing::Test::HasFailure()) FAIL() << text;
  }
}

}  // namespace
}  // namespace geoprior
