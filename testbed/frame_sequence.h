#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/frame.h"

namespace geoprior {

/// What was recorded of one variant, as the metrics of a sequence see it: its frames in order of
/// parameter, its events and artifacts.
///
/// A long simulation does not fit in memory: what is not there is read from the run's files when it
/// is asked for, so a metric goes once through the sequence and holds what it needs of a few frames
/// at a time. What it holds stays valid. Not to be used by several threads at once.
class FrameSequence {
 public:
  virtual ~FrameSequence() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual double parameter(std::size_t i) const = 0;
  /// The frame, never null; the last few that were asked for are remembered.
  [[nodiscard]] virtual std::shared_ptr<const Frame> frame(std::size_t i) const = 0;
  /// One part of a frame, null when it has none of that name: of a frame that is not in memory only
  /// this file is read, and it is not remembered.
  [[nodiscard]] virtual std::shared_ptr<const Part> part(std::size_t i,
                                                         const std::string& name) const = 0;
  /// The variant's events, in the order in which they were recorded.
  [[nodiscard]] virtual const std::vector<Event>& events() const = 0;
  /// The bytes of the variant's artifact of that name, as it was recorded; absent when it has none.
  /// Of a run on the disk the file is read anew at each call.
  /// @throws Error  when its file is missing, or not what was recorded
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> artifact(
      const std::string& name) const = 0;

  /// What was recorded of the variant that the experiment names as reference; null when there is
  /// none, or it was left out.
  [[nodiscard]] virtual const FrameSequence* reference() const { return nullptr; }

  /// The same. @throws Error  when the frame has none of that name
  [[nodiscard]] std::shared_ptr<const Part> require_part(std::size_t i,
                                                         const std::string& name) const {
    if (auto found = part(i, name)) return found;
    const std::shared_ptr<const Frame> whole = frame(i);
    return {whole, &whole->require_part(name)};
  }

  [[nodiscard]] std::vector<double> parameters() const {
    std::vector<double> all;
    for (std::size_t i = 0; i < size(); ++i) all.push_back(parameter(i));
    return all;
  }
};

/// The part of a frame that lives as long as the frame; null when there is none of that name.
inline std::shared_ptr<const Part> part_of(const std::shared_ptr<const Frame>& frame,
                                           const std::string& name) {
  const Part* part = frame->find_part(name);
  if (part == nullptr) return nullptr;
  return {frame, part};
}

/// A sequence that is all in memory, its frames sorted by parameter already.
class FramesInMemory final : public FrameSequence {
 public:
  explicit FramesInMemory(const std::vector<Frame>& frames, std::vector<Event> events = {},
                          std::vector<Artifact> artifacts = {},
                          const FrameSequence* reference = nullptr)
      : events_(std::move(events)), artifacts_(std::move(artifacts)), reference_(reference) {
    for (const Frame& frame : frames) frames_.push_back(std::make_shared<const Frame>(frame));
  }
  [[nodiscard]] std::size_t size() const override { return frames_.size(); }
  [[nodiscard]] double parameter(std::size_t i) const override { return frames_.at(i)->parameter; }
  [[nodiscard]] std::shared_ptr<const Frame> frame(std::size_t i) const override {
    return frames_.at(i);
  }
  [[nodiscard]] std::shared_ptr<const Part> part(std::size_t i,
                                                 const std::string& name) const override {
    return part_of(frames_.at(i), name);
  }
  [[nodiscard]] const std::vector<Event>& events() const override { return events_; }
  [[nodiscard]] std::optional<std::vector<std::byte>> artifact(
      const std::string& name) const override {
    const auto found = std::find_if(artifacts_.begin(), artifacts_.end(),
                                    [&](const Artifact& one) { return one.name == name; });
    if (found == artifacts_.end()) return std::nullopt;
    return found->bytes;
  }
  [[nodiscard]] const FrameSequence* reference() const override { return reference_; }

 private:
  std::vector<std::shared_ptr<const Frame>> frames_;
  std::vector<Event> events_;
  std::vector<Artifact> artifacts_;
  const FrameSequence* reference_;
};

}  // namespace geoprior
