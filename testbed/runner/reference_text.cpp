#include "testbed/runner/reference_text.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "core/error.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

constexpr std::size_t kWidestColumn = 48;
constexpr std::size_t kNumberColumn = 13;
constexpr std::size_t kUnitLine = 120;

/// Metric, variant, case: the order of the lines, in which the variants of a metric lie together.
using RowName = std::tuple<std::string, std::string, std::string>;

/// A line of a set: one value of a sequence, or four of frames.
struct Row {
  std::vector<double> values;  ///< one, or min, median, max, last
  std::string unit;
  int blessing = 0;
};

bool is_one_value(const std::string& name) {
  return name.find(':') != std::string::npos || name.find('.') == std::string::npos;
}

bool constant(const Row& row) {
  return row.values.size() == kReferenceStatistics.size() &&
         std::all_of(row.values.begin(), row.values.end(), [&](double x) {
           return x == row.values.front() || (std::isnan(x) && std::isnan(row.values.front()));
         });
}

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

/// The numbers of blessings: those that the file has, and new ones behind them.
class BlessingNumbers {
 public:
  explicit BlessingNumbers(const std::map<int, Blessing>& known) : known_(known) {}

  int of(const ReferenceValue& value) {
    for (const auto& [number, blessing] : known_) {
      if (blessing.commit == value.commit && blessing.reason == value.reason) return number;
    }
    const int next = known_.empty() ? 1 : known_.rbegin()->first + 1;
    known_[next] = {value.commit, value.reason};
    return next;
  }

  /// Those that are left out are forgotten.
  [[nodiscard]] std::string text(const std::set<int>& used) const {
    std::string lines;
    for (const int number : used) {
      const Blessing& blessing = known_.at(number);
      lines += "[" + std::to_string(number) + "] " + word_of(blessing.commit) + " " +
               escaped_text(blessing.reason) + "\n";
    }
    return lines;
  }

 private:
  std::map<int, Blessing> known_;
};

using Rows = std::map<RowName, Row>;

/// The place of a value in its row; @throws Error where the row has another form.
double& place_in(Row& row, const std::string& suffix, const RowName& name) {
  const auto statistic =
      std::find(kReferenceStatistics.begin(), kReferenceStatistics.end(), suffix);
  const std::size_t size = suffix.empty() ? 1 : kReferenceStatistics.size();
  if (!suffix.empty() && statistic == kReferenceStatistics.end()) {
    throw Error("has the statistic '" + suffix + "'", "metric '" + std::get<0>(name) + "'",
                ".min, .median, .max, .last");
  }
  if (row.values.empty()) row.values.assign(size, 0);
  if (row.values.size() != size) {
    throw Error("is of frames and of the sequence", "metric '" + std::get<0>(name) + "'");
  }
  return suffix.empty()
             ? row.values.front()
             : row.values[static_cast<std::size_t>(statistic - kReferenceStatistics.begin())];
}

Rows rows_of(const ReferenceSet& set, BlessingNumbers& numbers) {
  Rows rows;
  std::map<RowName, std::size_t> filled;
  for (const auto& [in, variants] : set) {
    for (const auto& [variant, values] : variants) {
      for (const auto& [full_name, value] : values) {
        const std::size_t dot = is_one_value(full_name) ? full_name.size() : full_name.rfind('.');
        const RowName name{full_name.substr(0, dot), variant, in};
        Row& row = rows[name];
        place_in(row, full_name.substr(dot), name) = value.value;
        row.unit = value.unit;
        // One mark a line: that of its youngest value.
        row.blessing = std::max(row.blessing, numbers.of(value));
        ++filled[name];
      }
    }
  }
  for (const auto& [name, row] : rows) {
    if (filled[name] == row.values.size()) continue;
    throw Error("has not all of min, median, max and last", "metric '" + std::get<0>(name) + "'");
  }
  return rows;
}

