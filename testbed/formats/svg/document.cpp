#include "testbed/formats/svg/document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/formats/svg/link.h"
#include "testbed/formats/svg/paint.h"
#include "testbed/formats/svg/shapes.h"
#include "testbed/formats/svg/text.h"
#include "testbed/formats/svg/transform.h"
#include "testbed/formats/svg/units.h"
#include "testbed/formats/text/nesting.h"

namespace geoprior {
namespace {

/// What was left out: each kind once, how often, and where first.
class SvgNotes {
 public:
  void add(const std::string& what, const std::string& place) {
    constexpr std::size_t kMostKinds = 50;
    const auto [note, is_new] = index_.emplace(what, notes_.size());
    if (!is_new) {
      ++notes_[note->second].count;
    } else if (notes_.size() < kMostKinds) {
      notes_.push_back({place, what, 1});
    } else {
      index_.erase(note);
    }
  }
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const Note& note : notes_) {
      lines.push_back(note.place + ": " + note.what);
      if (note.count > 1) lines.back() += " (and " + std::to_string(note.count - 1) + " more)";
    }
    return lines;
  }

 private:
  struct Note {
    std::string place, what;
    std::size_t count;
  };
  std::map<std::string, std::size_t> index_;
  std::vector<Note> notes_;
};

/// What holds inside of an element.
struct Surroundings {
  Eigen::Affine2d to_page = Eigen::Affine2d::Identity();  ///< user units to metres
  double width = 0, height = 0;                           ///< of the viewport (user units)
  SvgPaint paint;
  int group = -1;
  std::string layer;
  std::vector<int> clips;
  bool overflows = false;  ///< of the element itself: what is drawn beyond its viewport is seen
  int depth = 0;
};

/// Most comparisons of elements with rules of style: a second or two.
constexpr double kMostSvgMatches = 1e7;

/// Elements that draw nothing by themselves.
bool only_serves(std::string_view element) {
  constexpr std::array<std::string_view, 18> kServing{
      "defs",   "symbol",         "clipPath",       "mask",  "marker", "pattern",
      "filter", "linearGradient", "radialGradient", "title", "desc",   "metadata",
      "style",  "script",         "view",           "stop",  "font",   "cursor"};
  return std::find(kServing.begin(), kServing.end(), element) != kServing.end();
}

/// "10", or "1:10".
double drawing_scale(std::string_view text, const std::string& where) {
  if (text.empty()) return 1;
  SvgText reader(text, where + ": data-scale");
  double scale = reader.number();
  if (reader.skip(':')) scale = reader.number() / scale;
  constexpr double kMostScale = 1e6;
  if (reader.peek() != 0 || !(scale >= 1 / kMostScale && scale <= kMostScale))
    reader.fail("is no scale", "10, or 1:10");
  return scale;
}

class SvgReader {
 public:
  SvgReader(const std::filesystem::path& file, const SvgReadOptions& options)
      : xml_(file), folder_(file.parent_path()), options_(options) {
    document_.name = file.string();
  }

  SvgDocument read() {
    read_style_sheets();
    visit_children(xml_.root(), page());
    if (xml_.has_outer_style()) notes_.add("a style sheet of another file is not read", place());
    document_.notes = notes_.lines();
    return std::move(document_);
  }

 private:
  [[nodiscard]] std::string place() const { return xml_.place(xml_.root()); }

  // The page.

  /// Sets the size of the page, and gives what holds on it.
  Surroundings page() {
    const pugi::xml_node root = xml_.root();
    const auto view_box = view_box_of(root);
    const SvgBox size = page_size(view_box);
    const double scale = drawing_scale(root.attribute("data-scale").value(), place());
    const SvgBox user = view_box.value_or(SvgBox{0, 0, size.width, size.height});
    Surroundings page;
    double pixel = kSvgPixel_m * scale;
    const Eigen::Affine2d fit =
        view_box ? fit_svg_box(*view_box, size, aspect_of(root)) : Eigen::Affine2d::Identity();
    document_.page_unit = pixel * fit.linear().diagonal();
    if (options_.unit_m && !(options_.page_first && document_.true_size)) {
      document_.unit_m = options_.unit_m;
      pixel = *options_.unit_m;
      page.to_page = Eigen::Translation2d(-user.x, -user.y);
      document_.width_m = pixel * user.width;
      document_.height_m = pixel * user.height;
    } else {
      page.to_page = fit;
      document_.width_m = pixel * size.width;
      document_.height_m = pixel * size.height;
    }
    page.to_page = Eigen::Translation2d(0, document_.height_m) *
                   Eigen::AlignedScaling2d(Eigen::Vector2d(pixel, -pixel)) * page.to_page;
    document_.user_origin = page.to_page.translation();
    enter(root, page);
    page.width = user.width;
    page.height = user.height;
    return page;
  }

