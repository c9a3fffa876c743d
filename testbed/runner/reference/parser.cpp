#include "testbed/runner/reference/parser.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "testbed/joined.h"
#include "testbed/runner/reference/text.h"

namespace geoprior {
namespace {

/// A file says its values once a row, and a row may stand for many cases.
constexpr std::size_t kMostValues = 1'000'000;

struct Word {
  std::string text;
  bool is_quoted = false;
};

/// Of "a|b" both; of nothing the case without a name.
std::vector<std::string> split_cases(const std::string& word) {
  std::vector<std::string> cases;
  std::istringstream names(word);
  for (std::string name; std::getline(names, name, kBetweenCases);) cases.push_back(name);
  if (cases.empty()) cases.emplace_back();
  return cases;
}

/// Reads one line after the other; what is wrong is said with its number.
class ReferenceParser {
 public:
  ReferenceParser(const std::string& text, std::string source)
      : in_(text), source_(std::move(source)) {}

  Reference read() {
    next_line();
    if (line_ != kReferenceFirstLine) {
      fail("is no reference file of this form, or of an older one",
           std::string(kReferenceFirstLine) +
               "; remove the file, then make it anew with `geoprior bless`");
    }
    while (next_line()) {
      if (line_.empty() || line_.front() == '#') continue;
      if (ended_) fail("stands behind the end");
      const bool is_row = line_.starts_with("  ");
      words_ = words();
      if (words_.empty()) fail("is blank but for spaces", "an empty line");
      is_row ? read_row() : read_head();
    }
    if (!ended_) fail("the file is cut off", "its last line, end and the number of its rows");
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
    const std::string& first = words_.front().text;
    if (first == "set") return read_set();
    if (first == "end") return read_end();
    const std::map<std::string_view, void (ReferenceParser::*)()> heads{
        {"blessed", &ReferenceParser::read_blessed}, {"content", &ReferenceParser::read_content},
        {"frames", &ReferenceParser::read_frames},   {"metrics", &ReferenceParser::read_metrics},
        {"cost", &ReferenceParser::read_cost},       {"unit", &ReferenceParser::read_unit},
        {"cases", &ReferenceParser::read_cases},     {"variants", &ReferenceParser::read_variants},
        {"outcome", &ReferenceParser::read_outcome}, {"claim", &ReferenceParser::read_claim}};
    const auto head = heads.find(first);
    if (head == heads.end() || words_.front().is_quoted) {
      fail("'" + first + "' begins no line",
           "set, blessed, frames, metrics, content, cost, unit, cases, variants, outcome, claim, "
           "end, or two spaces before a row");
    }
    require_set();
    (this->*head->second)();
  }

  void require_set() const {
    if (set_ == nullptr) fail("belongs to no set", "after the line of a set");
  }

  void require_words(std::size_t count, const std::string& form) const {
    if (words_.size() != count) fail("is no line of this kind", form);
  }

  /// What has just been read of the set is there once.
  void require_first(const std::string& what) {
    if (!seen_.insert(what).second) fail("the " + what + " of the set is there twice");
  }

  /// What a set must have once it is read.
  void close_set() const {
    if (set_ == nullptr) return;
    if (!seen_.contains("blessing")) fail("the set before says not how it was blessed");
    const bool half =
        set_->content && set_->content->content.empty() && set_->content->metrics.empty();
    if (half) fail("the set before has frames and no metrics");
  }

  void read_set() {
    close_set();
    require_words(2, "set full, set quick");
    const std::string& size = words_[1].text;
    if (size != "full" && size != "quick") fail("there is no set '" + size + "'", "full, quick");
    if (reference_.contains(size)) fail("set " + size + " is there twice");
    set_ = &reference_[size];
    units_.clear();
    seen_.clear();
    cases_.clear();
    variants_.clear();
  }

  void read_end() {
    close_set();
    require_words(2, "end, the number of rows");
    if (number_of(words_[1]) != static_cast<double>(rows_)) {
      fail("the file has " + std::to_string(rows_) + " rows and not " + words_[1].text,
           "a file as `geoprior bless` wrote it");
    }
    ended_ = true;
  }

  void read_blessed() {
    require_first("blessing");
    if (words_.size() != 3 || !words_[2].is_quoted) {
      fail("is no blessing", "blessed, the commit, the reason in quotes");
    }
    set_->blessing = {name_of(words_[1]), words_[2].text};
  }

  [[nodiscard]] std::string hash_of(std::size_t word, const std::string& form) const {
    require_words(word + 1, form);
    const std::string& hash = words_[word].text;
    const bool is_hash =
        hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!is_hash) fail("'" + hash + "' is no hash", "64 hexadecimal digits");
    return hash;
  }

  ContentHash& content() {
    if (!set_->content) set_->content.emplace();
    return *set_->content;
  }

  void read_content() {
    require_first("content");
    if (set_->content) fail("the frames are there already", "content, or frames and metrics");
    content().content = hash_of(2, "content, the instruction set, a hash");
    content().instruction_set = words_[1].text;
  }

  void read_frames() {
    require_first("frames");
    if (set_->content) fail("the content is there already", "content, or frames and metrics");
    content().frames = hash_of(2, "frames, the instruction set, a hash");
    content().instruction_set = words_[1].text;
  }

  void read_metrics() {
    require_first("metrics");
    if (content().frames.empty()) fail("stands behind no line of frames");
    content().metrics = hash_of(1, "metrics, a hash");
  }

