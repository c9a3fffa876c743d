#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbed/formats/svg/color.h"
#include "testbed/formats/svg/path.h"
#include "testbed/formats/svg/viewport.h"

namespace geoprior {

/// Most elements that an SVG file may draw, those that `use` repeats counted again.
inline constexpr double kMostSvgElements = 1e6;
/// Most points of all its lines.
inline constexpr double kMostSvgPoints = 5e6;

/// What can be said of an element beside its geometry.
struct SvgTags {
  std::string id;                                        ///< may be empty
  std::string label;                                     ///< inkscape:label; may be empty
  std::vector<std::string> classes;                      ///< of its attribute `class`
  std::map<std::string, std::string, std::less<>> data;  ///< `data-kind` as "kind"
  std::size_t line = 0;                                  ///< in the file, from 1
};

/// <g>, <a>, a nested <svg>, or a <use> around what it repeats.
struct SvgGroup {
  SvgTags tags;
  int parent = -1;      ///< index of the group around it, -1: none
  bool layer = false;   ///< of Inkscape: inkscape:groupmode="layer"
  bool hidden = false;  ///< display:none: what is in it was not read

  /// Label, or id where it has none.
  [[nodiscard]] const std::string& name() const {
    return tags.label.empty() ? tags.id : tags.label;
  }
};

/// A path or a basic shape as it is drawn.
struct SvgShape {
  SvgTags tags;
  std::string element;              ///< "path", "line", "circle", …
  int group = -1;                   ///< innermost group, -1: none
  std::string layer;                ///< name of the innermost Inkscape layer; may be empty
  bool stroked = false;             ///< its outline is drawn
  std::optional<SvgColour> stroke;  ///< absent: not stroked, or with no single colour
  bool dashed = false;
  bool filled = true;
  bool even_odd = false;          ///< fill-rule: evenodd, else nonzero
  std::vector<int> clips;         ///< indices of what hides parts of it; its lines are whole
  std::vector<SvgSubpath> lines;  ///< metres, y up
};

/// A picture on the page. Its corners are `origin`, `origin + right`, `origin + up`, and the
/// fourth.
struct SvgImage {
  SvgTags tags;
  int group = -1;
  std::string layer;
  std::filesystem::path file;  ///< below the folder of the drawing, not looked at; or empty:
  std::string media_type;      ///< "image/png" …
  std::string bytes;           ///< … and content of an embedded picture
  Eigen::Vector2d origin{0, 0}, right{0, 0}, up{0, 0};  ///< of the box (m)
  SvgAspect aspect;  ///< how the picture is fitted into its box, which nobody has done yet
};

/// What an SVG file draws, as plain values.
struct SvgDocument {
  std::string name;  ///< of the file, for errors
  /// Size of the page (m); 0 where the file says nothing of it. Its lower left corner is the
  /// origin; of a page without a height, the upper left one.
  double width_m = 0, height_m = 0;
  Eigen::Vector2d user_origin{0, 0};  ///< place of (0, 0) of the outermost viewBox (m)
  bool true_size = false;             ///< the file says how large it is in mm, cm, in, pt or pc
  /// One unit of the outermost viewBox by the size of the page (m), along x and y: not equal where
  /// the page stretches it. A px is taken for a 96th of an inch.
  Eigen::Vector2d page_unit{0, 0};
  std::optional<double> unit_m;  ///< what was taken instead of the page's size
  std::vector<SvgGroup> groups;  ///< parents first
  std::vector<SvgShape> shapes;  ///< in the order in which they are drawn
  std::vector<SvgImage> images;
  std::vector<SvgClip> clips;
  std::vector<std::string> notes;  ///< what was left out, a line for each kind with its first place

  /// "drawing.svg:12: path 'seam-3'".
  [[nodiscard]] std::string place(const std::string& element, const SvgTags& tags) const;
};

struct SvgReadOptions {
  double tolerance = 1e-4;       ///< largest distance of a curve from its chords (m, true size)
  std::optional<double> unit_m;  ///< metres for one unit of the outermost viewBox; the file's
  bool page_first = false;       ///< unit_m holds only where the page has no true size
};

/// Reads an SVG file.
///
/// Read: g, a, switch, nested svg, symbol and use (inside of the file), path and the basic shapes,
/// image; transform, viewBox, preserveAspectRatio; lengths in px, mm, cm, Q, in, pt, pc and %;
/// stroke, stroke-dasharray, color, display, visibility, fill-rule from attributes, style and
/// <style> (style.h). `data-scale` of the outermost svg enlarges what is drawn: 10, or "1:10". Left
/// out, and said in `notes`: text, selectors and rules of style that are not understood, places and
/// sizes given by style. Clip paths, masks and viewports are told (`clips`) and not applied. Never
/// drawn: defs and what else only serves others.
///
/// Nothing but the file is read, and no entity is expanded. A px is a 96th of an inch.
///
/// @throws Error  naming file, line and element: what SvgXml refuses, malformed data, a transform
///                given by style, `use` that leads to itself or out of the file, a picture outside
///                of the drawing's folder, too many elements or points
/// Source: SVG 1.1 (W3C 2011), SVG 2 where it is wider (W3C 2018).
SvgDocument read_svg_document(const std::filesystem::path& file, const SvgReadOptions& options);

}  // namespace geoprior
