// Good WAV files with what the format allows drawn at random: kind of samples, channels, byte
// order, 64-bit sizes, other chunks, their order and padding, and the heads that pipes leave. What
// is right is computed from the numbers that were stored.
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/random.h"
#include "testbed/formats/wav_file.h"
#include "tests/support/perturbed.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using Bytes = std::vector<std::byte>;

class PerturbedWav {
 public:
  explicit PerturbedWav(int seed) : random_(static_cast<std::uint64_t>(seed), "perturbed WAV") {
    channels_ = 1 + below(4);
    rate_ = pick({8000, 22050, 44100, 48000, 96000, 192000});
    kind_ = below(5);
    container_ = below(4);
    extensible_ = below(3) == 0;
    frames_ = 1 + below(60);
    make();
  }

  [[nodiscard]] const Bytes& bytes() const { return bytes_; }
  [[nodiscard]] const Eigen::MatrixXd& samples() const { return samples_; }
  [[nodiscard]] int rate() const { return rate_; }
  [[nodiscard]] bool from_pipe() const { return from_pipe_; }
  [[nodiscard]] std::string text() const {
    return std::to_string(bits()) + " bits, container " + std::to_string(container_) +
           (extensible_ ? ", extensible" : "") + (from_pipe_ ? ", pipe" : "");
  }

 private:
  int below(int n) { return static_cast<int>(random_.below(static_cast<std::uint32_t>(n))); }
  int pick(const std::vector<int>& of) { return of[below(static_cast<int>(of.size()))]; }
  [[nodiscard]] bool big() const { return container_ == 1; }
  [[nodiscard]] bool long_sizes() const { return container_ == 2; }
  [[nodiscard]] int bits() const { return std::vector<int>{16, 24, 32, 32, 64}[kind_]; }
  [[nodiscard]] bool floating() const { return kind_ > 2; }

  void add(Bytes& to, std::uint64_t value, int count) const {
    for (int i = 0; i < count; ++i)
      to.push_back(static_cast<std::byte>(value >> 8 * (big() ? count - 1 - i : i) & 0xff));
  }
  static void add(Bytes& to, const std::string& word) {
    for (const char c : word) to.push_back(static_cast<std::byte>(c));
  }

  Bytes stored() {
    Bytes data;
    samples_.resize(frames_, channels_);
    for (int i = 0; i < frames_; ++i) {
      for (int c = 0; c < channels_; ++c) {
        const double x = 2 * random_.uniform() - 1;
        if (!floating()) {
          const auto n = static_cast<std::int64_t>(std::floor(std::ldexp(x, bits() - 1)));
          samples_(i, c) = std::ldexp(static_cast<double>(n), 1 - bits());
          add(data, static_cast<std::uint64_t>(n), bits() / 8);
        } else if (bits() == 32) {
          const auto f = static_cast<float>(1.5 * x);
          samples_(i, c) = static_cast<double>(f);
          add(data, std::bit_cast<std::uint32_t>(f), 4);
        } else {
          samples_(i, c) = 1.5 * x;
          add(data, std::bit_cast<std::uint64_t>(1.5 * x), 8);
        }
      }
    }
    return data;
  }

  [[nodiscard]] Bytes format() const {
    const int frame = channels_ * bits() / 8, tag = floating() ? 3 : 1;
    Bytes format;
    add(format, extensible_ ? 0xfffe : static_cast<std::uint64_t>(tag), 2);
    add(format, channels_, 2);
    add(format, rate_, 4);
    add(format, static_cast<std::uint64_t>(rate_) * frame, 4);
    add(format, frame, 2);
    add(format, bits(), 2);
    if (extensible_) {
      add(format, 22, 2);
      add(format, bits(), 2);
      add(format, 0, 4);
      add(format, tag, 4);
      add(format, 0, 2);
      add(format, 0x10, 2);
      for (const int b : {0x80, 0x00, 0x00, 0xaa, 0x00, 0x38, 0x9b, 0x71})
        format.push_back(static_cast<std::byte>(b));
    }
    return format;
  }

  void add_chunk(const std::string& word, const Bytes& content, std::uint64_t said, bool padded) {
    add(bytes_, word);
    add(bytes_, said, 4);
    bytes_.insert(bytes_.end(), content.begin(), content.end());
    if (padded && content.size() % 2 == 1) bytes_.push_back(std::byte{0});
  }

  void add_others(bool padded) {
    for (int n = below(3); n > 0; --n) {
      Bytes content(static_cast<std::size_t>(below(40)));
      for (std::byte& b : content) b = static_cast<std::byte>(below(256));
      const char* const words[] = {"LIST", "bext", "cue ", "junk", "iXML", "fact"};
      add_chunk(words[below(6)], content, content.size(), padded);
    }
  }

  void make() {
    const Bytes data = stored();
    const bool padded = below(4) != 0;
    from_pipe_ = below(4) == 0;
    add(bytes_, big() ? "RIFX" : long_sizes() ? "RF64" : "RIFF");
    add(bytes_, from_pipe_ || long_sizes() ? 0xffffffff : 0, 4);
    add(bytes_, "WAVE");
    if (long_sizes()) {
      Bytes sizes;
      add(sizes, 0, 8);
      add(sizes, from_pipe_ ? 0 : data.size(), 8);
      add(sizes, frames_, 8);
      add(sizes, 0, 4);
      add_chunk("ds64", sizes, sizes.size(), true);
    }
    const bool data_first = !from_pipe_ && below(5) == 0;
    const std::uint64_t said = long_sizes() ? 0xffffffff : data.size();
    add_others(padded);
    if (data_first) add_chunk("data", data, said, padded);
    add_chunk("fmt ", format(), format().size(), true);
    add_others(padded);
    const std::vector<std::uint64_t> unknown{0, 0xffffffff, 0x7ffff000, 0x80000000};
    if (from_pipe_) {
      add_chunk("data", data, long_sizes() ? 0xffffffff : unknown[below(4)], false);
    } else if (!data_first) {
      add_chunk("data", data, said, padded);
      add_others(padded);
    }
  }

  RandomStream random_;
  int channels_ = 1, rate_ = 48000, kind_ = 0, container_ = 0, frames_ = 1;
  bool extensible_ = false, from_pipe_ = false;
  Eigen::MatrixXd samples_;
  Bytes bytes_;
};

TEST(LongPerturbedWavs, HaveTheSamplesThatWereStored) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    const PerturbedWav file(seed);
    std::vector<std::string> notes;
    const std::string name = "seed " + std::to_string(seed) + ", " + file.text();
    Sound sound;
    ASSERT_NO_THROW(sound = wav_from_bytes(file.bytes(), name, notes)) << name;
    EXPECT_EQ(sound.sample_rate, file.rate()) << name;
    EXPECT_EQ(sound.samples, file.samples()) << name;
    EXPECT_EQ(notes.size(), file.from_pipe() ? 1U : 0U) << name;
  }
}

}  // namespace
}  // namespace geoprior::test
