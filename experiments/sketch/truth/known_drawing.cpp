#include "experiments/sketch/truth/known_drawing.h"

#include <array>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/drawing/stroke_kinds.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/truth/known_photo.h"
#include "experiments/sketch/truth/known_view.h"
#include "testbed/formats/svg/color.h"

namespace geoprior::sketch {
namespace {

constexpr std::array<std::string_view, 4> kKnownNames{"bag", "tent", "helmet", "frustum"};
constexpr int kPhotoWidth = 360;
/// Of drawn points on the page: what a hand can draw (mm).
constexpr int kPageDecimals = 1;

/// Puts strokes into SVG, in millimetres of paper with y down.
class KnownSvg {
 public:
  KnownSvg(const KnownDrawingOptions& options, const KnownObject& object)
      : name_(known_name(options.shape)),
        object_(object),
        visible_only_(options.visible_only),
        page_(known_placement(object).page) {}
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] double mm(double metres) const { return 1e3 * metres / object_.drawing_scale; }
  [[nodiscard]] std::string path(const Stroke& stroke) const;
  [[nodiscard]] std::string photograph(const std::string& width, const std::string& height) const;
  [[nodiscard]] std::string group(const View& view, StrokeKind kind) const;

  std::string name_;
  const KnownObject& object_;
  bool visible_only_;
  Eigen::Vector2d page_;
};

std::string KnownSvg::path(const Stroke& stroke) const {
  std::string text = "    <path id=\"" + stroke.id + "\"";
  const bool panels = stroke.kind == StrokeKind::border || stroke.kind == StrokeKind::silhouette ||
                      stroke.kind == StrokeKind::ruling;
  const std::string& named = panels ? stroke.name : stroke.panels;
  if (!named.empty()) text += " data-panel=\"" + named + "\"";
  if (stroke.kind == StrokeKind::plane_vector && stroke.side == DepthSide::back)
    text += " data-depth=\"back\"";
  text += "\n          d=\"";
  std::size_t column = 13;
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    const Eigen::Vector2d& p = stroke.points[i];
    const std::string point = std::string(i == 0   ? "M "
                                          : i == 1 ? "L "
                                                   : "") +
                              written_number(mm(p.x()), kPageDecimals) + "," +
                              written_number(mm(page_.y() - p.y()), kPageDecimals);
    if (column + point.size() > 98) {
      text += "\n             ";
      column = 12;
    } else if (i > 0) {
      text += " ";
    }
    text += point;
    column += point.size() + 1;
  }
  return text + (stroke.closed ? " Z\"/>\n" : "\"/>\n");
}

std::string KnownSvg::group(const View& view, StrokeKind kind) const {
  const std::vector<const Stroke*> strokes = strokes_of(view, kind);
  if (strokes.empty()) return "";
  const StrokeKindRow& row = row_of(kind);
  std::string text = "   <g data-kind=\"" + std::string(row.name) + "\" stroke=\"" +
                     to_text(row.colours.front()) + "\"" +
                     (row.dashed ? " stroke-dasharray=\"2 2\"" : "") + ">\n";
  for (const Stroke* stroke : strokes) text += path(*stroke);
  return text + "   </g>\n";
}

/// The picture that is drawn over; none where only what is visible is drawn.
std::string KnownSvg::photograph(const std::string& width, const std::string& height) const {
  if (visible_only_) return "";
  return "   <image href=\"" + name_ + ".png\" x=\"0\" y=\"0\" width=\"" + width + "\" height=\"" +
         height + "\" preserveAspectRatio=\"none\"/>\n";
}

std::string KnownSvg::text() const {
  const View view = known_view(object_, visible_only_).view;
  const std::string width = written_number(mm(page_.x()), kPageDecimals),
                    height = written_number(mm(page_.y()), kPageDecimals);
  const std::string scale = written_number(object_.drawing_scale);
  std::string svg =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- A " + name_ +
      " traced over its photograph, in millimetres of paper. Blue: borders; grey, dashed: what "
      "is\n     hidden; black: silhouettes; magenta: symmetric pairs; orange: the mirror "
      "plane. -->\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n     width=\"" +
      width + "mm\" height=\"" + height + "mm\" viewBox=\"0 0 " + width + " " + height +
      "\" data-scale=\"" + scale + "\" fill=\"none\" stroke-width=\"0.8\">\n" +
      "  <g inkscape:groupmode=\"layer\" inkscape:label=\"view:photo\" id=\"photo\">\n" +
      photograph(width, height);
  for (const StrokeKindRow& row : stroke_kinds()) svg += group(view, row.kind);
  return svg + "  </g>\n</svg>\n";
}

}  // namespace

