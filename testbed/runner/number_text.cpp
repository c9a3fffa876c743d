#include "testbed/runner/number_text.h"

#include <array>
#include <charconv>

namespace geoprior {
namespace {

template <class... Format>
std::string text(double x, Format... format) {
  std::array<char, 64> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, format...);
  return error == std::errc{} ? std::string(buffer.data(), end) : "?";
}

}  // namespace

std::string number_text(double x) { return text(x); }

std::string rounded_text(double x, int digits) {
  return text(x, std::chars_format::general, digits);
}

}  // namespace geoprior
