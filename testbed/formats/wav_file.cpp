#include "testbed/formats/wav_file.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/input_file.h"
#include "testbed/formats/wav_chunks.h"

namespace geoprior {

namespace {

/// Bytes in memory as libsndfile reads and writes them.
struct SoundBytes {
  std::span<const std::byte> in;
  std::vector<std::byte> out;
  sf_count_t at = 0;

  static SoundBytes& of(void* user) { return *static_cast<SoundBytes*>(user); }

  static sf_count_t length(void* user) {
    return static_cast<sf_count_t>(std::max(of(user).in.size(), of(user).out.size()));
  }
  static sf_count_t tell(void* user) { return of(user).at; }
  static sf_count_t seek(sf_count_t offset, int whence, void* user) {
    if (whence == SEEK_CUR) offset += of(user).at;
    if (whence == SEEK_END) offset += length(user);
    if (offset < 0) return -1;
    return of(user).at = offset;
  }
  static sf_count_t read(void* to, sf_count_t count, void* user) {
    SoundBytes& bytes = of(user);
    const auto size = static_cast<sf_count_t>(bytes.in.size());
    const sf_count_t there =
        std::clamp<sf_count_t>(size - bytes.at, 0, std::max<sf_count_t>(count, 0));
    if (there > 0) std::memcpy(to, bytes.in.data() + bytes.at, there);
    bytes.at += there;
    return there;
  }
  static sf_count_t write(const void* from, sf_count_t count, void* user) {
    SoundBytes& bytes = of(user);
    const std::size_t end = bytes.at + count;
    if (bytes.out.size() < end) bytes.out.resize(end);
    std::memcpy(bytes.out.data() + bytes.at, from, count);
    bytes.at += count;
    return count;
  }
};

struct SoundFileClosed {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundFile = std::unique_ptr<SNDFILE, SoundFileClosed>;

SoundFile open_sound(SoundBytes& bytes, int mode, SF_INFO& info) {
  SF_VIRTUAL_IO io{SoundBytes::length, SoundBytes::seek, SoundBytes::read, SoundBytes::write,
                   SoundBytes::tell};
  return SoundFile(sf_open_virtual(&io, mode, &info, &bytes));
}

using Samples = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string place_of(Eigen::Index sample, Eigen::Index channel) {
  return "sample " + std::to_string(sample) + " of channel " + std::to_string(channel);
}

void require_finite_samples(const Samples& samples, const std::string& name) {
  if (samples.allFinite()) return;
  for (Eigen::Index i = 0; i < samples.rows(); ++i) {
    for (Eigen::Index c = 0; c < samples.cols(); ++c) {
      if (std::isfinite(samples(i, c))) continue;
      throw Error(place_of(i, c) + " is not finite", name);
    }
  }
}

void require_channels(Eigen::Index channels, const std::string& name) {
  if (channels >= 1 && channels <= kMostChannels) return;
  throw Error("has " + std::to_string(channels) + " channels", name,
              "1 to " + std::to_string(kMostChannels));
}

void require_samples_of_known_kind(const SF_INFO& info, const std::string& name) {
  switch (info.format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_16:
    case SF_FORMAT_PCM_24:
    case SF_FORMAT_PCM_32:
    case SF_FORMAT_FLOAT:
    case SF_FORMAT_DOUBLE:
      return;
    case SF_FORMAT_PCM_U8:
      throw Error(
          "has 8 bits a sample, whose steps (48 dB below full scale) are heard in what decays",
          name, kAllowedWav);
    default:
      throw Error("has samples of another kind", name, kAllowedWav);
  }
}

/// What is written: 24 bits, at the upper end of 32.
int quantised(double x) {
  constexpr double kFullScale = 8388608;  // 2^23
  return static_cast<int>(std::min(std::nearbyint(kFullScale * x), kFullScale - 1)) * 256;
}

void require_writable(const Sound& sound) {
  const std::string name = "sound for a WAV file";
  require_sample_rate(sound.sample_rate, name);
  require_channels(sound.samples.cols(), name);
  if (sound.samples.rows() == 0) throw Error("has no samples", name);
  require_finite_samples(sound.samples, name);
  constexpr double kBytes = 3, kHead = 1024;
  if (kBytes * static_cast<double>(sound.samples.size()) + kHead >
      std::numeric_limits<std::uint32_t>::max()) {
    throw Error("is longer than a WAV file can be", name, "4 GB");
  }
  for (Eigen::Index i = 0; i < sound.samples.rows(); ++i) {
    for (Eigen::Index c = 0; c < sound.samples.cols(); ++c) {
      const double x = sound.samples(i, c);
      if (std::abs(x) <= 1) continue;
      throw Error(place_of(i, c) + " clips: it is " + std::to_string(x), name, "-1 to 1");
    }
  }
}

}  // namespace

std::vector<std::byte> wav_bytes(const Sound& sound) {
  require_writable(sound);
  SF_INFO info{};
  info.samplerate = sound.sample_rate;
  info.channels = static_cast<int>(sound.samples.cols());
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_24;
  std::vector<int> values;
  values.reserve(sound.samples.size());
  for (Eigen::Index i = 0; i < sound.samples.rows(); ++i) {
    for (Eigen::Index c = 0; c < sound.samples.cols(); ++c) {
      values.push_back(quantised(sound.samples(i, c)));
    }
  }
  SoundBytes out;
  SoundFile file = open_sound(out, SFM_WRITE, info);
  if (!file) throw Error(sf_strerror(nullptr), "sound for a WAV file");
  const auto count = static_cast<sf_count_t>(values.size());
  if (sf_write_int(file.get(), values.data(), count) != count) {
    throw Error(sf_strerror(file.get()), "sound for a WAV file");
  }
  file.reset();  // completes the header
  return std::move(out.out);
}

Sound wav_from_bytes(std::span<const std::byte> bytes, const std::string& name,
                     std::vector<std::string>& notes) {
  const std::vector<std::byte> plain = plain_wav(bytes, name, notes);
  SoundBytes in{plain, {}, 0};
  SF_INFO info{};
  const SoundFile file = open_sound(in, SFM_READ, info);
  if (!file) throw Error(std::string("is damaged: ") + sf_strerror(nullptr), name, kAllowedWav);
  require_samples_of_known_kind(info, name);
  require_sample_rate(info.samplerate, name);
  require_channels(info.channels, name);
  if (info.frames <= 0) throw Error("has no samples", name);
  // Each sample has two bytes at least: what says to have more is not believed.
  if (info.frames > static_cast<sf_count_t>(plain.size()) / (2 * info.channels)) {
    throw Error("is damaged: it says to have more samples than it has bytes for", name);
  }
  Samples samples(info.frames, info.channels);
  if (sf_readf_double(file.get(), samples.data(), info.frames) != info.frames) {
    throw Error(std::string("cannot be read: ") + sf_strerror(file.get()), name);
  }
  require_finite_samples(samples, name);
  return {info.samplerate, samples};
}

Sound wav_from_bytes(std::span<const std::byte> bytes, const std::string& name) {
  std::vector<std::string> notes;
  return wav_from_bytes(bytes, name, notes);
}

Sound read_wav(const std::filesystem::path& file, std::vector<std::string>& notes) {
  require_regular_file(file);
  const std::string bytes = read_whole_file(file);
  return wav_from_bytes(std::as_bytes(std::span(bytes)), file.string(), notes);
}

}  // namespace geoprior