  void read_cost() {
    require_first("cost");
    if (words_.size() != 3 || words_[2].text != "s") fail("is no cost", "cost, a number, s");
    set_->processor_s = number_of(words_[1]);
  }

  void read_unit() {
    if (words_.size() < 3) fail("is the unit of nothing", "unit, its name, names of metrics");
    for (std::size_t i = 2; i < words_.size(); ++i) {
      if (!units_.emplace(words_[i].text, name_of(words_[1])).second) {
        fail("metric '" + words_[i].text + "' has two units");
      }
    }
  }

  void read_cases() {
    for (std::size_t i = 1; i < words_.size(); ++i) cases_.push_back(words_[i].text);
  }

  void read_variants() {
    require_first("variants");
    for (std::size_t i = 1; i < words_.size(); ++i) variants_.push_back(words_[i].text);
  }

  void read_outcome() {
    if (words_.size() < 4 || words_.size() % 2 != 0) {
      fail("is no line of this kind", "outcome, the case, then variants with a hash each");
    }
    for (std::size_t i = 2; i < words_.size(); i += 2) read_outcome_of(words_[i], words_[i + 1]);
  }
  void read_outcome_of(const Word& of_variant, const Word& of_outcome) {
    ++rows_;
    const std::string& hash = of_outcome.text;
    const bool is_hash = hash.size() == kOutcomeDigits &&
                         hash.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!is_hash) {
      fail("'" + hash + "' is no outcome", std::to_string(kOutcomeDigits) + " hexadecimal digits");
    }
    const std::string in = name_of(words_[1]), variant = name_of(of_variant);
    if (!set_->outcomes[in].emplace(variant, hash).second) {
      fail("the outcome of variant '" + variant + "' in case '" + in + "' is there twice");
    }
  }

  /// The enumerator that a word stands for, its spaces as "-".
  template <class Enum, std::size_t n>
  Enum enumerator_of(std::string word, const std::array<std::string_view, n>& words) const {
    for (std::size_t i = 0; i < n; ++i) {
      std::string known(words[i]);
      std::replace(known.begin(), known.end(), ' ', '-');
      if (known == word) return static_cast<Enum>(i);
    }
    fail("'" + word + "' is no word of a claim", joined(words));
  }

  void read_claim() {
    ++rows_;
    require_words(8,
                  "claim, its cases, the outcome, excepted or -, the null, what is graded, the "
                  "grade, the text");
    BlessedClaim claim;
    claim.outcome = enumerator_of<ClaimOutcome>(words_[2].text, kClaimOutcomes);
    claim.excepted = words_[3].text == "excepted";
    claim.null = name_of(words_[4]);
    if (words_[5].text != "-") {
      claim.graded = enumerator_of<Graded>(words_[5].text, kGradeds);
      claim.least = number_of(words_[6]);
    }
    const std::string& text = words_[7].text;
    for (const std::string& in : split_cases(name_of(words_[1]))) {
      if (!set_->claims[text].emplace(in, claim).second) {
        fail("the claim '" + text + "' in case '" + in + "' is there twice");
      }
    }
  }

  void read_row() {
    require_set();
    ++rows_;
    const std::string& metric = words_[0].text;
    const auto unit = units_.find(metric);
    if (unit == units_.end()) fail("metric '" + metric + "' has no unit", "a line `unit` with it");
    if (words_.size() == 4 && !words_[2].is_quoted && words_[2].text == "=") {
      return add(name_of(words_[1]), "", number_of(words_[3]));
    }
    if (variants_.empty() || words_.size() != 2 + variants_.size()) {
      fail("has " + std::to_string(words_.size()) + " columns",
           "metric, cases, and a number of each of " + std::to_string(variants_.size()) +
               " variants; or metric, case, `=`, a number");
    }
    for (const std::string& in : cases_of(words_[1])) {
      for (std::size_t i = 0; i < variants_.size(); ++i) {
        const Word& word = words_[2 + i];
        if (word.is_quoted || word.text != "-") add(in, variants_[i], number_of(word));
      }
    }
  }

  [[nodiscard]] std::vector<std::string> cases_of(const Word& word) const {
    if (!word.is_quoted && word.text == kAllCases) return cases_;
    std::vector<std::string> cases = split_cases(word.text);
    for (const std::string& name : cases) {
      if (std::find(cases_.begin(), cases_.end(), name) == cases_.end()) {
        fail("there is no case '" + name + "'", "those of the line `cases`");
      }
    }
    return cases;
  }

  void add(const std::string& in, const std::string& variant, double value) {
    const std::string& metric = words_[0].text;
    if (++values_ > kMostValues) fail("the file has over a million values");
    if (set_->values[in][variant].emplace(metric, ReferenceValue{value, units_.at(metric)}).second)
      return;
    fail("metric '" + metric + "' of variant '" + variant + "' in case '" + in +
         "' is there twice");
  }

  std::istringstream in_;
  std::string source_;
  std::string line_;
  std::size_t number_ = 0;
  std::vector<Word> words_;
  Reference reference_;
  std::size_t rows_ = 0;
  std::size_t values_ = 0;
  bool ended_ = false;
  BlessedSet* set_ = nullptr;
  std::set<std::string> seen_;  ///< lines that a set has once
  std::map<std::string, std::string> units_;
  std::vector<std::string> cases_;
  std::vector<std::string> variants_;
};

}  // namespace

Reference parse_reference(const std::string& text, const std::string& source) {
  return ReferenceParser(text, source).read();
}

}  // namespace geoprior
