#pragma once

#include <map>
#include <string>

namespace geoprior {

/// What this program was built from and with; the commit is read at build time, not at configure
/// time.
struct BuildInfo {
  std::string version;         ///< of the program, "0.1.0"
  std::string git_commit;      ///< 40 hex digits, or "unknown" outside a clone
  std::string git_difference;  ///< sha256 of how the sources differed from the commit; empty: not
  std::string compiler;        ///< "GNU 12.2.0"
  std::string build_type;      ///< "Release"
  std::string flags;
  std::string instruction_set;                   ///< GEOPRIOR_ARCH
  std::map<std::string, std::string> libraries;  ///< name to version

  [[nodiscard]] bool git_dirty() const { return !git_difference.empty(); }
};

const BuildInfo& build_info();

/// "geoprior 0.1.0 (commit 0123456789ab, modified), GNU 12.2.0, Release, x86-64-v3"
std::string version_line();

}  // namespace geoprior
