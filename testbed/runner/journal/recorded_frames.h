#pragma once

#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "testbed/frame_sequence.h"
#include "testbed/runner/journal/frame_files.h"

namespace geoprior {

/// Bytes that the numbers of a frame take in memory.
std::size_t memory_of(const Frame& frame);

/// Bytes of a variant's frames that are kept in memory for the metrics of the sequence; the others
/// are read back.
inline constexpr std::size_t kMostKept = std::size_t{256} << 20;

/// Frames that need not be read back because they fitted into memory as they came.
class KeptFrames {
 public:
  explicit KeptFrames(std::size_t most_bytes) : most_bytes_(most_bytes) {}
  /// Keeps the frame unless all kept ones would then be larger than `most_bytes`.
  void keep(std::size_t index, Frame frame);
  /// Null when it was not kept.
  [[nodiscard]] std::shared_ptr<const Frame> find(std::size_t index) const;
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::map<std::size_t, std::shared_ptr<const Frame>> frames_;
};

/// What was recorded of a variant. Its frames are kept ones, the last few that were read, or read
/// anew. Its memory is that of the kept frames and of `kRemembered` others.
class RecordedFrames final : public FrameSequence {
 public:
  static constexpr std::size_t kRemembered = 3;

  /// The arguments must outlive this.
  RecordedFrames(const FrameFiles& files, const VariantRecord& variant, const KeptFrames& kept,
                 const FrameSequence* reference = nullptr);

  [[nodiscard]] std::size_t size() const override { return order_.size(); }
  [[nodiscard]] double parameter(std::size_t i) const override;
  /// @throws Error  naming a file that is missing or damaged
  [[nodiscard]] std::shared_ptr<const Frame> frame(std::size_t i) const override;
  [[nodiscard]] std::shared_ptr<const Part> part(std::size_t i,
                                                 const std::string& name) const override;
  [[nodiscard]] const std::vector<Event>& events() const override { return variant_.events; }
  [[nodiscard]] std::optional<std::vector<std::byte>> artifact(
      const std::string& name) const override {
    return files_.artifact(variant_, name);
  }
  [[nodiscard]] const FrameSequence* reference() const override { return reference_; }
  /// Frames that were read from the disk so far.
  [[nodiscard]] std::size_t frames_read() const { return frames_read_; }

 private:
  [[nodiscard]] std::shared_ptr<const Frame> in_memory(std::size_t index) const;

  const FrameFiles& files_;
  const VariantRecord& variant_;
  const KeptFrames& kept_;
  const FrameSequence* reference_;
  std::vector<std::size_t> order_;  ///< index of the frame of the i-th smallest parameter
  mutable std::deque<std::pair<std::size_t, std::shared_ptr<const Frame>>> read_;
  mutable std::size_t frames_read_ = 0;
};

}  // namespace geoprior
