#pragma once

#include <optional>
#include <string>

#include "testbed/formats/gltf/character.h"

namespace geoprior::skinning {

/// How many metres a unit of a character's file is.
struct FileUnit {
  double metres = 1;
  std::string taken_for;     ///< "centimetres", …; empty: the file is in metres, as glTF says
  bool is_doubtful = false;  ///< in no unit has the character a plausible size
};

/// Guesses the unit from the largest extent of a character at rest.
///
///     0.05 to 5 (a hand, a giraffe)          metres
///     as a body of 1.2 to 2.3 m, when it     centimetres (120 to 230), inches (47 to 91),
///       has two sides                        decimetres (12 to 23), millimetres (1200 to 2300)
///     else up to 500, 5000                   centimetres, millimetres
///     else                                   metres, doubtful
///
/// The bands of a body do not overlap: at most one unit makes one. Only a body is looked for in
/// decimetres and inches, because a hand of 17 cm has the numbers of a body of 17 dm.
///
/// @param extent     in units of the file
/// @param has_sides  the joints have mirror images (Body::is_symmetric)
FileUnit guess_unit(double extent, bool has_sides);

/// The unit that the scene gives (`given`), else the guess, with a line for the user where that is
/// not metres without doubt.
struct ChosenUnit {
  double metres = 1;
  std::optional<std::string> warning;
};
ChosenUnit choose_unit(const std::optional<double>& given, const GltfCharacter& character);

}  // namespace geoprior::skinning
