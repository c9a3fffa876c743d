#include "testbed/formats/svg/units.h"

#include <array>

#include "testbed/formats/svg/text.h"

namespace geoprior {
namespace {

struct SvgUnit {
  std::string_view name;
  double px;
};

constexpr double kPxPerInch = 96;
constexpr std::array<SvgUnit, 6> kAbsoluteUnits{{{"mm", kPxPerInch / 25.4},
                                                 {"cm", kPxPerInch / 2.54},
                                                 {"in", kPxPerInch},
                                                 {"pt", kPxPerInch / 72},
                                                 {"pc", kPxPerInch / 6},
                                                 {"Q", kPxPerInch / 101.6}}};

}  // namespace

SvgLength parse_svg_length(std::string_view text, double reference, const std::string& where) {
  SvgText reader(text, where);
  const double number = reader.number();
  if (reader.skip('%')) {
    if (reader.peek() != 0) reader.fail("something follows the length", "a length");
    return {number / 100 * reference, false, true};
  }
  const std::string_view unit = reader.word();
  if (reader.peek() == 0) {
    if (unit.empty() || unit == "px") return {number, false, false};
    for (const SvgUnit& known : kAbsoluteUnits) {
      if (unit == known.name) return {number * known.px, true, false};
    }
  }
  reader.fail("unknown unit '" + std::string(unit) + "'", "px, mm, cm, Q, in, pt, pc, %");
}

}  // namespace geoprior
