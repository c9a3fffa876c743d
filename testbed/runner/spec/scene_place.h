#pragma once

#include <map>
#include <string>

namespace geoprior {

/// Where the key that a message speaks of is written: the place of the longest path in `places`
/// that the first dotted path in the message beginning with `root` ("scene", "options") goes
/// through; names of elements in quotes ("scene.handles.1 'left'.keys.0") are passed over. Empty
/// when there is none.
std::string place_of_key(const std::map<std::string, std::string>& places, const std::string& root,
                         const std::string& message);
inline std::string place_of_scene_key(const std::map<std::string, std::string>& places,
                                      const std::string& message) {
  return place_of_key(places, "scene", message);
}

}  // namespace geoprior
