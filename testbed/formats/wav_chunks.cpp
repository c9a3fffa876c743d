#include "testbed/formats/wav_chunks.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr std::size_t kRiffHead = 12, kChunkHead = 8;

/// Of 32 bits: the size is elsewhere, or nobody knew it.
constexpr std::uint64_t kNoSize = std::numeric_limits<std::uint32_t>::max();

/// SoX says 2^31 - 2^12 and arecord 2^31 of what goes to a pipe.
constexpr std::uint64_t kLeastPipeSize = 0x7ffff000;

struct WavChunk {
  std::size_t at = 0;      ///< of its content
  std::uint64_t size = 0;  ///< as it says
};

class WavChunks {
 public:
  WavChunks(std::span<const std::byte> bytes, const std::string& name,
            std::vector<std::string>& notes)
      : bytes_(bytes), name_(name), notes_(notes) {
    if (bytes.empty()) throw Error("is empty", name, kAllowedWav);
    const bool known = bytes.size() >= kRiffHead && has_word(8, "WAVE");
    big_ = known && has_word(0, "RIFX");
    if (!big_ && !(known && (has_word(0, "RIFF") || has_word(0, "RF64") || has_word(0, "BW64"))))
      throw Error("is no WAV file", name, kAllowedWav);
    find_chunks();
  }

  [[nodiscard]] std::vector<std::byte> plain() const {
    if (!data_) throw Error("is cut short: it has no samples", name_);
    if (!format_) throw Error("says nothing of its samples: it has no chunk 'fmt '", name_);
    constexpr std::uint64_t kMostBytes = kNoSize - 1024;
    if (data_->size > kMostBytes) throw Error("has more samples than are read", name_, "4 GB");
    std::vector<std::byte> out;
    out.reserve(kRiffHead + 2 * kChunkHead + format_->size + data_->size);
    add_word(out, big_ ? "RIFX" : "RIFF");
    add_number(out, 4 + 2 * kChunkHead + format_->size + data_->size);
    add_word(out, "WAVE");
    add_chunk(out, "fmt ", *format_);
    add_chunk(out, "data", *data_);
    return out;
  }

 private:
  [[nodiscard]] bool has_word(std::size_t at, const char* word) const {
    return std::memcmp(bytes_.data() + at, word, 4) == 0;
  }

  [[nodiscard]] std::uint64_t number(std::size_t at, int count) const {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i)
      value = value << 8 | std::to_integer<std::uint64_t>(bytes_[at + (big_ ? i : count - 1 - i)]);
    return value;
  }

  /// Four letters that a chunk may be called, and its size.
  [[nodiscard]] bool may_be_chunk(std::size_t at) const {
    if (at > bytes_.size() || bytes_.size() - at < kChunkHead) return false;
    return std::all_of(bytes_.begin() + at, bytes_.begin() + at + 4, [](std::byte b) {
      const int c = std::to_integer<int>(b);
      return c >= 0x20 && c < 0x7f;
    });
  }

  /// Behind a chunk's content: chunks are padded to even sizes, by most programs.
  [[nodiscard]] std::size_t behind(const WavChunk& chunk) const {
    const std::uint64_t there = bytes_.size() - chunk.at;
    if (chunk.size >= there) return bytes_.size();
    const std::size_t end = chunk.at + static_cast<std::size_t>(chunk.size);
    const bool padded = chunk.size % 2 == 1 && (bytes_[end] == std::byte{0} || !may_be_chunk(end));
    return std::min(end + (padded ? 1 : 0), bytes_.size());
  }

  void find_chunks() {
    for (std::size_t at = kRiffHead; at < bytes_.size() && bytes_.size() - at >= kChunkHead;) {
      WavChunk chunk{at + kChunkHead, number(at + 4, 4)};
      const bool is_data = has_word(at, "data");
      if (is_data) measure_data(chunk);
      const std::uint64_t there = bytes_.size() - chunk.at;
      const bool needed = is_data || has_word(at, "fmt ") || !data_;
      if (chunk.size > there && needed) {
        throw Error("is cut short: " + std::to_string(chunk.size - there) + " bytes are missing",
                    name_);
      }
      if (is_data && !data_) data_ = chunk;
      if (has_word(at, "fmt ") && !format_) format_ = chunk;
      if (has_word(at, "ds64") && chunk.size >= 16) long_size_ = number(chunk.at + 8, 8);
      if (data_ && format_) return;
      at = behind(chunk);
    }
  }

  /// Corrects the size of the samples where the head does not know it.
  void measure_data(WavChunk& chunk) {
    const std::uint64_t there = bytes_.size() - chunk.at;
    if (chunk.size == kNoSize && long_size_) chunk.size = *long_size_;
    constexpr std::uint64_t kNoLongSize = std::numeric_limits<std::uint64_t>::max();
    const bool unknown = chunk.size == 0 ? there > 0 && !chunks_follow(chunk.at)
                                         : chunk.size > there && chunk.size >= kLeastPipeSize &&
                                               (!long_size_ || *long_size_ == kNoLongSize);
    if (!unknown) return;
    notes_.push_back(name_ + ": its head does not say how long it is, as of a sound that was " +
                     "written to a pipe: read to the end of the file, " + std::to_string(there) +
                     " bytes of samples");
    chunk.size = there;
  }

  /// Whether nothing but whole chunks stand from there to the end.
  [[nodiscard]] bool chunks_follow(std::size_t at) const {
    while (may_be_chunk(at)) {
      const WavChunk chunk{at + kChunkHead, number(at + 4, 4)};
      if (chunk.size > bytes_.size() - chunk.at) return false;
      at = behind(chunk);
    }
    return at == bytes_.size();
  }

  static void add_word(std::vector<std::byte>& out, std::string_view word) {
    for (const char c : word) out.push_back(static_cast<std::byte>(c));
  }

  void add_number(std::vector<std::byte>& out, std::uint64_t value) const {
    for (int i = 0; i < 4; ++i)
      out.push_back(static_cast<std::byte>(value >> 8 * (big_ ? 3 - i : i) & 0xff));
  }

  void add_chunk(std::vector<std::byte>& out, std::string_view word, const WavChunk& chunk) const {
    add_word(out, word);
    add_number(out, chunk.size);
    const auto from = bytes_.begin() + chunk.at;
    out.insert(out.end(), from, from + chunk.size);
    if (chunk.size % 2 == 1) out.push_back(std::byte{0});
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::vector<std::string>& notes_;
  bool big_ = false;
  std::optional<WavChunk> format_, data_;
  std::optional<std::uint64_t> long_size_;
};

}  // namespace

std::vector<std::byte> plain_wav(std::span<const std::byte> bytes, const std::string& name,
                                 std::vector<std::string>& notes) {
  return WavChunks(bytes, name, notes).plain();
}

}  // namespace geoprior
