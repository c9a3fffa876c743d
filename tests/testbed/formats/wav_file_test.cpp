#include "testbed/formats/wav_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

Sound stereo_ramp(int count) {
  Sound sound{44100, Eigen::MatrixXd(count, 2)};
  sound.samples.col(0) = Eigen::VectorXd::LinSpaced(count, -1, 1);
  sound.samples.col(1) = Eigen::VectorXd::LinSpaced(count, 0.3, -0.7);
  return sound;
}

void add(Bytes& bytes, const char* word) {
  for (; *word != 0; ++word) bytes.push_back(static_cast<std::byte>(*word));
}

void add(Bytes& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
}

struct Format {
  std::uint32_t tag = 1;  ///< 1: PCM, 3: floating point
  std::uint32_t channels = 1;
  std::uint32_t sample_rate = 48000;
  std::uint32_t bits = 16;
};

/// A WAV file by the definition of RIFF, of samples as they are stored.
Bytes made_wav(const Format& format, const Bytes& data) {
  const std::uint32_t frame = format.channels * format.bits / 8;
  const auto size = static_cast<std::uint32_t>(data.size());
  Bytes bytes;
  add(bytes, "RIFF");
  add(bytes, 36 + size, 4);
  add(bytes, "WAVEfmt ");
  add(bytes, 16, 4);
  add(bytes, format.tag, 2);
  add(bytes, format.channels, 2);
  add(bytes, format.sample_rate, 4);
  add(bytes, format.sample_rate * frame, 4);
  add(bytes, frame, 2);
  add(bytes, format.bits, 2);
  add(bytes, "data");
  add(bytes, size, 4);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

template <class T>
Bytes stored(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::string refusal(const Bytes& bytes) {
  return error_of([&] { (void)wav_from_bytes(bytes, "bank/a.wav"); });
}

TEST(WavFile, GivesBackSamplesToHalfAStepOf24Bits) {
  const Sound sound = stereo_ramp(1001);
  const Sound read = wav_from_bytes(wav_bytes(sound), "ramp");
  EXPECT_EQ(read.sample_rate, 44100);
  ASSERT_EQ(read.samples.rows(), 1001);
  ASSERT_EQ(read.samples.cols(), 2);
  const Eigen::MatrixXd difference = (read.samples - sound.samples).cwiseAbs();
  EXPECT_LE(difference.topRows(1000).maxCoeff(), std::ldexp(1.0, -24));
  EXPECT_EQ(difference(1000, 0), std::ldexp(1.0, -23)) << "there is no +1";
  EXPECT_EQ(wav_from_bytes(wav_bytes(read), "again").samples, read.samples) << "exact from then on";
}

// RIFF, 24-bit PCM: 44 bytes of head, 3 a sample, a zero to an even count; nothing that knows when.
TEST(WavFile, HasTheBytesOfTheFormatAndNoOthers) {
  Sound sound{48000, Eigen::MatrixXd::Zero(3, 1)};
  sound.samples.col(0) << 0.5, -1, std::ldexp(1.0, -23);
  Bytes expected = made_wav({1, 1, 48000, 24}, {});
  for (const int x : {0x00, 0x00, 0x40, 0x00, 0x00, 0x80, 0x01, 0x00, 0x00, 0x00}) {
    expected.push_back(static_cast<std::byte>(x));
  }
  expected[40] = std::byte{9};       // bytes of samples
  expected[4] = std::byte{36 + 10};  // bytes behind this number
  EXPECT_EQ(wav_bytes(sound), expected);
  EXPECT_EQ(wav_bytes(stereo_ramp(100)), wav_bytes(stereo_ramp(100)));
}

TEST(WavFile, OfEveryAcceptedKindIsRead) {
  const std::vector<double> values{0.5, -0.25, 0};
  const auto first = [&](const Format& format, const Bytes& data) {
    return Eigen::VectorXd(wav_from_bytes(made_wav(format, data), "kind").samples.col(0));
  };
  const Eigen::Vector3d expected(0.5, -0.25, 0);
  EXPECT_EQ(first({1, 1, 48000, 16}, stored<std::int16_t>({16384, -8192, 0})), expected);
  EXPECT_EQ(first({1, 1, 48000, 32}, stored<std::int32_t>({1 << 30, -(1 << 29), 0})), expected);
  EXPECT_EQ(first({3, 1, 48000, 32}, stored<float>({0.5F, -0.25F, 0})), expected);
  EXPECT_EQ(first({3, 1, 48000, 64}, stored(values)), expected);
  EXPECT_EQ(first({3, 1, 48000, 32}, stored<float>({1.5F})), (Eigen::Matrix<double, 1, 1>(1.5)))
      << "floating point has room above full scale";
}

TEST(WavFile, ThatWouldClipIsRefusedWithSampleAndChannel) {
  Sound sound = stereo_ramp(10);
  sound.samples(7, 1) = -1.001;
  EXPECT_THAT(error_of([&] { (void)wav_bytes(sound); }),
              AllOf(HasSubstr("sample 7 of channel 1"), HasSubstr("clips")));
  sound.samples(7, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of([&] { (void)wav_bytes(sound); }),
              AllOf(HasSubstr("sample 7 of channel 1"), HasSubstr("not finite")));
}

TEST(WavFile, OfNothingOrOfAbsurdShapeIsNotWritten) {
  EXPECT_THAT(error_of([] {
                (void)wav_bytes({48000, Eigen::MatrixXd(0, 1)});
              }),
              HasSubstr("no samples"));
  EXPECT_THAT(error_of([] {
                (void)wav_bytes({48000, Eigen::MatrixXd::Zero(1, 9)});
              }),
              HasSubstr("9 channels"));
  EXPECT_THAT(error_of([] {
                (void)wav_bytes({1, Eigen::MatrixXd::Zero(1, 1)});
              }),
              HasSubstr("1 Hz"));
}

TEST(WavFile, BrokenIsOneErrorThatNamesTheFile) {
  EXPECT_THAT(refusal({}), AllOf(HasSubstr("bank/a.wav"), HasSubstr("is empty")));
  Bytes text;
  add(text, "kind,l_r,l_c,file\nbend,0.1,0.1,a.wav\n");
  EXPECT_THAT(refusal(text), AllOf(HasSubstr("bank/a.wav"), HasSubstr("no WAV")));
  const Bytes whole = wav_bytes(stereo_ramp(100));
  EXPECT_THAT(refusal(Bytes(whole.begin(), whole.end() - 7)),
              AllOf(HasSubstr("bank/a.wav"), HasSubstr("7 bytes are missing")));
  EXPECT_THAT(refusal(Bytes(whole.begin(), whole.begin() + 40)), HasSubstr("cut short"));
  EXPECT_THAT(refusal(made_wav({}, {})), HasSubstr("no samples"));
}

TEST(WavFile, OfOtherSamplesIsRefusedAndSaysWhy) {
  EXPECT_THAT(refusal(made_wav({1, 1, 48000, 8}, Bytes(100))),
              AllOf(HasSubstr("bank/a.wav"), HasSubstr("8 bits"), HasSubstr("16, 24 or 32-bit")));
  EXPECT_THAT(refusal(made_wav({6, 1, 8000, 8}, Bytes(100))), HasSubstr("another kind")) << "A-law";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal(made_wav({3, 2, 48000, 32}, stored<float>({0, 0, 0, nan}))),
              AllOf(HasSubstr("bank/a.wav"), HasSubstr("sample 1 of channel 1")));
  for (const std::uint32_t rate : {1U, 7999U, 192001U, 2000000000U}) {
    EXPECT_THAT(refusal(made_wav({1, 1, rate, 16}, Bytes(100))),
                AllOf(HasSubstr("bank/a.wav"), HasSubstr(std::to_string(rate) + " Hz")));
  }
  EXPECT_THAT(refusal(made_wav({1, 9, 48000, 16}, Bytes(18 * 10))), HasSubstr("9 channels"));
}

/// A ramp of 16 bits, of which the head says these sizes.
Bytes with_sizes(std::uint32_t riff, std::uint32_t data) {
  Bytes bytes = made_wav({}, stored<std::int16_t>({1 << 14, -(1 << 13), 77}));
  for (const auto& [at, value] : {std::pair(4, riff), std::pair(40, data)}) {
    for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value >> 8 * i);
  }
  return bytes;
}