  /// In px; without sizes it is that of the view box, and 0 without one.
  SvgBox page_size(const std::optional<SvgBox>& view_box) {
    const SvgBox user = view_box.value_or(SvgBox{});
    const auto width = page_length("width", user.width);
    const auto height = page_length("height", user.height);
    document_.true_size = (width && width->absolute) || (height && height->absolute);
    SvgBox size{0, 0, user.width, user.height};
    if (width) size.width = width->px;
    if (height) size.height = height->px;
    if (view_box && width && !height) size.height = width->px * user.height / user.width;
    if (view_box && height && !width) size.width = height->px * user.width / user.height;
    return size;
  }

  /// Absent when it depends on a window: percentages and "auto".
  [[nodiscard]] std::optional<SvgLength> page_length(const char* name, double reference) const {
    const std::string_view text = xml_.root().attribute(name).value();
    if (text.empty() || text == "auto") return std::nullopt;
    const SvgLength length = parse_svg_length(text, reference, place() + ": " + name);
    if (length.percent) return std::nullopt;
    if (length.px <= 0) throw Error(std::string(name) + " is not positive", place(), "more than 0");
    return length;
  }

  /// Absent also where it has no extent.
  [[nodiscard]] std::optional<SvgBox> view_box_of(const pugi::xml_node& node) const {
    auto box =
        parse_svg_view_box(node.attribute("viewBox").value(), xml_.place(node) + ": viewBox");
    if (box && (box->width == 0 || box->height == 0)) box.reset();
    return box;
  }

  [[nodiscard]] SvgAspect aspect_of(const pugi::xml_node& node) const {
    return parse_svg_aspect(node.attribute("preserveAspectRatio").value(),
                            xml_.place(node) + ": preserveAspectRatio");
  }

  // Style.

  void read_style_sheets() {
    struct Walker : pugi::xml_tree_walker {
      const SvgXml* xml = nullptr;
      std::vector<pugi::xml_node> found;
      bool for_each(pugi::xml_node& node) override {
        if (xml->element(node) == "style") found.push_back(node);
        return true;
      }
    } walker;
    walker.xml = &xml_;
    xml_.root().traverse(walker);
    for (const pugi::xml_node& node : walker.found) {
      std::string css;
      for (const pugi::xml_node& text : node.children()) css += text.value();
      std::vector<std::string> ignored;
      sheet_.add(css, xml_.place(node), ignored);
      for (const std::string& what : ignored)
        notes_.add(what.substr(0, 200) + " of <style> is not understood", xml_.place(node));
    }
  }

  /// Takes on the element's transform and paint. False when it is not displayed.
  bool enter(const pugi::xml_node& node, Surroundings& around) {
    const SvgProperties properties = sheet_.cascade(
        selector_name(xml_, node), presentation_attributes(node), node.attribute("style").value());
    const auto property = [&](std::string_view name) -> std::string_view {
      const auto found = properties.find(name);
      return found == properties.end() ? std::string_view() : std::string_view(found->second);
    };
    if (property("display") == "none") return false;
    if (!property("transform").empty() && property("transform") != "none") {
      throw Error("has a transform in its style, which is not applied", xml_.place(node),
                  "the attribute transform");
    }
    note_style_of_geometry(node, properties);
    around.paint = inherited_paint(around.paint, properties, xml_, sheet_, xml_.place(node));
    const std::string_view transform = node.attribute("transform").value();
    if (!transform.empty()) {
      around.to_page =
          around.to_page * parse_svg_transform(transform, xml_.place(node) + ": transform");
      require_finite(around, node);
    }
    for (const char* name : {"clip-path", "mask"}) {
      const std::string_view value = property(name);
      if (!value.empty() && value != "none") add_clip(node, name, value, around);
    }
    around.overflows = property("overflow") == "visible" || property("overflow") == "auto";
    return true;
  }

