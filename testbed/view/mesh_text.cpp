#include "testbed/view/mesh_text.h"

#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

namespace geoprior {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as little endian");

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

template <class T>
void put(std::string& out, T value) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(T));
  out.append(bytes.data(), bytes.size());
}

/// PLY splits its header at blanks.
std::string property_name(const std::string& name) {
  std::string out;
  for (const char c : name) {
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return out;
}

std::string property_lines(const Part& part, NamedArray::On on) {
  std::string text;
  for (const NamedArray& array : part.arrays) {
    if (array.on != on) continue;
    for (Eigen::Index c = 0; c < array.values.cols(); ++c) {
      text += "property double " + property_name(array.name) +
              (array.values.cols() > 1 ? "_" + std::to_string(c) : "") + "\n";
    }
  }
  return text;
}

void put_arrays(std::string& out, const Part& part, NamedArray::On on, Eigen::Index row) {
  for (const NamedArray& array : part.arrays) {
    if (array.on != on) continue;
    for (Eigen::Index c = 0; c < array.values.cols(); ++c) put(out, array.values(row, c));
  }
}

std::vector<std::array<int, 2>> edges_of(const Part& part) {
  std::vector<std::array<int, 2>> edges;
  for (const std::vector<int>& line : part.lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) edges.push_back({line[i], line[i + 1]});
  }
  return edges;
}

void put_faces(std::string& out, const Part& part) {
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    put(out, std::uint8_t{3});
    for (int i = 0; i < 3; ++i) put(out, static_cast<std::int32_t>(part.triangles(t, i)));
    put_arrays(out, part, NamedArray::On::cells, t);
  }
}

}  // namespace

bool is_mesh(const Part& part) { return part.kind != Part::Kind::grid; }

std::string part_to_obj(const Part& part, const std::string& comment) {
  std::string out = "# " + one_line(comment) + "\n";
  std::array<char, 96> line{};
  for (Eigen::Index i = 0; i < part.points.rows(); ++i) {
    std::snprintf(line.data(), line.size(), "v %.17g %.17g %.17g\n", part.points(i, 0),
                  part.points(i, 1), part.points(i, 2));
    out += line.data();
  }
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    std::snprintf(line.data(), line.size(), "f %d %d %d\n", part.triangles(t, 0) + 1,
                  part.triangles(t, 1) + 1, part.triangles(t, 2) + 1);
    out += line.data();
  }
  for (const std::vector<int>& poly_line : part.lines) {
    out += "l";
    for (const int point : poly_line) out += " " + std::to_string(point + 1);
    out += "\n";
  }
  if (part.kind == Part::Kind::points) {
    for (Eigen::Index i = 0; i < part.points.rows(); ++i)
      out += "p " + std::to_string(i + 1) + "\n";
  }
  return out;
}

std::string part_to_ply(const Part& part, const std::string& comment) {
  const auto edges = edges_of(part);
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment " + one_line(comment) + "\n";
  out += "element vertex " + std::to_string(part.points.rows()) + "\n";
  out += "property double x\nproperty double y\nproperty double z\n";
  out += property_lines(part, NamedArray::On::points);
  if (part.kind == Part::Kind::triangles) {
    out += "element face " + std::to_string(part.triangles.rows()) + "\n";
    out += "property list uchar int vertex_indices\n";
    out += property_lines(part, NamedArray::On::cells);
  } else if (part.kind == Part::Kind::lines) {
    // An array on the lines has one value a poly-line, not one an edge: it stays in the .vtp.
    out += "element edge " + std::to_string(edges.size()) + "\n";
    out += "property int vertex1\nproperty int vertex2\n";
  }
  out += "end_header\n";
  for (Eigen::Index i = 0; i < part.points.rows(); ++i) {
    for (int c = 0; c < 3; ++c) put(out, part.points(i, c));
    put_arrays(out, part, NamedArray::On::points, i);
  }
  if (part.kind == Part::Kind::triangles) put_faces(out, part);
  for (const auto& edge : edges) {
    for (const int end : edge) put(out, static_cast<std::int32_t>(end));
  }
  return out;
}

}  // namespace geoprior
