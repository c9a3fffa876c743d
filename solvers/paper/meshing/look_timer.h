#pragma once

#include <algorithm>

#include "core/state_bytes.h"

namespace geoprior::paper {

/// When the structure of a sheet is looked at: every so many frames, and after a look in vain (its
/// change was taken back, or the sheet strains whatever was tried) not before twice the time, up to
/// eight times `frames`. What could not be changed now cannot be a frame later either.
class LookTimer {
 public:
  explicit LookTimer(int frames) : frames_(frames) {}

  void pass_frame() { ++since_; }
  [[nodiscard]] bool is_due() const { return since_ >= frames_ * stretch_; }
  /// Whether a sheet that strains is looked at before its time.
  [[nodiscard]] bool may_be_early() const { return stretch_ == 1; }
  /// Frames since the last look.
  [[nodiscard]] int since() const { return since_; }

  /// A look follows, in this frame.
  void looked() {
    since_ = 0;
    last_stretch_ = stretch_;
    stretch_ = 1;
  }
  /// That look was in vain.
  void in_vain() { stretch_ = std::min(2 * last_stretch_, kMostStretch); }

  /// The sheet is another one: it does not wait any longer than usual.
  void wake() { stretch_ = 1; }

  void save(StateWriter& out) const {
    out.number(since_);
    out.number(stretch_);
  }
  void load(StateReader& in) {
    since_ = in.number<int>();
    stretch_ = in.number<int>();
  }

 private:
  static constexpr int kMostStretch = 8;
  int frames_;
  int since_ = 0, stretch_ = 1, last_stretch_ = 1;
};

}  // namespace geoprior::paper
