#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/formats/svg/document.h"

namespace geoprior::paper {

/// The lines of a drawing that a pattern is made of.
struct SvgChoice {
  std::vector<SvgSubpath> lines;  ///< metres on the page
  bool nonzero = false;           ///< fill-rule of an area; lines that are only drawn enclose
  std::vector<int> clips;         ///< indices of what hides parts of them
  std::string where;              ///< file and element, for errors
};

/// The shape of that id, or what the group or `use` of that id draws; without an id the only shape
/// that encloses anything. Lines that enclose nothing on their own (open ones, of several elements)
/// are joined where their ends are within `gap` (m).
///
/// @param key    of the option, for errors: "scene.pattern.path: "
/// @param notes  added: what was joined
/// @throws Error  no such shape, or several; a shape that is drawn more than once; lines that do
///                not close
SvgChoice choose_lines(const SvgDocument& drawing, const std::optional<std::string>& id, double gap,
                       const std::string& key, std::vector<std::string>& notes);

}  // namespace geoprior::paper