// ffmpeg, GStreamer, SoX and arecord, of which none can go back to the head of what is in a pipe.
TEST(WavFile, FromAPipeIsReadToItsEnd) {
  for (const std::uint32_t size : {0xffffffffU, 0U, 0x7ffff000U, 0x80000000U}) {
    std::vector<std::string> notes;
    const Sound sound = wav_from_bytes(with_sizes(size, size), "bank/a.wav", notes);
    ASSERT_EQ(sound.samples.rows(), 3) << size;
    EXPECT_EQ(sound.samples(0, 0), 0.5);
    ASSERT_EQ(notes.size(), 1U) << size;
    EXPECT_THAT(notes[0], AllOf(HasSubstr("bank/a.wav"), HasSubstr("6 bytes of samples")));
  }
  EXPECT_THAT(refusal(with_sizes(42, 600)), HasSubstr("594 bytes are missing"));
  Bytes empty = made_wav({}, {});
  add(empty, "LIST");
  add(empty, 4, 4);
  add(empty, "INFO");
  EXPECT_THAT(refusal(empty), HasSubstr("no samples")) << "chunks follow it";
}

TEST(WavFile, IsReadWhateverItsByteOrderAndTheWidthOfItsSizes) {
  Bytes big;
  add(big, "RIFX");
  for (const int b : {0, 0, 0, 38}) big.push_back(static_cast<std::byte>(b));
  add(big, "WAVEfmt ");
  for (const int b : {0, 0, 0, 16, 0, 1, 0, 1, 0, 0, 0xbb, 0x80, 0, 1, 0x77, 0, 0, 2, 0, 16})
    big.push_back(static_cast<std::byte>(b));
  add(big, "data");
  for (const int b : {0, 0, 0, 2, 0x40, 0}) big.push_back(static_cast<std::byte>(b));
  EXPECT_EQ(wav_from_bytes(big, "RIFX").samples, (Eigen::Matrix<double, 1, 1>(0.5)));
  Bytes wide = with_sizes(0xffffffff, 0xffffffff);
  wide[1] = std::byte{'F'};
  wide[2] = std::byte{'6'};
  wide[3] = std::byte{'4'};
  Bytes sizes;
  add(sizes, "ds64");
  for (const std::uint32_t x : {28U, 0U, 0U, 4U, 0U, 2U, 0U, 0U}) add(sizes, x, 4);
  wide.insert(wide.begin() + 12, sizes.begin(), sizes.end());
  EXPECT_EQ(wav_from_bytes(wide, "RF64").samples.rows(), 2) << "four bytes of samples";
}

