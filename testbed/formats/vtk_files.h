#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"

namespace geoprior {

/// File name extension of a part: ".vtp" (triangles, lines, points) or ".vti" (grid).
std::string part_extension(const Part& part);

/// Bytes of the VTK XML file of a part: binary, zlib, Float64 points, a `TimeValue` field array
/// with the parameter and each array's unit. The same part gives the same bytes.
std::string part_to_vtk_xml(const Part& part, double parameter);

/// Reads back what `part_to_vtk_xml` wrote (any valid .vtp or .vti); throws Error naming the file.
Part read_vtk_part(const std::filesystem::path& file, double* parameter = nullptr);

/// Reads a .vtp or .vti of another program, which need not have a TimeValue: `parameter` is then
/// empty.
Part read_vtk_part(const std::filesystem::path& file, std::optional<double>& parameter);

/// Text of a ParaView .pvd collection over (parameter, relative file, part name).
struct PvdEntry {
  double parameter;
  std::string file;
  std::string part;
};
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace geoprior
