#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "testbed/formats/svg/document.h"

namespace geoprior::sketch {

/// Which groups of a file are the views of a drawing.
struct ViewLayers {
  std::map<int, ViewKind> kind_of_group;  ///< by index
  std::vector<ViewKind> kinds;            ///< those there are, in the order of the enumerators
  std::vector<std::string> unread;        ///< names of layers that are no view's, in quotes
};

/// Groups named view:front, view:side, view:top, view:photo, by label or id, in small or
/// capital letters, with or without blanks. A hidden one is left out, and hidden layers in it, with
/// a line in `warnings` each.
/// @throws Error  naming the file, and the group where there is one: none, an unknown one, one
///                twice, a photo beside others, less than two without a photo
ViewLayers find_view_layers(const SvgDocument& document, std::vector<std::string>& warnings);

/// The view that a group lies in or is, the innermost of several; absent outside of all.
std::optional<ViewKind> view_of_group(const SvgDocument& document, const ViewLayers& layers,
                                      int group);

}  // namespace geoprior::sketch
