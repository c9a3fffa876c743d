#include "experiments/embryo/sparql/answers.h"

#include <algorithm>
#include <cstdio>

namespace geoprior::embryo {
namespace {

/// Puts `value` between the texts where they enclose something.
void replace_between(std::string& text, std::string_view before, std::string_view after,
                     const std::string& value) {
  const std::size_t begin = text.find(before);
  if (begin == std::string::npos) return;
  const std::size_t from = begin + before.size(), end = text.find(after, from);
  if (end != std::string::npos) text.replace(from, end - from, value);
}

/// As a decimal of SPARQL: with a point and without an exponent.
std::string decimal(double number) {
  char text[64];
  std::snprintf(text, sizeof text, "%.12f", number);
  std::string out = text;
  out.erase(std::max(out.find_last_not_of('0'), out.find('.') + 1) + 1);
  return out;
}

}  // namespace

std::vector<std::vector<std::string>> sorted_csv_rows(std::string_view csv) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    const bool is_doubled = is_quoted && c == '"' && i + 1 < csv.size() && csv[i + 1] == '"';
    if (is_doubled) ++i;
    if (c == '"' && !is_doubled) {
      is_quoted = !is_quoted;
    } else if (!is_quoted && c == ',') {
      row.emplace_back();
    } else if (!is_quoted && c == '\n') {
      rows.push_back(std::move(row));
      row.assign(1, {});
    } else {
      row.back() += c;
    }
  }
  if (!rows.empty()) rows.erase(rows.begin());
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::string with_question(std::string query, const ViewerQuestion& question) {
  replace_between(query, "BIND (", " AS ?day)", decimal(question.day));
  replace_between(query, "VALUES ?structure { e:", " }", question.structure);
  replace_between(query, "VALUES ?system { e:", " }", question.system);
  return query;
}

}  // namespace geoprior::embryo
