#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/formats/vtk/vtk_file.h"

namespace geoprior {

/// File name extension of a part: ".vtp" (triangles, lines, points) or ".vti" (grid).
std::string part_extension(const Part& part);

/// Light: a third of the time, for files a twentieth larger.
enum class Compression { usual, light };

/// Bytes of the VTK XML file of a part: binary, zlib, Float64 points, a `TimeValue` field array
/// with the parameter, each array's unit and the names of its values (value_names.h). The same part
/// gives the same bytes.
std::string part_to_vtk_xml(const Part& part, double parameter,
                            Compression compression = Compression::usual);

/// Reads back what `part_to_vtk_xml` wrote (any valid .vtp or .vti), in this process: for frames
/// whose checksum was verified. @throws Error  naming the file
Part read_vtk_part(const std::filesystem::path& file, double* parameter = nullptr);

/// The same where the file need not have a TimeValue: `parameter` is then empty.
Part read_vtk_part(const std::filesystem::path& file, std::optional<double>& parameter);

/// The same of the bytes of a file. What the file declares is held against its size before it is
/// read, cells and arrays before VTK's filters see them (vtk_scan.h, vtk_checks.h).
/// @param extension  ".vtp" or ".vti"
/// @param where      what messages call the file
Part parse_vtk_part(const std::string& bytes, const std::string& extension,
                    const std::string& where, std::optional<double>& parameter);

/// As `parse_vtk_part`. Where there are polygons or strips they alone make the part: vertex cells
/// and lines, ghost cells (`vtkGhostType`: of another piece, refined or hidden) and cells at hidden
/// points are left out and noted.
VtkFile parse_vtk_file(const std::string& bytes, const std::string& extension,
                       const std::string& where);
/// The same as `parse_foreign_vtk_part` reads it.
VtkFile parse_foreign_vtk_file(const std::string& bytes, const std::string& extension,
                               const std::string& where);

/// Reads a .vtp or .vti of anybody, in a child process (isolated_read.h) that may take 1 GB and 64
/// times the file's size of memory, and a minute and a second for each 4 MB of the file.
/// `parameter` is empty where it has no TimeValue. What comes back is checked again.
/// @throws Error  naming the file, also for points that are not finite
Part read_foreign_vtk_part(const std::filesystem::path& file, std::optional<double>& parameter);

/// The same of the bytes of a file; arguments as those of `parse_vtk_part`.
Part parse_foreign_vtk_part(const std::string& bytes, const std::string& extension,
                            const std::string& where, std::optional<double>& parameter);

/// Text of a ParaView .pvd collection over (parameter, relative file, part name).
struct PvdEntry {
  double parameter;
  std::string file;
  std::string part;
};
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace geoprior
