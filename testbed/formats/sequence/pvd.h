#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace geoprior {

/// One line of a ParaView collection or file series.
struct PvdDataSet {
  double time = 0;
  std::string name;            ///< of the part, or empty
  std::filesystem::path file;  ///< beside the collection, or absolute
  int part = 0;                ///< its number
};

/// @throws Error  naming file and byte: no XML, no collection, no file name, no finite time
std::vector<PvdDataSet> read_pvd(const std::filesystem::path& file);
std::vector<PvdDataSet> parse_pvd(std::string_view text, const std::filesystem::path& file);

/// ParaView's JSON of numbered files, name.vtp.series: {"files": [{"name": …, "time": …}, …]}.
/// @throws Error  naming the file: no JSON, no list of files, an entry without name or time
std::vector<PvdDataSet> read_series(const std::filesystem::path& file);
std::vector<PvdDataSet> parse_series(std::string_view text, const std::filesystem::path& file);

}  // namespace geoprior
