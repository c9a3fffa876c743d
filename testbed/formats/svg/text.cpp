#include "testbed/formats/svg/text.h"

#include <charconv>
#include <cmath>

#include "core/error.h"

namespace geoprior {
namespace {

bool is_svg_digit(char c) { return c >= '0' && c <= '9'; }

bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_svg_digit(c) || c == '-';
}

}  // namespace

void SvgText::fail(const std::string& problem, const std::string& allowed) const {
  throw Error(problem, where_ + ", character " + std::to_string(at_ + 1), allowed);
}

void SvgText::skip_space() {
  while (at_ < text_.size() &&
         std::string_view(" \t\r\n\f").find(text_[at_]) != std::string_view::npos)
    ++at_;
}

char SvgText::peek() {
  skip_space();
  return at_ < text_.size() ? text_[at_] : '\0';
}

std::string_view SvgText::word() {
  skip_space();
  const std::size_t from = at_;
  while (at_ < text_.size() && is_word_character(text_[at_])) ++at_;
  return text_.substr(from, at_ - from);
}

bool SvgText::skip(char c) {
  if (peek() != c || at_ == text_.size()) return false;
  ++at_;
  return true;
}

double SvgText::number() {
  skip_space();
  std::size_t from = at_;
  if (from < text_.size() && text_[from] == '+') ++from;
  const std::size_t digits = from < text_.size() && text_[from] == '-' ? from + 1 : from;
  if (digits >= text_.size() || !(is_svg_digit(text_[digits]) || text_[digits] == '.') ||
      (from > at_ && digits > from)) {
    fail("a number is missing", "a number");
  }
  double x = 0;
  const auto [end, error] = std::from_chars(text_.data() + from, text_.data() + text_.size(), x);
  if (error == std::errc::result_out_of_range || std::abs(x) > kMostSvgNumber) {
    fail("is no finite number", "a finite number, at most 1e15");
  }
  if (error != std::errc{}) fail("a number is missing", "a number");
  at_ = end - text_.data();
  skip(',');
  return x;
}

bool SvgText::flag() {
  const char c = peek();
  if (c != '0' && c != '1') fail("a flag of an arc is missing", "0 or 1");
  ++at_;
  skip(',');
  return c == '1';
}

}  // namespace geoprior