  /// CSS may give places and sizes (SVG 2), which only some programs look at.
  void note_style_of_geometry(const pugi::xml_node& node, const SvgProperties& properties) {
    if (!is_svg_shape(xml_.element(node))) return;
    for (const char* name : {"x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "d"}) {
      if (properties.find(name) != properties.end())
        notes_.add("'" + std::string(name) + "' given by style is not applied", xml_.place(node));
    }
  }

  /// The clip path or mask that `value` names holds for `node` and what is in it.
  void add_clip(const pugi::xml_node& node, const std::string& property, std::string_view value,
                Surroundings& around) {
    constexpr std::size_t kMostQuoted = 100;
    const std::string id(id_of_svg_url(value).substr(0, kMostQuoted));
    SvgClip clip;
    clip.name = property + " '" + id + "' of " + name_of(node);
    const pugi::xml_node target = id.empty() ? pugi::xml_node() : xml_.find(id);
    if (!id.empty() && !target) {  // an unknown one is none
      return notes_.add(property + " names '" + id + "', which is not there", xml_.place(node));
    }
    if (property == "clip-path") clip.region = region_of(target, around);
    around.clips.push_back(static_cast<int>(document_.clips.size()));
    document_.clips.push_back(std::move(clip));
  }

  [[nodiscard]] std::string name_of(const pugi::xml_node& node) const {
    const std::string id = node.attribute("id").value();
    return std::string(xml_.element(node)) + (id.empty() ? "" : " '" + id + "'");
  }

  /// Of a clip path of one convex shape; empty of any other.
  [[nodiscard]] std::vector<Eigen::Vector2d> region_of(const pugi::xml_node& clip,
                                                       const Surroundings& around) {
    if (xml_.element(clip) != "clipPath" || clip.attribute("clip-path") ||
        clip.attribute("style") || clip.attribute("class") ||
        std::string_view(clip.attribute("clipPathUnits").value()) == "objectBoundingBox")
      return {};
    pugi::xml_node shape;
    for (const pugi::xml_node& child : clip.children()) {
      if (xml_.element(child).empty() || only_serves(xml_.element(child))) continue;
      if (shape || !is_svg_shape(xml_.element(child))) return {};
      shape = child;
    }
    const std::string_view style = shape.attribute("style").value();
    if (!shape || shape.attribute("clip-path") || shape.attribute("display") ||
        style.find("clip-path") != std::string_view::npos ||
        style.find("display") != std::string_view::npos)
      return {};
    Eigen::Affine2d to_page = around.to_page;
    for (const pugi::xml_node& node : {clip, shape}) {
      to_page = to_page * parse_svg_transform(node.attribute("transform").value(),
                                              xml_.place(node) + ": transform");
    }
    const auto lines = lines_of(shape, xml_.element(shape), around, to_page);
    count_points(lines, shape);
    return convex_region(lines);
  }

  void require_finite(const Surroundings& around, const pugi::xml_node& node) const {
    constexpr double kLargest = 1e100;
    if (around.to_page.matrix().cwiseAbs().maxCoeff() < kLargest) return;
    throw Error("is transformed beyond all numbers", xml_.place(node), "transforms of a drawing");
  }

  // Elements.

  void visit_children(const pugi::xml_node& node, const Surroundings& around) {
    for (const pugi::xml_node& child : node.children()) visit(child, around);
  }

  void visit(const pugi::xml_node& node, Surroundings around) {
    const std::string_view element = xml_.element(node);
    if (element.empty() || only_serves(element)) return;
    require_count(++elements_, "elements", kMostSvgElements, document_.name);
    require_count(elements_ * static_cast<double>(sheet_.size()),
                  "comparisons of elements with rules of style", kMostSvgMatches, document_.name);
    if (++around.depth > kMostNesting) {
      throw Error("elements are nested too deep", xml_.place(node),
                  "at most " + std::to_string(kMostNesting) + " levels");
    }
    const bool shape = is_svg_shape(element);
    const bool group = element == "g" || element == "a" || element == "svg" || element == "use";
    const bool displayed = enter(node, around);
    if (group) return visit_group(node, element, displayed, std::move(around));
    if (!displayed) return;
    if (shape) return add_shape(node, element, around);
    if (element == "switch") return visit_switch(node, around);
    if (element == "image") return add_image(node, around);
    notes_.add("<" + std::string(element.substr(0, 50)) + "> is not read" +
                   (element == "text" || element == "flowRoot" ? ": make a path of it" : ""),
               xml_.place(node));
  }

  void visit_group(const pugi::xml_node& node, std::string_view element, bool displayed,
                   Surroundings around) {
    SvgGroup group;
    group.tags = tags_of(node);
    group.parent = around.group;
    group.layer = xml_.inkscape(node, "groupmode") == "layer";
    group.hidden = !displayed;
    around.group = static_cast<int>(document_.groups.size());
    if (group.layer) around.layer = group.name();
    document_.groups.push_back(std::move(group));
    if (!displayed) return;
    if (element == "use") return visit_use(node, around);
    if (element == "svg") enter_viewport(node, node, around, true);
    visit_children(node, around);
  }

  /// The first child that any program can draw.
  void visit_switch(const pugi::xml_node& node, const Surroundings& around) {
    for (const pugi::xml_node& child : node.children()) {
      const std::string_view element = xml_.element(child);
      if (element.empty() || element == "foreignObject" || child.attribute("requiredExtensions") ||
          child.attribute("systemLanguage"))
        continue;
      return visit(child, around);
    }
  }

  /// Inside of a nested svg or a symbol.
  /// @param sized   gives width and height: itself, or the `use` that shows it
  /// @param placed  its own x and y hold
  void enter_viewport(const pugi::xml_node& node, const pugi::xml_node& sized, Surroundings& around,
                      bool placed) {
    const auto length = [&](const pugi::xml_node& of, const char* name, double reference,
                            double otherwise) {
      const std::string_view text = of.attribute(name).value();
      if (text.empty() || text == "auto") return otherwise;
      return parse_svg_length(text, reference, xml_.place(of) + ": " + name).px;
    };
    const auto size = [&](const char* name, double reference) {
      const double own = length(node, name, reference, reference);
      return &sized == &node ? own : length(sized, name, reference, own);
    };
    SvgBox box;
    box.x = placed ? length(node, "x", around.width, 0) : 0;
    box.y = placed ? length(node, "y", around.height, 0) : 0;
    box.width = size("width", around.width);
    box.height = size("height", around.height);
    const auto view_box = view_box_of(node);
    const SvgBox user = view_box.value_or(SvgBox{0, 0, box.width, box.height});
    if (!around.overflows) add_viewport(node, box, around);
    if (view_box) {
      around.to_page = around.to_page * fit_svg_box(*view_box, box, aspect_of(node));
    } else {
      around.to_page.translate(Eigen::Vector2d(box.x, box.y));
    }
    around.width = user.width;
    around.height = user.height;
    require_finite(around, node);
  }

  /// What is drawn beyond the box is hidden, by some programs.
  void add_viewport(const pugi::xml_node& node, const SvgBox& box, Surroundings& around) {
    SvgClip clip;
    clip.name = "the viewport of " + name_of(node);
    clip.viewport = true;
    const double right = box.x + box.width, down = box.y + box.height;
    const Eigen::Vector2d corners[] = {
        {box.x, box.y}, {box.x, down}, {right, down}, {right, box.y}};
    for (const Eigen::Vector2d& p : corners) clip.region.emplace_back(around.to_page * p);
    if (around.to_page.linear().determinant() > 0)
      std::reverse(clip.region.begin(), clip.region.end());
    around.clips.push_back(static_cast<int>(document_.clips.size()));
    document_.clips.push_back(std::move(clip));
  }

  void visit_use(const pugi::xml_node& node, Surroundings around) {
    const std::string_view href = xml_.href(node);
    if (href.empty()) return notes_.add("<use> names nothing", xml_.place(node));
    if (!href.starts_with('#')) {
      throw Error("<use> of '" + std::string(href.substr(0, 200)) +
                      "' leads out of the file, which is never followed",
                  xml_.place(node), "#id of an element of this file");
    }
    const pugi::xml_node target = xml_.find(href.substr(1));
    if (!target)
      return notes_.add("<use> of " + std::string(href.substr(0, 200)) + ", which is not there",
                        xml_.place(node));
    if (std::find(used_.begin(), used_.end(), target) != used_.end())
      throw Error("<use> of '" + std::string(href.substr(0, 200)) + "' leads to itself",
                  xml_.place(node), "an element that does not hold it");
    around.to_page.translate(Eigen::Vector2d(parse_length(node, "x", around.width),
                                             parse_length(node, "y", around.height)));
    used_.push_back(target);
    const std::string_view element = xml_.element(target);
    if (element == "symbol") {
      if (enter(target, around)) {
        enter_viewport(target, node, around, false);
        visit_children(target, around);
      }
    } else {
      visit(target, around);
    }
    used_.pop_back();
  }

  [[nodiscard]] double parse_length(const pugi::xml_node& node, const char* name,
                                    double reference) const {
    const std::string_view text = node.attribute(name).value();
    return text.empty() ? 0 : parse_svg_length(text, reference, xml_.place(node) + ": " + name).px;
  }

  [[nodiscard]] SvgTags tags_of(const pugi::xml_node& node) const {
    SvgTags tags;
    tags.id = node.attribute("id").value();
    tags.label = xml_.inkscape(node, "label");
    for (const std::string_view name : selector_name(xml_, node).classes)
      tags.classes.emplace_back(name);
    constexpr std::string_view kData = "data-";
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (name.starts_with(kData)) tags.data.emplace(name.substr(kData.size()), attribute.value());
    }
    tags.line = xml_.line(node);
    return tags;
  }

