#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace geoprior::test {

/// A good input of an option that names a file or folder: what lies beside the experiment and what
/// the experiment says.
struct NamedFile {
  /// Writes the input into a folder; `changed`: with another number in one of the files that are
  /// read, another result.
  std::function<void(const std::filesystem::path& folder, bool changed)> write;
  std::string scene;              ///< lines of [scene]
  std::vector<std::string> read;  ///< the files that a run records, relative to the folder
  std::string method;
  std::string options = {};  ///< of the method
  std::string refusal = {};  ///< how the changed input is refused; empty: it is run
};

/// By topic and key, as `geoprior describe` has it: "paper pattern.file".
const std::map<std::string, NamedFile>& named_files();

}  // namespace geoprior::test
