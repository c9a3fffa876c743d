#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace geoprior {

/// What the reading of one file may use.
struct ChildLimits {
  std::size_t memory = std::size_t{4} << 30;  ///< bytes on top of what this process has mapped
  double seconds = 60;                        ///< of the clock on the wall
  /// Asked ten times a second, and when a signal arrives: true kills the child.
  bool (*stop_requested)() = nullptr;
};

/// Runs `read` in a child process, for libraries that a damaged file can crash, and returns its
/// bytes. A crash, an endless loop or a huge allocation ends the child and is an Error here.
///
/// `read` sees a copy of this process with the calling thread alone: it must not wait for other
/// threads (TBB), nor use what is open through a descriptor (all but its own are closed); it opens
/// `file` itself. Files cannot be written, text on the standard streams is lost, destructors of
/// statics do not run. It may be called from several threads at once. It is no sandbox: it keeps
/// accidents away, not a file that takes over the child.
///
/// The cost is that of a fork (15 ms a GB of memory in use) and of a connection (2 ms a MB at
/// most).
///
/// @param file  what messages call the file
/// @throws Error  what `read` throws, in the same words; for any other end one that names `file`
///                and says whether it crashed, took too long or needed too much memory; when the
///                child dies of SIGINT, SIGTERM or SIGHUP or `stop_requested` says so, that reading
///                was stopped
std::vector<std::byte> read_in_child(const std::filesystem::path& file, const ChildLimits& limits,
                                     const std::function<std::vector<std::byte>()>& read);

/// Parses one file after another in a child process: what `read_in_child` does, but that the fork,
/// and what a library does at its first call, is paid once and not for every frame of a sequence
/// (a fork of 200 MB and VTK's first call: a quarter of a second).
///
/// A child that threw an error, ended or was late is not asked again: the next file has a new one,
/// so that what one file has damaged no other meets. Of one thread at a time.
class ParsingChild {
 public:
  /// Sees its request, and otherwise what this process was when the child began.
  using Parse = std::vector<std::byte> (*)(const std::vector<std::byte>& request);

  explicit ParsingChild(Parse how);
  ~ParsingChild();
  ParsingChild(const ParsingChild&) = delete;
  ParsingChild& operator=(const ParsingChild&) = delete;

  /// @param file     what messages call the file
  /// @param request  bytes that `Parse` is called with, in the child
  /// @throws Error   as `read_in_child`
  std::vector<std::byte> parse(const std::filesystem::path& file, const ChildLimits& limits,
                               const std::vector<std::byte>& request);

 private:
  struct Running;
  void start(const std::filesystem::path& file);
  void leave_to_parent();

  Parse parse_;
  std::unique_ptr<Running> running_;
};

}  // namespace geoprior
