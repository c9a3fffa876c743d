#include "testbed/runner/reference_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>
#include <tuple>

#include "core/error.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

constexpr std::string_view kFirstLine = "geoprior reference 3";
constexpr std::array<std::string_view, 4> kStatistics{".min", ".median", ".max", ".last"};
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
  return row.values.size() == kStatistics.size() &&
         std::all_of(row.values.begin(), row.values.end(), [&](double x) {
           return x == row.values.front() || (std::isnan(x) && std::isnan(row.values.front()));
         });
}

std::string in_quotes(const std::string& text) {
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
  return plain ? text : in_quotes(text);
}

std::string exact_text(double x) { return std::isnan(x) ? "nan" : number_text(x); }

// ---------------------------------------------------------------------------------- writing

/// BlessingNumbers of blessings: those that the file has, and new ones behind them.
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
               in_quotes(blessing.reason) + "\n";
    }
    return lines;
  }

 private:
  std::map<int, Blessing> known_;
};

using Rows = std::map<RowName, Row>;

/// The place of a value in its row; @throws Error where the row has another form.
double& place_in(Row& row, const std::string& suffix, const RowName& name) {
  const auto statistic = std::find(kStatistics.begin(), kStatistics.end(), suffix);
  const std::size_t size = suffix.empty() ? 1 : kStatistics.size();
  if (!suffix.empty() && statistic == kStatistics.end()) {
    throw Error("has the statistic '" + suffix + "'", "metric '" + std::get<0>(name) + "'",
                ".min, .median, .max, .last");
  }
  if (row.values.empty()) row.values.assign(size, 0);
  if (row.values.size() != size) {
    throw Error("is of frames and of the sequence", "metric '" + std::get<0>(name) + "'");
  }
  return suffix.empty() ? row.values.front()
                        : row.values[static_cast<std::size_t>(statistic - kStatistics.begin())];
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
  for (const std::string_view statistic : kStatistics) {
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

// ---------------------------------------------------------------------------------- reading

struct Word {
  std::string text;
  bool is_quoted = false;
};

/// Reads one line after the other; what is wrong is said with its number.
class Parser {
 public:
  Parser(const std::string& text, std::string source) : in_(text), source_(std::move(source)) {}

  Reference read() {
    next_line();
    if (line_ != kFirstLine) fail("is no reference file of this form", std::string(kFirstLine));
    while (next_line()) {
      if (line_.empty() || line_.front() == '#') continue;
      const bool is_row = line_.starts_with("  ");
      words_ = words();
      if (words_.empty()) fail("is blank but for spaces", "an empty line");
      is_row ? read_row() : read_head();
    }
    return std::move(reference_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& allowed = {}) const {
    throw Error(what, source_ + ":" + std::to_string(number_), allowed);
  }

  bool next_line() {
    ++number_;
    return static_cast<bool>(std::getline(in_, line_));
  }

  [[nodiscard]] std::vector<Word> words() const {
    std::vector<Word> words;
    std::size_t at = 0;
    while ((at = line_.find_first_not_of(' ', at)) != std::string::npos) {
      words.push_back(line_[at] == '"' ? quoted_word(at) : plain_word(at));
    }
    return words;
  }

  Word plain_word(std::size_t& at) const {
    const std::size_t end = std::min(line_.find(' ', at), line_.size());
    Word word{line_.substr(at, end - at), false};
    if (word.text.find_first_of("\"\t\r") != std::string::npos) {
      fail("'" + word.text + "' has a quote or a tab", "spaces between words, quotes around them");
    }
    at = end;
    return word;
  }

  Word quoted_word(std::size_t& at) const {
    Word word{"", true};
    for (++at; at < line_.size() && line_[at] != '"'; ++at) {
      if (line_[at] == '\\' && ++at < line_.size() && line_[at] == 'n') {
        word.text += '\n';
      } else if (at < line_.size()) {
        word.text += line_[at];
      }
    }
    if (at >= line_.size()) fail("a quote is not closed");
    ++at;
    return word;
  }

  /// "-" is none; what is quoted is itself.
  static std::string name_of(const Word& word) {
    return !word.is_quoted && word.text == "-" ? std::string() : word.text;
  }

  static bool is_mark(const Word& word) {
    return !word.is_quoted && word.text.size() > 2 && word.text.front() == '[' &&
           word.text.back() == ']';
  }

  [[nodiscard]] int mark_of(const Word& word) const {
    int number = 0;
    const char* begin = word.text.data() + 1;
    const char* end = word.text.data() + word.text.size() - 1;
    const auto [stop, error] = std::from_chars(begin, end, number);
    if (!is_mark(word) || error != std::errc{} || stop != end || number < 1) {
      fail("'" + word.text + "' is no mark of a blessing", "[1], [2], …");
    }
    return number;
  }

  [[nodiscard]] double number_of(const Word& word) const {
    double value = 0;
    const char* end = word.text.data() + word.text.size();
    const auto [stop, error] = std::from_chars(word.text.data(), end, value);
    if (word.is_quoted || error != std::errc{} || stop != end) {
      fail("'" + word.text + "' is no number", "a number, nan, inf or -inf");
    }
    return value;
  }

  void read_head() {
    if (is_mark(words_.front())) return read_blessing();
    const std::string& first = words_.front().text;
    if (first == "set") return read_set();
    if (first == "content") return read_content();
    if (first == "unit") return read_unit();
    fail("'" + first + "' begins no line",
         "[n], set, content, unit, or two spaces before the line of a metric");
  }

  void read_blessing() {
    const int number = mark_of(words_.front());
    if (set_ != nullptr) fail("a blessing is listed before the sets");
    if (words_.size() != 3 || !words_[2].is_quoted) {
      fail("is no blessing", "[n] commit \"reason\"");
    }
    if (!reference_.blessings.emplace(number, Blessing{name_of(words_[1]), words_[2].text}).second)
      fail("blessing " + words_.front().text + " is there twice");
  }

  void read_set() {
    if (words_.size() < 2 || words_.size() > 3) fail("is no set", "set full [n], set quick [n]");
    const std::string& size = words_[1].text;
    if (size != "full" && size != "quick") fail("there is no set '" + size + "'", "full, quick");
    if (reference_.sets.contains(size)) fail("set " + size + " is there twice");
    size_ = size;
    set_ = &reference_.sets[size];
    usual_ = words_.size() == 3 ? &blessing(words_[2]) : nullptr;
    units_.clear();
  }

  void read_content() {
    if (set_ == nullptr) fail("belongs to no set", "after the line of a set");
    const bool is_hash = words_.size() == 3 && words_[2].text.size() == 64 &&
                         words_[2].text.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!is_hash) fail("is no hash", "content, the instruction set, 64 hexadecimal digits");
    if (reference_.contents.contains(size_)) fail("the content is there twice");
    reference_.contents[size_] = {words_[1].text, words_[2].text};
  }

  void read_unit() {
    if (set_ == nullptr) fail("belongs to no set", "after the line of a set");
    if (words_.size() < 3) fail("is the unit of nothing", "unit, its name, names of metrics");
    for (std::size_t i = 2; i < words_.size(); ++i) {
      if (!units_.emplace(words_[i].text, name_of(words_[1])).second) {
        fail("metric '" + words_[i].text + "' has two units");
      }
    }
  }

  const Blessing& blessing(const Word& word) const {
    const auto found = reference_.blessings.find(mark_of(word));
    if (found == reference_.blessings.end()) fail("there is no blessing " + word.text);
    return found->second;
  }

  void read_row() {
    if (set_ == nullptr) fail("belongs to no set", "after the line of a set");
    const Blessing* by = usual_;
    if (is_mark(words_.back())) {
      by = &blessing(words_.back());
      words_.pop_back();
    }
    if (by == nullptr) fail("says not how it was blessed", "a mark [n], here or behind the set");
    const bool same = words_.size() == 5 && !words_[3].is_quoted && words_[3].text == "=";
    if (!same && words_.size() != 4 && words_.size() != 7) {
      fail("has " + std::to_string(words_.size()) + " columns",
           "metric, variant, case, then one value, `=` and one value, or min median max last");
    }
    const std::string metric = words_[0].text;
    const auto unit = units_.find(metric);
    if (unit == units_.end()) fail("metric '" + metric + "' has no unit", "a line `unit` with it");
    const auto put = [&](std::string_view suffix, const Word& word) {
      add(metric + std::string(suffix), {number_of(word), unit->second, by->reason, by->commit});
    };
    if (!same && words_.size() == 4) return put("", words_[3]);
    for (std::size_t i = 0; i < kStatistics.size(); ++i) {
      put(kStatistics[i], words_[same ? 4 : 3 + i]);
    }
  }

  void add(const std::string& name, const ReferenceValue& value) {
    auto& values = (*set_)[name_of(words_[2])][name_of(words_[1])];
    const bool other_form =
        name.ends_with(".min") && values.contains(name.substr(0, name.rfind('.')));
    const bool first = values.emplace(name, value).second;
    if (!first || other_form || values.contains(name + ".min")) {
      fail("metric '" + words_[0].text + "' of variant '" + words_[1].text + "' in case '" +
           words_[2].text + "' is there twice");
    }
  }

  std::istringstream in_;
  std::string source_;
  std::string line_;
  std::size_t number_ = 0;
  std::vector<Word> words_;
  Reference reference_;
  std::string size_;
  ReferenceSet* set_ = nullptr;
  const Blessing* usual_ = nullptr;
  std::map<std::string, std::string> units_;
};

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
  return std::string(kFirstLine) + "\n" + numbers.text(used) + sets;
}

Reference parse_reference(const std::string& text, const std::string& source) {
  return Parser(text, source).read();
}

}  // namespace geoprior
