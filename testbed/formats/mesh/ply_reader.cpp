#include "testbed/formats/mesh/ply_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "core/error.h"
#include "testbed/formats/mesh/ply_header.h"
#include "testbed/formats/mesh/polygon_soup.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

static_assert(std::endian::native == std::endian::little, "little-endian PLY is read as it is");

using Element = PlyHeader::Element;
using Type = PlyHeader::Type;

/// The values of a binary file, one after the other.
class BinaryValues {
 public:
  BinaryValues(std::string_view data, std::size_t first_byte, bool swapped, std::string name)
      : data_(data), first_(first_byte), swapped_(swapped), name_(std::move(name)) {}

  double next(Type type) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      case Type::float32:
        return take<float>();
      case Type::float64:
        return take<double>();
    }
    return 0;
  }
  [[nodiscard]] std::size_t left() const { return data_.size() - at_; }
  [[nodiscard]] std::string place() const {
    return name_ + ", byte " + std::to_string(first_ + at_);
  }
  /// Whether `count` elements can follow at all.
  [[nodiscard]] bool can_hold(const Element& element, long long count) const {
    return static_cast<double>(element.least_bytes()) * static_cast<double>(count) <=
           static_cast<double>(left());
  }
  [[nodiscard]] bool at_end(const Element& element) const { return left() < element.least_bytes(); }

 private:
  template <class T>
  T take() {
    if (left() < sizeof(T)) throw Error("is truncated", place());
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), data_.data() + at_, sizeof(T));
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  std::string_view data_;
  std::size_t first_, at_ = 0;
  bool swapped_;
  std::string name_;
};

/// The values of a text, words in any arrangement of lines.
class TextValues {
 public:
  TextValues(std::string_view data, int first_line, const std::string& name)
      : lines_(data, name, first_line) {}

  double next(Type) {
    if (!has_word()) throw Error("is truncated", lines_.place());
    // A fraction is only read as such: indices are checked where they are used.
    return lines_.number_at(word_++);
  }
  [[nodiscard]] std::string place() const { return lines_.place(); }
  [[nodiscard]] bool can_hold(const Element&, long long count) const {
    return static_cast<double>(count) <=
           static_cast<double>(lines_.rest().size() + lines_.line().size());
  }
  [[nodiscard]] bool at_end(const Element& element) {
    return !element.properties.empty() && !has_word();
  }

 private:
  bool has_word() {
    if (word_ < lines_.words().size()) return true;
    word_ = 0;
    return lines_.next_with_words();
  }

  TextLines lines_;
  std::size_t word_ = 0;
};

template <class Values>
int integer(double value, const char* what, const Values& at) {
  constexpr double kMost = std::numeric_limits<int>::max();
  if (!(std::abs(value) <= kMost) || value != std::floor(value)) {
    throw Error(std::string(what) + " is no whole number", at.place());
  }
  return static_cast<int>(value);
}

/// The number at the end of "name_2", of a property with others of that name.
struct ComponentName {
  std::string name;
  int component = 0;
};

std::optional<ComponentName> component_name(const std::string& property) {
  const std::size_t at = property.find_last_not_of("0123456789");
  if (at == std::string::npos || at == 0 || property[at] != '_') return std::nullopt;
  const std::string digits = property.substr(at + 1);
  if (digits.empty() || digits.size() > 4) return std::nullopt;
  return ComponentName{property.substr(0, at), std::stoi(digits)};
}

/// Numbers of an element beside its coordinates or corners, row by row.
class FurtherProperties {
 public:
  /// @param part  gets them; null: they are skipped
  FurtherProperties(const Element& element, const std::vector<std::size_t>& known,
                    NamedArray::On on, Part* part)
      : on_(on), part_(part) {
    if (part == nullptr) return;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const bool is_known = std::find(known.begin(), known.end(), p) != known.end();
      if (is_known || element.properties[p].count) continue;
      columns_.push_back({element.properties[p].name, p, {}});
      columns_.back().values.reserve(element.count);
    }
  }
  void add(const std::vector<double>& row) {
    for (Column& column : columns_) column.values.push_back(row[column.property]);
  }
  /// Adds them to the part as arrays.
  void finish() const {
    for (std::size_t first = 0; first < columns_.size();) {
      const auto head = component_name(columns_[first].name);
      std::size_t end = first + 1;
      if (head && head->component == 0) {
        for (; end < columns_.size(); ++end) {
          const auto next = component_name(columns_[end].name);
          const bool follows =
              next && next->name == head->name && next->component == static_cast<int>(end - first);
          if (!follows) break;
        }
      }
      NamedArray array;
      array.name = end - first > 1 ? head->name : columns_[first].name;
      array.on = on_;
      array.values.resize(std::ssize(columns_[first].values),
                          static_cast<Eigen::Index>(end - first));
      for (std::size_t c = first; c < end; ++c) {
        array.values.col(static_cast<Eigen::Index>(c - first)) = Eigen::Map<const Eigen::VectorXd>(
            columns_[c].values.data(), std::ssize(columns_[c].values));
      }
      part_->arrays.push_back(std::move(array));
      first = end;
    }
  }

 private:
  struct Column {
    std::string name;
    std::size_t property;
    std::vector<double> values;
  };
  NamedArray::On on_;
  Part* part_;
  std::vector<Column> columns_;
};

