#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace geoprior {

/// The lines of a text and the words on them, with the place for messages.
class TextLines {
 public:
  /// @param first_line  number of the first line of `text` in its file
  TextLines(std::string_view text, std::string name, int first_line = 1)
      : rest_(text), name_(std::move(name)), next_line_(first_line) {}

  /// Goes to the next line; false at the end. Line ends are \n or \r\n (text_file.h knows more).
  bool next();
  /// Goes to the next line that has words once `#` and what follows is gone.
  bool next_with_words();
  /// The same where a line that ends in `\` goes on in the next one, as if there were a blank; a
  /// comment ends with its line.
  bool next_with_words_continued();
  [[nodiscard]] std::string_view line() const { return line_; }
  /// What follows the line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] int number() const { return next_line_ - 1; }
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// "file:line".
  [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(number()); }

  /// A word as a finite number. @throws Error at the place
  [[nodiscard]] double number_at(std::size_t word) const;
  /// A word as a whole number. @throws Error at the place
  [[nodiscard]] long long integer_at(std::size_t word) const { return integer(words_[word]); }
  /// A part of a word as a whole number.
  [[nodiscard]] long long integer(std::string_view word) const;
  /// @throws Error when there are fewer words; `what` they are
  void require_words(std::size_t count, const std::string& what) const;

 private:
  std::string_view rest_, line_;
  std::string name_;
  int next_line_;
  std::vector<std::string_view> words_;
};

/// Splits at blanks and tabs.
void split_words(std::string_view line, std::vector<std::string_view>& words);
/// The same, behind the words that are there.
void append_words(std::string_view line, std::vector<std::string_view>& words);

/// A word as a finite number, or nothing.
std::optional<double> finite_number(std::string_view word);
std::optional<long long> whole_number(std::string_view word);

/// What to throw of a word that is none of them.
Error no_finite_number(std::string_view word, const std::string& place);
Error no_whole_number(std::string_view word, const std::string& place);

}  // namespace geoprior
