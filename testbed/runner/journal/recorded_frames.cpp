#include "testbed/runner/journal/recorded_frames.h"

#include <algorithm>
#include <numeric>

namespace geoprior {

namespace {

template <class Matrix>
std::size_t bytes_of(const Matrix& m) {
  return static_cast<std::size_t>(m.size()) * sizeof(typename Matrix::Scalar);
}

}  // namespace

std::size_t memory_of(const Frame& frame) {
  std::size_t bytes = 0;
  for (const auto& [name, part] : frame.parts) {
    bytes += bytes_of(part.points) + bytes_of(part.triangles);
    for (const std::vector<int>& line : part.lines) bytes += line.size() * sizeof(int);
    for (const NamedArray& array : part.arrays) bytes += bytes_of(array.values);
  }
  for (const auto& [name, table] : frame.tables) bytes += bytes_of(table.rows);
  return bytes;
}

void KeptFrames::keep(std::size_t index, Frame frame) {
  const std::size_t bytes = memory_of(frame);
  if (bytes_ + bytes > most_bytes_) return;
  const bool is_new =
      frames_.emplace(index, std::make_shared<const Frame>(std::move(frame))).second;
  if (is_new) bytes_ += bytes;
}

std::shared_ptr<const Frame> KeptFrames::find(std::size_t index) const {
  const auto found = frames_.find(index);
  return found == frames_.end() ? nullptr : found->second;
}

RecordedFrames::RecordedFrames(const FrameFiles& files, const VariantRecord& variant,
                               const KeptFrames& kept, const FrameSequence* reference)
    : files_(files),
      variant_(variant),
      kept_(kept),
      reference_(reference),
      order_(variant.frames.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return variant_.frames[a].parameter < variant_.frames[b].parameter;
  });
}

double RecordedFrames::parameter(std::size_t i) const {
  return variant_.frames[order_.at(i)].parameter;
}

std::shared_ptr<const Frame> RecordedFrames::in_memory(std::size_t index) const {
  if (auto kept = kept_.find(index)) return kept;
  for (const auto& [known, frame] : read_) {
    if (known == index) return frame;
  }
  return nullptr;
}

std::shared_ptr<const Frame> RecordedFrames::frame(std::size_t i) const {
  const std::size_t index = order_.at(i);
  if (auto there = in_memory(index)) return there;
  // Makes room first, so that never more than `kRemembered` are there.
  if (read_.size() == kRemembered) read_.pop_front();
  auto frame = std::make_shared<const Frame>(files_.frame(variant_, index));
  ++frames_read_;
  read_.emplace_back(index, frame);
  return frame;
}

std::shared_ptr<const Part> RecordedFrames::part(std::size_t i, const std::string& name) const {
  const std::size_t index = order_.at(i);
  if (const auto there = in_memory(index)) return part_of(there, name);
  Frame only = files_.frame(variant_, index, {{name}});
  const auto found = only.parts.find(name);
  if (found == only.parts.end()) return nullptr;
  return std::make_shared<const Part>(std::move(found->second));
}

}  // namespace geoprior