int most_frequent_blessing(const Rows& rows) {
  std::map<int, std::size_t> count;
  for (const auto& [name, row] : rows) ++count[row.blessing];
  const auto most = std::max_element(
      count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? 0 : most->first;
}

std::string units_text(const Rows& rows) {
  std::map<std::string, std::string> unit_of;
  for (const auto& [name, row] : rows) {
    const std::string& metric = std::get<0>(name);
    const auto [known, first] = unit_of.emplace(metric, row.unit);
    if (!first && known->second != row.unit) {
      throw Error("has two units", "metric '" + metric + "'", known->second + " or " + row.unit);
    }
  }
  std::map<std::string, std::vector<std::string>> metrics_in;
  for (const auto& [metric, unit] : unit_of) metrics_in[unit].push_back(metric);
  std::string text;
  for (const auto& [unit, metrics] : metrics_in) {
    const std::string head = "unit " + word_of(unit);
    std::string line = head;
    for (const std::string& metric : metrics) {
      const std::string word = " " + word_of(metric);
      if (line.size() > head.size() && line.size() + word.size() > kUnitLine) {
        text += line + "\n";
        line = head;
      }
      line += word;
    }
    text += line + "\n";
  }
  return text;
}

using Widths = std::array<std::size_t, 3>;
constexpr std::array<std::string_view, 3> kNameColumns{"metric", "variant", "case"};

Widths widths_of(const Rows& rows) {
  Widths widths{};
  const auto widen = [](std::size_t& width, std::size_t size) {
    width = std::max(width, std::min(size, kWidestColumn) + 2);
  };
  for (std::size_t i = 0; i < widths.size(); ++i) widen(widths[i], kNameColumns[i].size());
  for (const auto& [name, row] : rows) {
    widen(widths[0], word_of(std::get<0>(name)).size());
    widen(widths[1], word_of(std::get<1>(name)).size());
    widen(widths[2], word_of(std::get<2>(name)).size());
  }
  return widths;
}

/// The text, filled up with spaces, one at least.
void append_column(std::string& line, std::string_view text, std::size_t width) {
  line += text;
  line.append(std::max(width, text.size() + 1) - text.size(), ' ');
}

/// A comment over the columns.
std::string heading_text(const Widths& widths) {
  std::string line = "# ";
  for (std::size_t i = 0; i < widths.size(); ++i) append_column(line, kNameColumns[i], widths[i]);
  for (const std::string_view statistic : kReferenceStatistics) {
    append_column(line, statistic.substr(1), kNumberColumn);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string row_text(const RowName& name, const Row& row, const Widths& widths,
                     int usual_blessing) {
  std::string line = "  ";
  append_column(line, word_of(std::get<0>(name)), widths[0]);
  append_column(line, word_of(std::get<1>(name)), widths[1]);
  append_column(line, word_of(std::get<2>(name)), widths[2]);
  if (constant(row)) {
    line += "= " + exact_text(row.values.front());
  } else {
    for (const double value : row.values) append_column(line, exact_text(value), kNumberColumn);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  if (row.blessing != usual_blessing) line += "  [" + std::to_string(row.blessing) + "]";
  return line + "\n";
}

std::string set_text(const std::string& size, const Rows& rows, const ContentHash* content) {
  const int blessing = most_frequent_blessing(rows);
  std::string text = "\nset " + size;
  if (!rows.empty()) text += " [" + std::to_string(blessing) + "]";
  text += "\n";
  if (content != nullptr) {
    text += "content " + word_of(content->instruction_set) + " " + content->sha256 + "\n";
  }
  text += units_text(rows);
  const Widths widths = widths_of(rows);
  if (!rows.empty()) text += heading_text(widths);
  for (const auto& [name, row] : rows) text += row_text(name, row, widths, blessing);
  return text;
}

}  // namespace

std::string reference_text(const Reference& reference) {
  BlessingNumbers numbers(reference.blessings);
  std::set<int> used;
  std::string sets;
  for (const auto& [size, set] : reference.sets) {
    const Rows rows = rows_of(set, numbers);
    for (const auto& [name, row] : rows) used.insert(row.blessing);
    const auto content = reference.contents.find(size);
    sets += set_text(size, rows, content == reference.contents.end() ? nullptr : &content->second);
  }
  std::string text(kReferenceFirstLine);
  return text.append("\n").append(numbers.text(used)).append(sets);
}

}  // namespace geoprior
