#include "tests/topics/structure/functions.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace geoprior::test::structure {
namespace {

bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '\'';
}

/// The source with comments, texts, characters and lines of the preprocessor blanked: every other
/// character keeps its place.
class BlankedCode {
 public:
  explicit BlankedCode(std::string_view source) : text_(source) {
    while (at_ < text_.size()) step();
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  [[nodiscard]] bool begins(std::string_view with) const {
    return std::string_view(text_).substr(at_).starts_with(with);
  }
  [[nodiscard]] bool at_line_start() const { return at_ == 0 || text_[at_ - 1] == '\n'; }

  void step() {
    if (begins("//")) {
      blank_to(text_.find('\n', at_));
    } else if (begins("/*")) {
      blank_to(text_.find("*/", at_) + 2);
    } else if (text_[at_] == '#' && at_line_start()) {
      blank_to(end_of_directive());
    } else if (begins("R\"")) {
      const std::size_t open = text_.find('(', at_);
      const std::string close = ")" + text_.substr(at_ + 2, open - at_ - 2) + "\"";
      blank_to(text_.find(close, open) + close.size());
    } else if (text_[at_] == '"' || (text_[at_] == '\'' && !is_digit_separator())) {
      blank_to(end_of_quotes());
    } else {
      ++at_;
    }
  }
  /// 1'000 and 0xFF'FF, but not U'a': what stands before it begins with a digit.
  [[nodiscard]] bool is_digit_separator() const {
    std::size_t begin = at_;
    while (begin > 0 && is_of_word(text_[begin - 1])) --begin;
    return begin < at_ && std::isdigit(static_cast<unsigned char>(text_[begin])) != 0;
  }
  [[nodiscard]] std::size_t end_of_directive() const {
    std::size_t end = text_.find('\n', at_);
    while (end != std::string::npos && text_[end - 1] == '\\') end = text_.find('\n', end + 1);
    return end;
  }
  [[nodiscard]] std::size_t end_of_quotes() const {
    std::size_t end = at_ + 1;
    while (end < text_.size() && text_[end] != text_[at_]) end += text_[end] == '\\' ? 2 : 1;
    return end + 1;
  }
  void blank_to(std::size_t end) {
    end = std::min(end, text_.size());
    for (; at_ < end; ++at_) {
      if (text_[at_] != '\n') text_[at_] = ' ';
    }
  }

  std::string text_;
  std::size_t at_ = 0;
};

/// Behind the brace that closes the one at `open`.
std::size_t behind_braces(const std::string& code, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < code.size(); ++i) {
    if (code[i] == '{') ++depth;
    if (code[i] == '}' && --depth == 0) return i + 1;
  }
  return code.size();
}

/// Whether what stands before a brace declares a function: it has parentheses (or is a lambda's
/// `[]`), and is neither a class, a namespace nor the value of a constant.
bool declares_function(std::string head) {
  static const std::regex scope(
      "^\\s*(template\\s*<[^{]*>\\s*)?(inline\\s+)?(namespace|class|struct|enum|union|extern)\\b");
  while (!head.empty() && std::isspace(static_cast<unsigned char>(head.back())) != 0) {
    head.pop_back();
  }
  if (head.empty() || head.back() == '=' || head.back() == ',') return false;
  return (head.find(')') != std::string::npos || head.back() == ']') &&
         !std::regex_search(head, scope);
}

/// Where the declaration in code[begin, end) starts: behind `public:` and what is blank.
std::size_t start_of_declaration(const std::string& code, std::size_t begin, std::size_t end) {
  static const std::regex before("^\\s*((public|private|protected):\\s*)?");
  std::smatch found;
  const std::string head = code.substr(begin, end - begin);
  return std::regex_search(head, found, before) ? begin + found.str(0).size() : begin;
}

int line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + at, '\n'));
}

/// The brace behind a name without a space is that of an initialiser.
bool is_initialiser(const std::string& code, std::size_t brace) {
  if (brace == 0) return false;
  const char before = code[brace - 1];
  return std::isalnum(static_cast<unsigned char>(before)) != 0 || before == '_' || before == '>';
}

}  // namespace

std::vector<Function> functions_of(std::string_view source) {
  const std::string code = BlankedCode(source).text();
  std::vector<Function> functions;
  std::size_t begin = 0;  // of the declaration that a brace belongs to
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] == ';' || code[i] == '}') begin = i + 1;
    if (code[i] != '{') continue;
    if (is_initialiser(code, i)) {
      i = behind_braces(code, i) - 1;
      continue;
    }
    const std::size_t first = start_of_declaration(code, begin, i);
    if (declares_function(code.substr(first, i - first))) {
      const std::size_t end = behind_braces(code, i);
      const int line = line_of(code, first);
      const std::size_t stop = source.find('\n', first);
      functions.push_back({std::string(source.substr(first, stop - first)), line,
                           line_of(code, end - 1) - line + 1});
      i = end - 1;
    }
    begin = i + 1;
  }
  return functions;
}

std::vector<std::string> long_functions(const SourceTree& tree, int most) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    for (const Function& function : functions_of(file.text)) {
      if (function.lines <= most) continue;
      found.push_back(file.path + ":" + std::to_string(function.line) + ": " +
                      std::to_string(function.lines) + " lines: " + function.head);
    }
  }
  return found;
}

}  // namespace geoprior::test::structure
