#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace geoprior {

/// A plane that cuts the part: figure_view.section = { origin = [x, y, z], normal = [x, y, z] }.
/// Metres; the eye is on the side of the normal that the picture's direction is on.
struct SectionView {
  std::array<double, 3> origin{0, 0, 0};
  std::array<double, 3> normal{0, 0, 1};
};

/// A row of another part, or of an input, over or under the others: figure_view.above = { part = …
/// }.
struct FurtherRow {
  std::string part = "surface";
  std::optional<std::string> input;  ///< "run:…" of the scene: its frames; absent: this run's
  std::string label;                 ///< absent: the part's name
  std::optional<std::string> color_by;
  std::vector<std::string> classes;
  std::string labels;
  std::vector<double> target;  ///< three numbers (m); empty: fitted
  std::array<double, 3> direction{0, 0, 1};
  std::array<double, 3> up{0, 1, 0};
  std::optional<double> height_m;
  std::vector<std::string> overlays;
  std::vector<std::string> variants;  ///< empty: those of the figure; else without their names
  std::vector<double> parameters;     ///< frames; empty: those of the figure
};

struct PlanePoint {
  double u = 0;
  double v = 0;
};

/// What theory says of a path, dashed in every flat pattern: figure_view.expected = { label = …,
/// points = [{ u = …, v = … }, …] }. Straight from point to point (m).
struct ExpectedCurve {
  std::string label = "Expected";
  std::vector<PlanePoint> points;
};

/// Where a picture is looked at from, as a scene suggests it: the keys of figure_view of these
/// names.
struct Camera {
  std::array<double, 3> target{0, 0, 0};
  std::array<double, 3> direction{0, 0, 1};
  std::array<double, 3> up{0, 1, 0};
  double height_m = 1;
};

/// How the picture of a run is drawn: what the experiment file says, over what its topic says.
/// Positions in metres; absent: fitted to the part.
struct FigureView {
  enum class Shading { smooth, flat };
  enum class Material { clay, paper, water };
  enum class Across { variants, states, cases };

  std::optional<double> at_parameter;  ///< frame drawn; absent: the last
  std::vector<double> parameters;      ///< further columns/rows, when more than one frame is drawn
  Across across = Across::variants;    ///< what stands side by side; the others are rows
  std::string part = "surface";
  std::string label;  ///< of the rows, when others are above or below; absent: the part's
  std::optional<std::string> color_by;
  /// Of `color_by`: the names of its integers 0, 1, …; empty: those that the array has, if any.
  std::vector<std::string> classes;
  /// A named array of the part or of overlays, whose names stand beside what they are of; empty:
  /// none.
  std::string labels;
  bool identities = false;  ///< the integers of `color_by` tell things apart, 0 is none
  Shading shading = Shading::smooth;
  Material material =
      Material::clay;  ///< paper: an open sheet with two sides; water: reflects a sky
  bool edges = false;  ///< the triangles' edges as thin lines
  /// Adds the same panels in plain material: flat, without colours, edges and overlays, under a
  /// light that grazes.
  bool plain = false;
  std::string plain_part;  ///< what they show, where a frame has it; empty or absent: `part`
  std::optional<std::array<double, 3>> target;
  std::array<double, 3> direction{0, 0, 1};
  std::array<double, 3> up{0, 1, 0};
  std::optional<double> height_m;  ///< height of the view (parallel projection)
  /// The experiment file gives none of the last four: a scene may suggest them.
  bool camera_is_free = true;
  std::optional<SectionView> section;  ///< adds a row with the cut, overlaps of the solid in red
  std::optional<FurtherRow> above;     ///< with a camera and colours of its own
  std::optional<FurtherRow> below;     ///< likewise
  std::vector<std::string> overlays;   ///< further parts drawn over `part` ("rulings", "strokes")
  /// Overlays drawn over the flat pattern of the sheet, which then stands beside it; empty: it does
  /// not.
  std::vector<std::string> pattern;
  std::optional<ExpectedCurve> expected;
  std::vector<std::string> variants;  ///< empty: all
  std::vector<std::string> cases;     ///< empty: all
  std::vector<std::string> metrics;   ///< curves of metrics.svg; empty: all that vary
  int contact_sheet = 0;              ///< frames of contact-sheet.png; 0: none is drawn
};

}  // namespace geoprior
