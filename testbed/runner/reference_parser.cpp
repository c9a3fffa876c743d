#include "testbed/runner/reference_parser.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/error.h"
#include "testbed/runner/reference_text.h"

namespace geoprior {
namespace {

struct Word {
  std::string text;
  bool is_quoted = false;
};

/// Reads one line after the other; what is wrong is said with its number.
class ReferenceParser {
 public:
  ReferenceParser(const std::string& text, std::string source)
      : in_(text), source_(std::move(source)) {}

  Reference read() {
    next_line();
    if (line_ != kReferenceFirstLine)
      fail("is no reference file of this form", std::string(kReferenceFirstLine));
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
    for (std::size_t i = 0; i < kReferenceStatistics.size(); ++i) {
      put(kReferenceStatistics[i], words_[same ? 4 : 3 + i]);
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

Reference parse_reference(const std::string& text, const std::string& source) {
  return ReferenceParser(text, source).read();
}

}  // namespace geoprior
