#include "experiments/sketch/pattern/joint_table.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/angles.h"
#include "solvers/sketch/layers/pattern.h"

namespace geoprior::sketch {
namespace {

constexpr double kMillimetre = 1e-3;

template <class... Values>
std::string table_row(const char* format, const Values&... values) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

std::string edge_rows(const ArticulatedLayers& layers) {
  std::string text = "edge                      radius   distance of its points  half angle\n";
  text += "                              mm     rms mm     most mm         deg\n";
  for (const ArcCircle& circle : layers.circles) {
    text += table_row("%-24.24s %7.2f %10.3f %11.3f %11.1f\n", circle.id.c_str(),
                      circle.radius / kMillimetre, circle.rms / kMillimetre,
                      circle.max / kMillimetre, circle.half_angle / kDegree);
  }
  const FrustumBand& first = layers.bands.front();
  if (first.oblique()) {
    text += table_row(
        "The first layer is cut obliquely: its front edge is turned by %.1f degrees "
        "against its rear edge.\n",
        first.front_tilt / kDegree);
  }
  return text;
}

std::string joint_row(const ArticulatedLayers& layers, std::size_t j) {
  const OverlapRecord& choice = layers.choices[j];
  const LayerHinge& hinge = layers.hinges[j];
  return table_row("%-24.24s %-24.24s %7.1f%% %8.2f  %-7s %5.1f %6.1f %8.1f\n",
                   layer_name(layers, j).c_str(), layer_name(layers, j + 1).c_str(),
                   100 * choice.share, layers.overlaps[j + 1] / kMillimetre,
                   choice.chosen ? "chosen" : "given", choice.free / kDegree, hinge.curl / kDegree,
                   hinge.stretch / kDegree);
}

}  // namespace

std::string joint_table(const ArticulatedLayers& layers) {
  std::string text = edge_rows(layers);
  if (layers.hinges.empty()) return text;
  text +=
      "\nlayer                    and the one below           overlap     mm           room   "
      "curls bends back\n";
  for (std::size_t j = 0; j < layers.hinges.size(); ++j) text += joint_row(layers, j);
  return text +
         "overlap: of the layer before's visible length; room, curls, bends back: degrees.\n";
}

}  // namespace geoprior::sketch
