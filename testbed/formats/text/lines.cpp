#include "testbed/formats/text/lines.h"

#include <charconv>
#include <cmath>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr std::size_t kLongestQuote = 40;
constexpr std::string_view kBlank = " \t\r\v\f";

std::string quoted(std::string_view word) {
  const bool cut = word.size() > kLongestQuote;
  return "'" + std::string(word.substr(0, kLongestQuote)) + (cut ? "…'" : "'");
}

}  // namespace

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  append_words(line, words);
}

void append_words(std::string_view line, std::vector<std::string_view>& words) {
  for (std::size_t end = 0;;) {
    const std::size_t begin = line.find_first_not_of(kBlank, end);
    if (begin == std::string_view::npos) return;
    end = std::min(line.find_first_of(kBlank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
  }
}

std::optional<double> finite_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // A number too small for a double counts as 0; one too large counts as no number.
    const std::size_t e = word.find_first_of("eE");
    if (e == std::string_view::npos || word[e + 1] != '-') return std::nullopt;
    return 0;
  }
  if (error != std::errc() || !std::isfinite(x)) return std::nullopt;
  return x;
}

std::optional<long long> whole_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  long long x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return x;
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++next_line_;
  return true;
}

bool TextLines::next_with_words() {
  while (next()) {
    split_words(line_.substr(0, line_.find('#')), words_);
    if (!words_.empty()) return true;
  }
  words_.clear();
  return false;
}

bool TextLines::next_with_words_continued() {
  words_.clear();
  for (bool goes_on = false; words_.empty() || goes_on;) {
    if (!next()) break;
    const std::size_t comment = line_.find('#');
    std::string_view text = line_.substr(0, comment);
    text = text.substr(0, text.find_last_not_of(kBlank) + 1);
    goes_on = comment == std::string_view::npos && text.ends_with('\\');
    if (goes_on) text.remove_suffix(1);
    append_words(text, words_);
  }
  return !words_.empty();
}

Error no_finite_number(std::string_view word, const std::string& place) {
  return Error(quoted(word) + " is no finite number", place);
}

Error no_whole_number(std::string_view word, const std::string& place) {
  return Error(quoted(word) + " is no whole number", place);
}

double TextLines::number_at(std::size_t word) const {
  if (const auto x = finite_number(words_[word])) return *x;
  throw no_finite_number(words_[word], place());
}

long long TextLines::integer(std::string_view word) const {
  if (const auto x = whole_number(word)) return *x;
  throw no_whole_number(word, place());
}

void TextLines::require_words(std::size_t count, const std::string& what) const {
  if (words_.size() >= count) return;
  throw Error(
      "has " + std::to_string(words_.size()) + " of " + std::to_string(count) + " words: " + what,
      place());
}

}  // namespace geoprior