  void add_shape(const pugi::xml_node& node, std::string_view element, const Surroundings& around) {
    if (!around.paint.visible) return;
    SvgShape shape;
    shape.tags = tags_of(node);
    shape.element = element;
    shape.group = around.group;
    shape.layer = around.layer;
    shape.stroked = around.paint.stroked;
    shape.stroke = around.paint.stroke;
    shape.dashed = around.paint.dashed;
    shape.filled = around.paint.filled;
    shape.even_odd = around.paint.even_odd;
    shape.clips = around.clips;
    shape.lines = lines_of(node, element, around, around.to_page);
    count_points(shape.lines, node);
    document_.shapes.push_back(std::move(shape));
  }

  void count_points(const std::vector<SvgSubpath>& lines, const pugi::xml_node& node) {
    for (const SvgSubpath& line : lines) points_ += static_cast<double>(line.points.size());
    require_count(points_, "points of lines", kMostSvgPoints, xml_.place(node));
  }

  /// The lines that a shape draws (m).
  [[nodiscard]] std::vector<SvgSubpath> lines_of(const pugi::xml_node& node,
                                                 std::string_view element,
                                                 const Surroundings& around,
                                                 const Eigen::Affine2d& to_page) const {
    const SvgAttributes attributes = [&](std::string_view name) -> std::string_view {
      return node.attribute(std::string(name).c_str()).value();
    };
    const SvgShapeFrame frame{around.width, around.height,
                              options_.tolerance / largest_stretch(to_page)};
    std::vector<SvgSubpath> lines = svg_shape_lines(element, attributes, frame, xml_.place(node));
    for (SvgSubpath& line : lines) {
      for (Eigen::Vector2d& p : line.points) p = to_page * p;
    }
    return lines;
  }

