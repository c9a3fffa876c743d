#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace geoprior {

/// SHA-256 (FIPS 180-4, by OpenSSL) of data given piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void update(std::span<const std::byte> bytes);
  void update(std::string_view text);
  /// The digest of everything so far as 64 lower-case hex digits; nothing may follow.
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// 64 lower-case hex digits.
std::string sha256(std::string_view text);
std::string sha256(std::span<const std::byte> bytes);
/// Throws Error naming the file when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace geoprior
