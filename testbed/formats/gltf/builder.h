#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior::gltf {

/// A binary glTF 2.0 under construction: the binary chunk and the JSON that describes it, grown
/// together.
class GlbBuilder {
 public:
  GlbBuilder();

  /// Appends an accessor of its own buffer view; returns its index.
  /// @param type     "SCALAR", "VEC3", "VEC4"
  /// @param columns  numbers of an element
  /// @param target   what the buffer view is for; 0: not said
  int add(const std::vector<float>& values, const char* type, int columns, int target = 0);
  int add(const std::vector<std::uint32_t>& values, const char* type, int columns, int target = 0);

  /// Positions, their differences or normals; with the bounds that glTF wants.
  int add_vectors(const Eigen::MatrixX3d& V);

  /// Keys of an animation; with their bounds.
  int add_times(const std::vector<double>& times_s);

  /// A primitive of positions, shifted so that `origin` is zero, and indices.
  nlohmann::json primitive(const TriMesh& mesh,
                           const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

  nlohmann::json& document() { return document_; }

  /// The bytes of the file.
  /// @throws Error  naming `file`: over 4 GB
  [[nodiscard]] std::string glb(const std::string& file);

 private:
  int add_bytes(const void* values, std::size_t size, std::size_t count, const char* type,
                int component, int target);

  nlohmann::json document_;
  std::string bytes_;
};

/// Times are compared in single precision, in which they are stored.
/// @throws Error  naming `where` and the frame: not finite, below zero, not increasing
void require_times(const std::vector<double>& times_s, const std::string& where);

}  // namespace geoprior::gltf
