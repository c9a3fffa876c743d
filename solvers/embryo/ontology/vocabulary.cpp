#include "solvers/embryo/ontology/vocabulary.h"

#include <algorithm>
#include <numbers>

namespace geoprior::embryo {

namespace {

constexpr ClassEntry kClasses[] = {
    {"Cylinder", "GeometricalComponent", false, "A cylinder with round caps inside its length."},
    {"Disease", "", false, "What is disabled and enabled among the processes."},
    {"Division", "Process", false, "A structure is split by a septum into two products."},
    {"Duct", "GeometricalComponent", false, "A tube along a smooth curve between two anchors."},
    {"EmbryologicalEntity", "", false, "A structure of the embryo."},
    {"Fixation", "Process", false, "The ends of ducts follow their anchors."},
    {"GeometricalComponent", "", true, "A shape in the frame of the body or of a structure."},
    {"Growth", "Process", false, "Sizes follow the keys."},
    {"Interaction", "Process", false, "Two structures are near each other, or several become one."},
    {"Line", "GeometricalComponent", false, "A straight landmark with a length."},
    {"Measurement", "", false, "A number of the literature that a model is scored by."},
    {"Migration", "Process", false, "A position follows the curve of the keys."},
    {"Ovoid", "GeometricalComponent", false, "An ellipsoid, or an egg."},
    {"ParameterSet", "", false,
     "A story of the development: keys and processes that belong together."},
    {"Plane", "GeometricalComponent", false, "A square landmark with a normal."},
    {"Point", "GeometricalComponent", false, "A landmark without a size."},
    {"Process", "", true, "What changes structures between two stages."},
    {"Rotation", "Process", false, "A structure turns about an axis of the body."},
    {"Source", "", false, "A publication, or the word that a number is assumed."},
    {"SpatioTemporalEntity", "", false, "A structure's shape at a stage: a key frame."},
    {"TemporalEntity", "", false, "A stage of the development."},
};

constexpr Unit kUnits[] = {
    {"1", Dimension::ratio, 1},   {"cm", Dimension::length, 1e-2},
    {"d", Dimension::day, 1},     {"deg", Dimension::angle, std::numbers::pi / 180},
    {"m", Dimension::length, 1},  {"mm", Dimension::length, 1e-3},
    {"rad", Dimension::angle, 1}, {"um", Dimension::length, 1e-6},
};

constexpr Quantity kQuantities[] = {
    {"branchings", Dimension::ratio},        {"crown_rump_length", Dimension::length},
    {"hilum_angle", Dimension::angle},       {"interpole_lower", Dimension::length},
    {"interpole_upper", Dimension::length},  {"kidney_length", Dimension::length},
    {"lower_pole_shift", Dimension::length}, {"upper_pole_rise", Dimension::length},
    {"vertebral_level", Dimension::ratio},
};

}  // namespace

std::span<const ClassEntry> vocabulary_classes() { return kClasses; }

std::span<const Unit> vocabulary_units() { return kUnits; }
std::span<const Quantity> vocabulary_quantities() { return kQuantities; }

std::optional<int> find_class(std::string_view name) {
  const auto* found = std::ranges::find(kClasses, name, &ClassEntry::name);
  if (found == std::end(kClasses)) return std::nullopt;
  return static_cast<int>(found - std::begin(kClasses));
}

bool is_subclass(int class_number, int ancestor) {
  for (std::optional<int> at = class_number; at; at = find_class(kClasses[*at].parent)) {
    if (*at == ancestor) return true;
  }
  return false;
}

bool is_among(std::string_view word, std::string_view texts) {
  while (!texts.empty()) {
    const std::size_t end = std::min(texts.find(' '), texts.size());
    if (texts.substr(0, end) == word) return true;
    texts.remove_prefix(std::min(end + 1, texts.size()));
  }
  return false;
}

std::string_view name_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::ratio:
      return "ratio";
    case Dimension::length:
      return "length";
    case Dimension::angle:
      return "angle";
    case Dimension::day:
      return "day";
    case Dimension::of_quantity:
      return "quantity";
  }
  return {};
}

}  // namespace geoprior::embryo
