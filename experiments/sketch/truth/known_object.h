#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Products that are known in closed form, of the kinds that the thesis shows in Figure 2.13.
enum class KnownShape {
  bag,      ///< two flat faces, a bent gusset between them, a flap and a handle
  tent,     ///< a tunnel: conical porch, cylindrical middle, conical tail, flat ends
  helmet,   ///< a kettle hat: brim, brow band and two conical bands of sheet metal, with a comb
  frustum,  ///< of a cone, open at both ends: a lampshade
};

/// A border curve in space.
struct KnownBorder {
  std::string id;
  std::string panels;  ///< that it belongs to, as a drawing names them ("front + gusset")
  bool closed = false;
  std::vector<Eigen::Vector3d> points;  ///< at even distances (m)
};

/// A developable panel.
struct KnownPanel {
  std::string name;
  bool flat = false;                   ///< `first` is its convex outline, `second` empty
  std::vector<Eigen::Vector3d> first;  ///< ends of its rulings, in order; a band repeats the first
  std::vector<Eigen::Vector3d> second;
};

/// A point that a user can tell from its mirror image.
struct KnownPair {
  std::string id;
  std::string panels;  ///< of the border that it lies on
  Eigen::Vector3d point{0, 0, 0};
};

/// An object that stands on the plane y = 0 or about it, symmetric in x = 0, its front towards +z.
struct KnownObject {
  std::vector<KnownBorder> borders;
  std::vector<KnownPanel> panels;
  std::vector<KnownPair> pairs;        ///< those that are drawn; x = 0: a point of the mirror plane
  Eigen::Vector3d vectors{0, 0, 0};    ///< point of the mirror plane where its two vectors start
  Eigen::Vector2d vector_sizes{1, 1};  ///< of the upright one and of the one towards +z (m)
  double height = 1;                   ///< m
  double yaw_deg = 35;                 ///< under which it is seen: turned about y,
  double pitch_deg = 25;               ///< with the eye above the horizon
  double drawing_scale = 1;            ///< size in the world over that on the page
};

/// @return  sizes in metres
KnownObject known_object(KnownShape shape);

/// Triangles of a panel: between neighbouring rulings, or a fan about the centre of an outline.
TriMesh panel_mesh(const KnownPanel& panel);

}  // namespace geoprior::sketch
