#include "core/geometry/solid_remesh.h"

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <vector>

#include "core/geometry/solid_data.h"

namespace geoprior {

void remesh(Solid& solid, double edge_length, double crease_deg, int passes) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  auto& mesh = solid.data().mesh;
  using Edge = decltype(SolidData::mesh)::Edge_index;
  auto crease = mesh.add_property_map<Edge, bool>("e:crease", false).first;
  pmp::detect_sharp_edges(mesh, crease_deg, crease);
  std::vector<Edge> kept;
  for (const Edge e : mesh.edges()) {
    if (crease[e]) kept.push_back(e);
  }
  pmp::split_long_edges(kept, edge_length, mesh, pmp::parameters::edge_is_constrained_map(crease));
  pmp::isotropic_remeshing(mesh.faces(), edge_length, mesh,
                           pmp::parameters::number_of_iterations(static_cast<unsigned>(passes))
                               .edge_is_constrained_map(crease)
                               .protect_constraints(false));
  mesh.collect_garbage();
}

}  // namespace geoprior
