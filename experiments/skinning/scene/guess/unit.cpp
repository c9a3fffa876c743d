#include "experiments/skinning/scene/guess/unit.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "experiments/skinning/scene/guess/body.h"
#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit kCentimetres{"centimetres", 0.01};
constexpr Unit kMillimetres{"millimetres", 0.001};
constexpr std::array<Unit, 4> kUnits{
    {kCentimetres, {"inches", 0.0254}, {"decimetres", 0.1}, kMillimetres}};

constexpr double kSmallest = 0.05, kLargest = 5;           ///< m, of a character
constexpr double kBodySmallest = 1.2, kBodyLargest = 2.3;  ///< m, of a body that stands

bool is_within(double x, double least, double most) { return x >= least && x <= most; }

/// Largest side of the box of all corners of triangles.
double extent_of(const TriMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const int v : mesh.F.reshaped()) box.extend(mesh.V.row(v).transpose());
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

/// Three digits, all of them where there are more before the point.
std::string length_text(double x) {
  return x >= 1000 && x < 1e9 ? std::to_string(std::lround(x)) : rounded_text(x, 3);
}

}  // namespace

FileUnit guess_unit(double extent, bool has_sides) {
  if (is_within(extent, kSmallest, kLargest)) return {};
  for (const Unit& unit : kUnits) {
    if (has_sides && is_within(extent * unit.metres, kBodySmallest, kBodyLargest))
      return {unit.metres, unit.name, false};
  }
  for (const Unit& unit : {kCentimetres, kMillimetres}) {
    if (is_within(extent * unit.metres, kSmallest, kLargest))
      return {unit.metres, unit.name, false};
  }
  return {1, {}, true};
}

ChosenUnit choose_unit(const std::optional<double>& given, const GltfCharacter& character) {
  if (given) return {*given, std::nullopt};
  const bool has_joints = character.skeleton && character.skeleton->size() > 0;
  const double extent = extent_of(character.mesh);
  const FileUnit unit =
      guess_unit(extent, has_joints && find_body(*character.skeleton).is_symmetric);
  const std::string size = "the character measures " + length_text(extent);
  if (unit.is_doubtful) {
    return {unit.metres,
            size +
                " m at its largest, if its file is in metres, and no other unit makes it "
                "plausible: unit_m says what it is in (1: metres, and no warning)"};
  }
  if (unit.taken_for.empty()) return {};
  return {unit.metres,
          size + " m at its largest, if its file is in metres as glTF says: taken in " +
              unit.taken_for + ", for " + length_text(extent * unit.metres) +
              " m; unit_m = " + number_text(unit.metres) + " says so, unit_m = 1 says metres"};
}

}  // namespace geoprior::skinning
