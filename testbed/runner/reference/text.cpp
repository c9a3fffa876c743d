#include "testbed/runner/reference/text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/error.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/reference/gates.h"

namespace geoprior {
namespace {

constexpr std::size_t kLongestOutcomeLine = 120;

constexpr std::size_t kWidestColumn = 48;
constexpr std::size_t kNarrowestNumber = 13;
constexpr std::size_t kLongestLine = 120;
constexpr int kDigitsOfCost = 2;

/// One number of each variant, absent where it has none.
using RowNumbers = std::vector<std::optional<double>>;

/// A line of a set: what a metric comes to in those cases in which all its numbers agree.
struct Row {
  std::string metric;
  std::vector<std::string> cases;
  RowNumbers numbers;
};

/// A value that no variant has: of a study, or the shortfall of a claim.
struct LoneRow {
  std::string name;
  std::string case_name;
  double value = 0;
};

std::string escaped_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// A word of a line: plain, quoted where that could be misread, "-" where there is none.
std::string word_of(const std::string& text) {
  if (text.empty()) return "-";
  const bool plain = text != "-" && text.find_first_of(" \t\n\"\\") == std::string::npos &&
                     text.front() != '[' && text.front() != '=' && text.front() != '#';
  return plain ? text : escaped_text(text);
}

std::string exact_text(double x) { return std::isnan(x) ? "nan" : number_text(x); }

bool equal_number(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return *a == *b || (std::isnan(*a) && std::isnan(*b));
}

bool equal_numbers(const RowNumbers& a, const RowNumbers& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal_number);
}

/// What the lines of a set are made of, each list in the order of the lines.
struct Table {
  std::vector<std::string> cases;
  std::vector<std::string> variants;
  std::map<std::string, std::string> unit_of;
  std::vector<Row> rows;
  std::vector<LoneRow> lone;
};

void add_unit(Table& table, const std::string& metric, const std::string& unit) {
  const auto [known, first] = table.unit_of.emplace(metric, unit);
  if (first || known->second == unit) return;
  throw Error("has two units", "metric '" + metric + "'", known->second + " or " + unit);
}

/// The row of the metric that has these numbers, a new one if need be.
Row& row_with(std::vector<Row>& rows, const std::string& metric, const RowNumbers& numbers) {
  for (Row& row : rows) {
    if (row.metric == metric && equal_numbers(row.numbers, numbers)) return row;
  }
  return rows.emplace_back(Row{metric, {}, numbers});
}

Table table_of(const ReferenceSet& set) {
  Table table;
  std::set<std::string> variants, metrics;
  visit_values(set, [&](const auto& in, const auto& variant, const auto& name, const auto& value) {
    add_unit(table, name, value.unit);
    if (variant.empty()) {
      table.lone.push_back({name, in, value.value});
      return;
    }
    variants.insert(variant);
    metrics.insert(name);
    if (table.cases.empty() || table.cases.back() != in) table.cases.push_back(in);
  });
  table.variants.assign(variants.begin(), variants.end());
  for (const std::string& metric : metrics) {
    for (const std::string& in : table.cases) {
      RowNumbers numbers;
      for (const std::string& variant : table.variants) {
        const ReferenceValue* value = find_value(set, in, variant, metric);
        numbers.push_back(value == nullptr ? std::nullopt : std::optional(value->value));
      }
      const bool none = std::none_of(numbers.begin(), numbers.end(), [](auto x) { return !!x; });
      if (!none) row_with(table.rows, metric, numbers).cases.push_back(in);
    }
  }
  return table;
}

/// "head word word …", on as many lines as it takes.
std::string wrapped(const std::string& head, const std::vector<std::string>& words) {
  std::string text, line = head;
  for (const std::string& word : words) {
    if (line.size() > head.size() && line.size() + 1 + word.size() > kLongestLine) {
      text += line + "\n";
      line = head;
    }
    line += " " + word;
  }
  return words.empty() ? text : text + line + "\n";
}

std::string units_text(const Table& table) {
  std::map<std::string, std::vector<std::string>> metrics_in;
  for (const auto& [metric, unit] : table.unit_of) metrics_in[unit].push_back(word_of(metric));
  std::string text;
  for (const auto& [unit, metrics] : metrics_in) text += wrapped("unit " + word_of(unit), metrics);
  return text;
}

/// "a|b": one word for several cases.
std::string joined_cases(const std::vector<std::string>& cases) {
  std::string word;
  for (const std::string& in : cases) {
    if (!word.empty()) word += kBetweenCases;
    word += in;
  }
  return word_of(word);
}

std::string cases_word(const Row& row, const Table& table) {
  if (row.cases.size() == table.cases.size()) return std::string(kAllCases);
  return joined_cases(row.cases);
}

/// The text, filled up with spaces, one at least.
void append_column(std::string& line, std::string_view text, std::size_t width) {
  line += text;
  line.append(std::max(width, text.size() + 1) - text.size(), ' ');
}

std::string without_trailing_spaces(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

/// Lines whose columns stand below each other, the names of the variants over their numbers.
std::string rows_text(const Table& table) {
  std::size_t names = 0, cases = 0;
  const auto widen = [](std::size_t& width, std::size_t size) {
    width = std::max(width, std::min(size, kWidestColumn) + 2);
  };
  for (const Row& row : table.rows) {
    widen(names, word_of(row.metric).size());
    widen(cases, cases_word(row, table).size());
  }
  const auto width_of = [&](std::size_t i) {
    return std::max(table.variants[i].size(), kNarrowestNumber) + 2;
  };
  std::string head;
  append_column(head, "variants", 2 + names + cases);
  for (std::size_t i = 0; i < table.variants.size(); ++i) {
    append_column(head, table.variants[i], width_of(i));
  }
  std::string text = table.rows.empty() ? "" : without_trailing_spaces(head);
  for (const Row& row : table.rows) {
    std::string line = "  ";
    append_column(line, word_of(row.metric), names);
    append_column(line, cases_word(row, table), cases);
    for (std::size_t i = 0; i < row.numbers.size(); ++i) {
      append_column(line, row.numbers[i] ? exact_text(*row.numbers[i]) : "-", width_of(i));
    }
    text += without_trailing_spaces(line);
  }
  for (const LoneRow& row : table.lone) {
    text += "  " + word_of(row.name) + " " + word_of(row.case_name) + " = " +
            exact_text(row.value) + "\n";
  }
  return text;
}

std::string content_text(const ContentHash& content) {
  const std::string& on = content.instruction_set;
  if (!content.content.empty()) return "content " + word_of(on) + " " + content.content + "\n";
  return "frames " + word_of(on) + " " + content.frames + "\nmetrics " + content.metrics + "\n";
}

std::string outcomes_text(const Outcomes& outcomes) {
  std::string text;
  for (const auto& [in, variants] : outcomes) {
    std::string line;
    for (const auto& [variant, hash] : variants) {
      const std::string pair = " " + word_of(variant) + " " + hash;
      if (!line.empty() && line.size() + pair.size() > kLongestOutcomeLine) {
        text += line + "\n";
        line.clear();
      }
      if (line.empty()) line = "outcome " + word_of(in);
      line += pair;
    }
    if (!line.empty()) text += line + "\n";
  }
  return text;
}

/// "not-told-apart": an outcome as one word.
std::string outcome_word(ClaimOutcome outcome) {
  std::string word = text_of(outcome);
  std::replace(word.begin(), word.end(), ' ', '-');
  return word;
}

/// A line of a claim: what became of it in those cases in which all of that agrees.
struct ClaimRow {
  std::vector<std::string> cases;
  std::string outcome;
};

/// Cases with the same outcome once, in the order of the first of each.
std::vector<ClaimRow> rows_of_claim(const std::map<std::string, BlessedClaim>& cases) {
  std::vector<ClaimRow> rows;
  for (const auto& [in, one] : cases) {
    const bool graded = one.graded != Graded::not_graded;
    const std::string outcome =
        outcome_word(one.outcome) + (one.excepted ? " excepted " : " - ") + word_of(one.null) +
        " " + (graded ? text_of(one.graded) + " " + number_text(one.least) : "- -");
    const auto known = std::find_if(rows.begin(), rows.end(),
                                    [&](const ClaimRow& row) { return row.outcome == outcome; });
    (known == rows.end() ? rows.emplace_back(ClaimRow{{}, outcome}) : *known).cases.push_back(in);
  }
  return rows;
}

std::string claims_text(const BlessedClaims& claims) {
  std::string text;
  for (const auto& [claim, cases] : claims) {
    for (const ClaimRow& row : rows_of_claim(cases)) {
      text +=
          "claim " + joined_cases(row.cases) + " " + row.outcome + " " + escaped_text(claim) + "\n";
    }
  }
  return text;
}

std::string set_text(const std::string& size, const BlessedSet& set, const Table& table) {
  std::string text = "\nset " + size + "\nblessed " + word_of(set.blessing.commit) + " " +
                     escaped_text(set.blessing.reason) + "\n";
  if (set.content) text += content_text(*set.content);
  if (set.processor_s) text += "cost " + rounded_text(*set.processor_s, kDigitsOfCost) + " s\n";
  text += units_text(table);
  text += wrapped("cases", table.cases);
  return text + rows_text(table) + outcomes_text(set.outcomes) + claims_text(set.claims);
}

}  // namespace

std::string reference_text(const Reference& reference) {
  std::string text(kReferenceFirstLine);
  text += "\n";
  std::size_t rows = 0;
  for (const auto& [size, set] : reference) {
    const Table table = table_of(set.values);
    rows += table.rows.size() + table.lone.size();
    for (const auto& [in, variants] : set.outcomes) rows += variants.size();
    for (const auto& [claim, cases] : set.claims) rows += rows_of_claim(cases).size();
    text += set_text(size, set, table);
  }
  return text + "\nend " + std::to_string(rows) + "\n";
}

}  // namespace geoprior