/// Reads the elements in the order of the file into a soup.
template <class Values>
class ElementReader {
 public:
  /// @param part  gets edges and further properties; null: they are left out
  ElementReader(Values values, PolygonSoup& soup, std::vector<std::string>& notes, Part* part)
      : values_(std::move(values)), soup_(soup), notes_(notes), part_(part) {}

  void read(const Element& element) {
    if (element.properties.empty()) return;
    if (!values_.can_hold(element, element.count)) truncated(element, 0);
    if (element.name == "vertex") return vertices(element);
    if (element.name == "face") return faces(element);
    if (element.name == "tristrips") return strips(element);
    if (element.name == "edge" && part_ != nullptr) return edges(element);
    if (element.count > 0) {
      notes_.push_back(std::to_string(element.count) + " of its element '" +
                       element.name.substr(0, 40) + "' left out");
    }
    rows(
        element, [](std::size_t, double) {}, [] {});
  }

 private:
  [[noreturn]] void truncated(const Element& element, long long i) const {
    throw Error("is truncated: has not all " + std::to_string(element.count) + " of '" +
                    element.name + "', ends before or in number " + std::to_string(i),
                values_.place());
  }

  int length(const PlyHeader::Property& property) {
    const int n = integer(values_.next(*property.count), "length of a list", values_);
    if (n < 0) throw Error("length of a list is negative", values_.place());
    return n;
  }

