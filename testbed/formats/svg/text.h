#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace geoprior {

/// Largest number that is read: what is beyond it is a mistake, and sums and products of what is
/// within stay finite.
inline constexpr double kMostSvgNumber = 1e15;

/// The value of an attribute that holds numbers (path data, points, transforms) and where its
/// reader stands. Errors name `where` and the character.
class SvgText {
 public:
  SvgText(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& problem, const std::string& allowed) const;

  /// The next character that is no space, 0 at the end; it stays.
  char peek();
  /// The next character, whatever it is.
  char take() { return text_[at_++]; }
  /// Letters, digits and hyphens, as in the name of a function.
  std::string_view word();
  /// Steps over `c` when it comes next.
  bool skip(char c);
  /// A number, and the comma behind it. Numbers may follow each other without anything between.
  double number();
  /// Flags of an arc may stand without anything between them.
  bool flag();
  /// Number of the next character, from 1.
  [[nodiscard]] std::size_t character() const { return at_ + 1; }

 private:
  void skip_space();

  std::string_view text_;
  std::string where_;
  std::size_t at_ = 0;
};

}  // namespace geoprior