std::string known_name(KnownShape shape) {
  return std::string(kKnownNames[static_cast<std::size_t>(shape)]);
}

void describe(OptionVisitor& v, KnownDrawingOptions& o) {
  describe_choice(v, "shape", o.shape, kKnownNames, {.doc = "the object that the drawing shows"});
  v.value("noise", o.noise,
          {.doc = "standard deviation of drawn points, over the height", .min = 0, .max = 1});
  v.value("noisy_vectors", o.noisy_vectors,
          {.doc = "whether the vectors of the mirror plane are noisy too"});
  v.value(
      "vector_stretch", o.vector_stretch,
      {.doc =
           "factor on the upright vector of the mirror plane, which makes the two unequal in space",
       .min = 0.1,
       .max = 10});
  v.value("visible_only", o.visible_only,
          {.doc = "whether hidden parts of borders are left out, and pairs with a hidden end"});
  v.value("yaw_deg", o.yaw_deg,
          {.doc = "turn of the object about the upright axis; its own when absent",
           .unit = "deg",
           .min = -180,
           .max = 180});
  v.value("pitch_deg", o.pitch_deg,
          {.doc = "angle of the eye above the horizon; the object's own when absent",
           .unit = "deg",
           .min = -89,
           .max = 89});
  v.value("seed", o.seed, {.doc = "seed of the noise", .min = 0, .max = 1000000000});
}

KnownObject shown_object(const KnownDrawingOptions& options) {
  KnownObject object = known_object(options.shape);
  object.yaw_deg = options.yaw_deg.value_or(object.yaw_deg);
  object.pitch_deg = options.pitch_deg.value_or(object.pitch_deg);
  return object;
}

std::vector<FabricationFile> known_drawing_files(const KnownDrawingOptions& options) {
  const KnownObject object = shown_object(options);
  const std::string name = known_name(options.shape);
  std::vector<FabricationFile> files{{name + ".svg", KnownSvg(options, object).text()}};
  if (!options.visible_only)
    files.push_back({name + ".png", png_bytes(known_photo(options.shape, object, kPhotoWidth))});
  return files;
}

Drawing known_drawing(const KnownDrawingOptions& options) {
  const KnownObject object = shown_object(options);
  View view = known_view(object, options.visible_only).view;
  if (!options.visible_only)
    view.picture.content = png_bytes(known_photo(options.shape, object, kPhotoWidth));
  view.picture.size = known_placement(object).page;
  return {"scene.known", {std::move(view)}};
}

SyntheticView known_truth(const View& view, const KnownDrawingOptions& options,
                          std::uint64_t seed) {
  const KnownObject object = shown_object(options);
  SyntheticView known = known_view(object, options.visible_only);
  SyntheticView truth = known;
  truth.view = view;
  truth.truth.clear();
  for (Stroke& stroke : truth.view.strokes) {
    std::size_t k = 0;
    while (k < known.view.strokes.size() && known.view.strokes[k].id != stroke.id) ++k;
    if (k == known.view.strokes.size() || known.truth[k].size() != stroke.points.size()) {
      throw Error(
          "is no stroke of the known " + known_name(options.shape),
          "stroke '" + stroke.id + "' with " + std::to_string(stroke.points.size()) + " points",
          "the drawing beside the experiment, as a run without scene.drawing writes it");
    }
    truth.truth.push_back(known.truth[k]);
    if (stroke.name == "sym-a") {
      const Eigen::Vector2d tail = stroke.points.front();
      stroke.points.back() = tail + options.vector_stretch * (stroke.points.back() - tail);
    }
  }
  add_drawing_noise(truth.view, options.noise * object.height, seed, options.noisy_vectors);
  return truth;
}

}  // namespace geoprior::sketch
