#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/mesh.h"
#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// Names of what a frame of a day holds: the one place where writer and measures meet.
namespace recorded {
inline const std::string kSurface = "surface";          ///< triangles of all structures
inline const std::string kCentrelines = "centrelines";  ///< lines, one a duct
inline const std::string kLandmarks = "landmarks";      ///< points
inline const std::string kStructure = "structure";      ///< array: code of a structure
inline const std::string kKind = "kind";                ///< array: code of what it is
inline const std::string kRadius = "radius";            ///< array of centrelines, m
inline const std::string kShapes = "structures";        ///< table: one row a structure
inline const std::string kProcesses = "processes";      ///< table: one row a process
inline const std::string kBody = "body";                ///< table: crown-rump length
inline const std::string kAnswers = "answers";          ///< table: rows of queries
}  // namespace recorded

/// A structure as the table of a frame has it; its centre line, where it has one, is a part.
struct RecordedShape {
  int structure = 0;
  Shape shape;
};

/// A connected piece of a frame's surface.
struct RecordedPiece {
  TriMesh mesh;
  std::vector<int> structure_of_triangle;
  std::vector<int> structures;  ///< those that it has triangles of, ascending
};

/// Rows of the table of structures, ascending by structure; empty where a frame has no such table.
std::vector<RecordedShape> recorded_shapes(const Frame& frame);

/// Null where there is none of that code.
const RecordedShape* find_shape(const std::vector<RecordedShape>& shapes, int structure);

/// Pieces of the surface by their first triangles; empty where a frame has no surface.
std::vector<RecordedPiece> recorded_pieces(const Frame& frame);

/// Triangles of each structure that has some, with the vertices that they use in the order of the
/// part's.
std::map<int, TriMesh> recorded_surfaces(const Frame& frame);

/// (m) @throws Error  where a frame has no table of the body
double crown_rump_length(const Frame& frame);

/// What a frame of a day has, cut up once for all that is read off it.
struct RecordedDay {
  explicit RecordedDay(const Frame& frame)
      : body(crown_rump_length(frame)),
        shapes(recorded_shapes(frame)),
        surfaces(recorded_surfaces(frame)) {}

  double body;  ///< crown-rump length (m)
  std::vector<RecordedShape> shapes;
  std::map<int, TriMesh> surfaces;
};

}  // namespace geoprior::embryo
