#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace geoprior::test::structure {

/// A header or a source by its path from the root of the tree, "core/mesh.h".
struct SourceFile {
  std::string path;
  std::string text;
  std::vector<std::string> includes;  ///< those in quotes, as they are written
};

/// Headers and sources of a clone, or of a tree that a test planted. Generated ones lie elsewhere.
struct SourceTree {
  std::vector<SourceFile> files;                      ///< sorted by path
  std::set<std::string> headers;                      ///< paths of those that are headers
  std::map<std::string, std::set<std::string>> uses;  ///< topics: those that CMake says it USES
};

/// Reads the rooms below `root` and the topics of its CMakeLists.txt.
SourceTree read_source_tree(const std::filesystem::path& root);

/// Topics of the CMakeLists.txt of a tree, each with those that it USES.
std::map<std::string, std::set<std::string>> uses_of_topics(const std::filesystem::path& root);

/// "core/mesh" of core/mesh.h and core/mesh.cpp: a header and its source are one unit.
std::string unit_of(const std::string& path);

/// A path taken apart: {"experiments", "paper", "scene", "clip.h"}.
std::vector<std::string> path_parts(const std::string& path);

}  // namespace geoprior::test::structure
