#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// Reads back what a run recorded of its variants. Every file is what was recorded, by its SHA-256;
/// none is reached through a symbolic link below the folder.
class FrameFiles {
 public:
  /// @param left_out  parts that frames are read without
  explicit FrameFiles(std::filesystem::path run_folder, std::set<std::string> left_out = {})
      : folder_(std::move(run_folder)), left_out_(std::move(left_out)) {}

  /// A frame, equal, bit by bit, to the one that was recorded, but for what is left out.
  /// @param parts  only these of its parts and tables; absent: all. Those it has not are left out
  /// @throws Error  naming a file that is missing or damaged
  [[nodiscard]] Frame frame(const VariantRecord& variant, std::size_t index,
                            const std::optional<std::set<std::string>>& parts = std::nullopt) const;
  /// Bytes of the variant's artifact of that name; absent when it has none.
  /// @throws Error  when its file is missing, or not what was recorded
  [[nodiscard]] std::optional<std::vector<std::byte>> artifact(const VariantRecord& variant,
                                                               const std::string& name) const;
  /// Bytes of any recorded file. @throws Error  as the others
  [[nodiscard]] std::vector<std::byte> bytes(const StoredFile& stored) const;

  [[nodiscard]] bool leaves_out(const std::string& part) const { return left_out_.contains(part); }

 private:
  std::filesystem::path folder_;
  std::set<std::string> left_out_;
};

/// "surface" of "surface_0012.vtp": the part that a file of a frame holds.
/// @throws Error  for another name
std::string part_of_file(const std::filesystem::path& file);

/// "surface_0012" of part "surface", frame 12.
std::string stem_of_part(const std::string& part, std::size_t frame);

}  // namespace geoprior
