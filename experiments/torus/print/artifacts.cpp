#include "experiments/torus/print/artifacts.h"

#include <numbers>

#include "experiments/torus/print/solid.h"
#include "testbed/formats/artifact.h"
#include "testbed/formats/gltf/writer.h"
#include "testbed/formats/vtk/files.h"

namespace geoprior::torus {
namespace {

TriMesh body_of(const TorusInput& input, const Part& part, double thickness) {
  const TriMesh surface{part.points, part.triangles};
  if (input.sampling.view) return body_between(surface, flat_plate(surface, thickness));
  if (thickness == 0) return surface;
  const auto& at = part.require_array("parameters", NamedArray::On::points, 2).values;
  const double ring = input.radii.ring / (2 * std::numbers::pi);
  return body_between(surface, round_cavity(surface, at, ring, thickness));
}

}  // namespace

std::vector<Artifact> artifacts_of(const TorusInput& input,
                                   const std::optional<PrintedBody>& printed, Frame& frame) {
  std::vector<Artifact> files;
  if (const Part* grid = frame.find_part("grid")) {
    files.push_back(artifact_of("grid.vti", part_to_vtk_xml(*grid, frame.parameter)));
    frame.parts.erase("grid");
  }
  if (!printed) return files;
  const Part& part = frame.require_part("surface");
  const TriMesh surface{part.points, part.triangles};
  const double factor = printed->size / extent(surface);
  const TriMesh body = scaled(body_of(input, part, printed->thickness / factor), factor);
  files.push_back(artifact_of("surface.stl", stl_bytes(body)));
  files.push_back(artifact_of("surface.glb", surface_glb(scaled(surface, factor), "torus")));
  Part& print = frame.parts["print"];
  print.points = body.V;
  print.triangles = body.F;
  return files;
}

}  // namespace geoprior::torus
