#include "testbed/runner/spec/scene_place.h"

#include <cctype>

namespace geoprior {

namespace {

/// Past the name of an element, " 'left'", if there is one at `at`.
std::size_t after_name(const std::string& text, std::size_t at) {
  if (text.compare(at, 2, " '") != 0) return at;
  const std::size_t end = text.find('\'', at + 2);
  return end == std::string::npos ? at : end + 1;
}

bool is_of_key(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

std::string place_of_key(const std::map<std::string, std::string>& places, const std::string& root,
                         const std::string& message) {
  std::string path = root;
  std::size_t at = message.find(path + ".");
  if (at == std::string::npos || !places.contains(path)) return {};
  at += path.size();
  while (at < message.size() && message[at] == '.') {
    const std::size_t begin = ++at;
    while (at < message.size() && is_of_key(message[at])) ++at;
    const std::string longer = path + "." + message.substr(begin, at - begin);
    if (!places.contains(longer)) break;
    path = longer;
    at = after_name(message, at);
  }
  return places.at(path);
}

}  // namespace geoprior