  /// Goes through all values: `value(property, x)` for each number, `end()` after each element.
  template <class Value, class End>
  void rows(const Element& element, const Value& value, const End& end) {
    for (long long i = 0; i < element.count; ++i) {
      if (values_.at_end(element)) truncated(element, i);
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyHeader::Property& property = element.properties[p];
        const int n = property.count ? length(property) : 1;
        for (int k = 0; k < n; ++k) value(p, values_.next(property.type));
      }
      end();
    }
  }

  void vertices(const Element& element) {
    const auto x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"});
    if (!x || !y || !z) throw Error("its vertices have no x, y, z", values_.place());
    const auto u = element.find({"vx", "velocity_0"}), v = element.find({"vy", "velocity_1"}),
               w = element.find({"vz", "velocity_2"});
    const bool moving = u && v && w;
    std::vector<double> row(element.properties.size());
    soup_.points.reserve(element.count);
    FurtherProperties further(element, {*x, *y, *z}, NamedArray::On::points, part_);
    const auto finite = [&](Eigen::Vector3d vector, const char* what) {
      if (vector.allFinite()) return vector;
      throw Error(std::string(what) + " of vertex " + std::to_string(soup_.points.size()) +
                      " is not finite",
                  values_.place());
    };
    rows(
        element, [&](std::size_t p, double value) { row[p] = value; },
        [&] {
          if (moving) {
            soup_.velocity.push_back(finite({row[*u], row[*v], row[*w]}, "velocity"));
          }
          soup_.points.push_back(finite({row[*x], row[*y], row[*z]}, "position"));
          further.add(row);
        });
    further.finish();
  }

  void faces(const Element& element) {
    const auto corners = element.find({"vertex_indices", "vertex_index"});
    if (!corners || !element.properties[*corners].count) {
      throw Error("its faces have no list vertex_indices", values_.place());
    }
    soup_.ends.reserve(element.count);
    std::vector<double> row(element.properties.size());
    FurtherProperties further(element, {*corners}, NamedArray::On::cells, part_);
    rows(
        element,
        [&](std::size_t p, double value) {
          row[p] = value;
          if (p == *corners) {
            soup_.corners.push_back(integer(value, "index of a vertex", values_));
          }
        },
        [&] {
          soup_.end_face();
          further.add(row);
        });
    const bool all_triangles = soup_.corners.size() == 3 * soup_.ends.size();
    if (all_triangles) further.finish();
  }

  /// Pairs of vertices, each a line of its own.
  void edges(const Element& element) {
    const auto first = element.find({"vertex1"}), second = element.find({"vertex2"});
    if (!first || !second) throw Error("its edges have no vertex1, vertex2", values_.place());
    std::vector<double> row(element.properties.size());
    FurtherProperties further(element, {*first, *second}, NamedArray::On::cells, part_);
    const auto vertex = [&](double value) {
      const int v = integer(value, "index of a vertex", values_);
      if (v >= 0 && v < std::ssize(soup_.points)) return v;
      throw Error("an edge names vertex " + std::to_string(v) + " of " +
                      std::to_string(soup_.points.size()),
                  values_.place());
    };
    rows(
        element, [&](std::size_t p, double value) { row[p] = value; },
        [&] {
          part_->lines.push_back({vertex(row[*first]), vertex(row[*second])});
          further.add(row);
        });
    further.finish();
  }

  /// Lists of vertices, each with the two before it a triangle, every second one turned over; -1
  /// begins another strip. A triangle that names a vertex twice only joins two strips.
  void strips(const Element& element) {
    const auto corners = element.find({"vertex_indices", "vertex_index"});
    if (!corners || !element.properties[*corners].count) {
      throw Error("its strips have no list vertex_indices", values_.place());
    }
    std::array<int, 2> before{};
    int length = 0;  // of the strip so far
    rows(
        element,
        [&](std::size_t p, double value) {
          if (p != *corners) return;
          const int v = integer(value, "index of a vertex", values_);
          if (v == -1) {
            length = 0;
            return;
          }
          if (length >= 2 && before[0] != before[1] && v != before[0] && v != before[1]) {
            const bool odd = length % 2 != 0;
            for (const int corner : {before[odd ? 1 : 0], before[odd ? 0 : 1], v})
              soup_.corners.push_back(corner);
            soup_.end_face();
          }
          before = {before[1], v};
          ++length;
        },
        [&] { length = 0; });
  }

  Values values_;
  PolygonSoup& soup_;
  std::vector<std::string>& notes_;
  Part* part_;
};

template <class Values>
void read_elements(const PlyHeader& header, Values values, PolygonSoup& soup,
                   std::vector<std::string>& notes, Part* part) {
  ElementReader<Values> reader(std::move(values), soup, notes, part);
  for (const Element& element : header.elements) reader.read(element);
}

MeshFile read_ply(std::string_view bytes, const PlyHeader& header, const std::string& name,
                  Part* part) {
  if (header.element("vertex") == nullptr) throw Error("has no element 'vertex'", name);
  PolygonSoup soup;
  std::vector<std::string> notes;
  const std::string_view data = bytes.substr(header.data);
  if (header.format == PlyHeader::Format::ascii) {
    const std::string text = plain_text(std::string(data), name);
    read_elements(header, TextValues(text, header.data_line, name), soup, notes, part);
  } else {
    const bool swapped = header.format == PlyHeader::Format::big_endian;
    read_elements(header, BinaryValues(data, header.data, swapped, name), soup, notes, part);
  }
  MeshFile file = mesh_of(soup, name);
  file.notes = std::move(notes);
  return file;
}

}  // namespace

MeshFile parse_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  if (header.element("face") == nullptr && header.element("tristrips") == nullptr) {
    throw Error("has no element 'face'", name,
                "faces or tristrips; a cloud of points is no surface, a range_grid is not read");
  }
  return read_ply(bytes, header, name, nullptr);
}

Part parse_ply_part(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const bool has_faces = header.element("face") != nullptr;
  const bool has_edges = header.element("edge") != nullptr;
  if (header.element("tristrips") != nullptr || (has_faces && has_edges)) {
    throw Error("has strips, or faces and edges", name,
                "vertices with faces, with edges, or alone");
  }
  Part part;
  MeshFile file = read_ply(bytes, header, name, &part);
  if (!has_faces) part.kind = has_edges ? Part::Kind::lines : Part::Kind::points;
  part.points = std::move(file.mesh.V);
  part.triangles = std::move(file.mesh.F);
  return part;
}

}  // namespace geoprior
