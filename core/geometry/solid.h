#pragma once

#include <memory>
#include <optional>

#include "core/mesh.h"

namespace geoprior {

struct SolidData;  // solid_data.h: brings CGAL

/// A surface of triangles in the form that exact Booleans take.
///
/// Predicates are exact, constructed points are rounded: a result may cut itself by round-off, and
/// may have slivers (`remesh`, solid_remesh.h). The same solids give the same bits.
/// Source: CGAL 5.5, Polygon Mesh Processing (corefinement).
class Solid {
 public:
  /// Vertices and triangles in the mesh's order; nothing when a triangle does not fit beside those
  /// before it (an edge of three, two fans about a vertex, another orientation).
  static std::optional<Solid> of(const TriMesh& mesh);
  explicit Solid(std::unique_ptr<SolidData> data);
  Solid(Solid&& other) noexcept;
  Solid& operator=(Solid&& other) noexcept;
  ~Solid();

  /// Whether the surface is closed, cuts itself nowhere and has its inside on the inner side.
  [[nodiscard]] bool bounds_volume() const;
  [[nodiscard]] bool empty() const;
  [[nodiscard]] double area() const;
  [[nodiscard]] TriMesh mesh() const;
  [[nodiscard]] SolidData& data() { return *data_; }

 private:
  std::unique_ptr<SolidData> data_;
};

/// What is in one of two solids, or in both; nothing where that is no manifold. Both must bound
/// volumes.
std::optional<Solid> united(Solid a, Solid b);
std::optional<Solid> common(Solid a, Solid b);

}  // namespace geoprior