// Whatever stands in a byte, the answer is a sound or an Error.
TEST(WavFile, DamagedAnywhereIsReadOrRefused) {
  const Bytes whole = wav_bytes(stereo_ramp(5));
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      Bytes damaged = whole;
      damaged[at] = static_cast<std::byte>(value);
      try {
        const Sound sound = wav_from_bytes(damaged, "damaged");
        EXPECT_TRUE(sound.samples.allFinite());
        EXPECT_LE(sound.samples.size(), std::ssize(whole));
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 50);
}

class WavOnDisk : public RunTest {
 protected:
  static Sound read(const std::filesystem::path& file) {
    std::vector<std::string> notes;
    Sound sound = read_wav(file, notes);
    EXPECT_TRUE(notes.empty());
    return sound;
  }
};

TEST_F(WavOnDisk, IsReadAsItsBytes) {
  const auto file = folder() / "a.wav";
  write_file_atomically(file, std::span<const std::byte>(wav_bytes(stereo_ramp(9))));
  EXPECT_EQ(read(file).samples, wav_from_bytes(wav_bytes(stereo_ramp(9)), "").samples);
  const auto absent = folder() / "b.wav";
  EXPECT_THAT(error_of([&] { (void)read(absent); }), HasSubstr(absent.string()));
  EXPECT_THAT(error_of([&] { (void)read(folder()); }), HasSubstr("is a folder"));
}

}  // namespace
}  // namespace geoprior::test