  void add_image(const pugi::xml_node& node, const Surroundings& around) {
    const std::string_view href = xml_.href(node);
    const std::string where = xml_.place(node);
    if (!around.paint.visible || href.empty()) return;
    SvgImage image;
    image.tags = tags_of(node);
    image.group = around.group;
    image.layer = around.layer;
    image.aspect = aspect_of(node);
    const double x = parse_length(node, "x", around.width);
    const double y = parse_length(node, "y", around.height);
    const double width = parse_length(node, "width", around.width);
    const double height = parse_length(node, "height", around.height);
    if (!(width > 0 && height > 0))
      throw Error("a picture without width and height", where, "both, more than 0");
    image.origin = around.to_page * Eigen::Vector2d(x, y + height);
    image.right = around.to_page.linear() * Eigen::Vector2d(width, 0);
    image.up = around.to_page.linear() * Eigen::Vector2d(0, -height);
    if (is_data_link(href)) {
      SvgData data = parse_data_link(href, where);
      image.media_type = std::move(data.media_type);
      image.bytes = std::move(data.bytes);
    } else {
      image.file = file_of_link(href, folder_, where);
    }
    document_.images.push_back(std::move(image));
  }

  const SvgXml xml_;
  const std::filesystem::path folder_;
  const SvgReadOptions& options_;
  SvgStyleSheet sheet_;
  SvgNotes notes_;
  SvgDocument document_;
  std::vector<pugi::xml_node> used_;  ///< what the `use`s around show
  double elements_ = 0, points_ = 0;
};

}  // namespace

std::string SvgDocument::place(const std::string& element, const SvgTags& tags) const {
  return name + ":" + std::to_string(tags.line) + ": " + element +
         (tags.id.empty() ? "" : " '" + tags.id + "'");
}

SvgDocument read_svg_document(const std::filesystem::path& file, const SvgReadOptions& options) {
  if (!(options.tolerance > 0))
    throw Error("tolerance is not positive", file.string(), "more than 0");
  if (options.unit_m && !(*options.unit_m > 0))
    throw Error("unit_m is not positive", file.string(), "more than 0");
  return SvgReader(file, options).read();
}

}  // namespace geoprior
