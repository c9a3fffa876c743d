#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// A named array over the points or the cells of a part; one row per element, one column per
/// component.
struct NamedArray {
  enum class On { points, cells };
  std::string name;
  std::string unit;  ///< SI, "1" for a ratio
  On on = On::points;
  Eigen::MatrixXd values;
  /// Where the values are codes 0, 1, …: what each of them stands for. Empty: they are numbers.
  std::vector<std::string> names = {};
};

/// One piece of geometry of a frame: triangles, poly-lines, points or a regular grid.
struct Part {
  enum class Kind { triangles, lines, points, grid };
  Kind kind = Kind::triangles;
  Eigen::MatrixX3d points;              ///< metres; unused by a grid
  Eigen::MatrixX3i triangles;           ///< kind == triangles
  std::vector<std::vector<int>> lines;  ///< kind == lines: one poly-line an entry
  std::array<int, 3> grid_size{1, 1,
                               1};  ///< kind == grid: points along x, y, z; arrays run x fastest
  Eigen::Vector3d grid_origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d grid_spacing = Eigen::Vector3d::Ones();
  std::vector<NamedArray> arrays;

  /// Rows that an array over points or over cells has here: cells are triangles, poly-lines, single
  /// points, or the boxes of a grid (flat along an axis with one point).
  [[nodiscard]] Eigen::Index count(NamedArray::On on) const;
  /// The first array of that name; null when there is none.
  [[nodiscard]] const NamedArray* find_array(std::string_view name) const;
  [[nodiscard]] const NamedArray* find_array(std::string_view name, NamedArray::On on) const;
  /// @param where  what the error calls this part
  /// @throws Error  when there is no such array, or it has another number of components or rows
  [[nodiscard]] const NamedArray& require_array(std::string_view name, NamedArray::On on,
                                                std::optional<int> components = {},
                                                const std::string& where = "part") const;
};

/// "triangles", "lines", "points" or "grid".
std::string kind_name(Part::Kind kind);

/// A small table of numbers that belongs to a frame (pieces of a surface, steps of a solver).
struct FrameTable {
  std::vector<std::string> columns;  ///< "name [unit]"
  Eigen::MatrixXd rows;
};

/// One recorded state: a pose, a time, an iteration, a variation, a day. Frames are compared by
/// parameter, not by index.
struct Frame {
  double parameter = 0;  ///< angle, time, iteration …; the scene says which and its unit
  std::map<std::string, Part> parts;  ///< "surface", "rulings", "strokes", …
  std::map<std::string, FrameTable> tables;
  std::map<std::string, double>
      diagnostics;  ///< what only the method can know: iterations, residual, evaluations

  /// Null when there is none of that name.
  [[nodiscard]] const Part* find_part(const std::string& name) const;
  [[nodiscard]] const FrameTable* find_table(const std::string& name) const;
  /// @throws Error  naming what is missing and what is there, as all of these
  [[nodiscard]] const Part& require_part(const std::string& name) const;
  [[nodiscard]] const Part& require_part(const std::string& name, Part::Kind kind) const;
  [[nodiscard]] const FrameTable& require_table(const std::string& name) const;
  /// As `Part::require_array`, of a part.
  [[nodiscard]] const NamedArray& require_array(const std::string& part, std::string_view name,
                                                NamedArray::On on,
                                                std::optional<int> components = {}) const;
};

/// A discrete event for sound and for logs.
///
/// `numbers` holds what only events of this kind have: lengths of a resonator, its area, the sample
/// that was played. Their names are letters, digits, _ and -, none of them that of a field below,
/// and end in the unit where there is one ("area_m2", "l_r_m"); their values are finite.
struct Event {
  double time_s = 0;
  std::string kind;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double energy_J = 0;
  double duration_s = 0;
  std::map<std::string, double> numbers = {};
};

/// A file that belongs to a run but is no frame (WAV, SVG, EXR, glTF): stored beside the frames
/// with its checksum.
struct Artifact {
  std::string name;  ///< file name with extension, no folder
  std::vector<std::byte> bytes;
};

}  // namespace geoprior
