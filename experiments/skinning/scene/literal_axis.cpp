#include "experiments/skinning/scene/literal_axis.h"

#include "core/error.h"

namespace geoprior::skinning {
namespace {

/// Takes a word and the blank behind it off the front of a text.
bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word) || !text.substr(word.size()).starts_with(' ')) return false;
  text.remove_prefix(word.size() + 1);
  return true;
}

}  // namespace

std::optional<LiteralAxis> parse_literal_axis(std::string_view text) {
  LiteralAxis axis;
  axis.is_local = take_word(text, "local");
  if (!axis.is_local) take_word(text, "world");
  const std::size_t which = text.size() == 2 ? std::string_view("xyz").find(text[1]) : text.npos;
  if (which == text.npos || (text[0] != '+' && text[0] != '-')) return std::nullopt;
  axis.direction[which] = text[0] == '+' ? 1 : -1;
  return axis;
}

Eigen::Vector3d rest_direction(const LiteralAxis& axis, const Joint& joint) {
  if (!axis.is_local) return axis.direction;
  if (!joint.frame) {
    throw Error("has no axes of its own: its file gives positions only",
                "joint '" + joint.name + "'", kWorldAxes);
  }
  return *joint.frame * axis.direction;
}

}  // namespace geoprior::skinning
