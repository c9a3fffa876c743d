#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/sound/scene/bank_files.h"
#include "experiments/sound/scene/sheet_files.h"
#include "testbed/formats/wav_file.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sound {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A bank of one flap and one loop of friction, with peaks that a WAV file cannot hold.
SoundBank a_bank() {
  SoundBank bank;
  bank.sounds.push_back({SoundKind::flap});
  bank.sounds.push_back({SoundKind::friction});
  double value = 0.01;
  for (BankSound& sound : bank.sounds) {
    for (const BankNumber& number : kBankNumbers) sound.*number.value = value += 0.0123;
    sound.samples = Eigen::VectorXf::LinSpaced(480, -0.003F, 0.002F);
  }
  return bank;
}

class BankFiles : public test::ScratchFolder {
 protected:
  void write_wav(const std::string& name, const Sound& sound) {
    write(name, test::text_of(wav_bytes(sound)));
  }
  SoundBank read() { return read_bank(folder(), notes_, inputs_); }
  void expect_read_error(const std::string& text) {
    test::expect_error([&] { read(); }, {text});
  }

  std::vector<std::string> notes_;
  std::vector<fs::path> inputs_;
};

TEST_F(BankFiles, SurviveWritingAndReading) {
  const SoundBank bank = a_bank();
  write_bank(bank, folder());
  const SoundBank back = read();
  ASSERT_EQ(back.sounds.size(), 2u);
  EXPECT_EQ(back.sample_rate, 48000);
  EXPECT_EQ(back.sounds[0].kind, SoundKind::flap);
  for (std::size_t i = 0; i < 2; ++i) {
    for (const BankNumber& number : kBankNumbers)
      EXPECT_EQ(back.sounds[i].*number.value, bank.sounds[i].*number.value) << number.name;
  }
  EXPECT_LT((back.sounds[0].samples - bank.sounds[0].samples).cwiseAbs().maxCoeff(), 1e-9F);
  EXPECT_TRUE(notes_.empty());
  EXPECT_EQ(inputs_.size(), 3u);
}

TEST_F(BankFiles, OtherRatesAndChannelsAreTakenAndSaid) {
  write_wav("a.wav", {48000, Eigen::MatrixXd::Constant(4800, 1, 0.25)});
  write_wav("b.wav", {24000, Eigen::MatrixXd::Constant(2400, 2, 0.25)});
  write("bank.csv", "file,kind,l_r,l_c\na.wav,flap,0.1,0\nb.wav,crac,0.01,0.02\n");
  const SoundBank bank = read();
  EXPECT_NEAR(static_cast<double>(bank.sounds[1].samples.size()), 4800, 2);
  EXPECT_NEAR(bank.sounds[1].samples[2400], 0.25F, 1e-3F);
  ASSERT_EQ(notes_.size(), 2u);
  EXPECT_THAT(notes_[0], HasSubstr("channels"));
  EXPECT_THAT(notes_[1], HasSubstr("24000 Hz"));
}

TEST_F(BankFiles, ListsAreReadInEveryForm) {
  write_wav("a.wav", {48000, Eigen::MatrixXd::Constant(480, 1, 0.25)});
  for (const std::string list : {"file,kind,L_R,l_c,peak\na.wav,flap,0.5,0.25,\n",
                                 "\"file\";Kind;l_r;l_c\n\"a.wav\";flap;0,5;0,25\n"}) {
    for (const test::TextForm& form : test::text_forms(list)) {
      write("bank.csv", form.bytes);
      const SoundBank bank = read();
      ASSERT_EQ(bank.sounds.size(), 1U) << form.name;
      EXPECT_EQ(bank.sounds[0].ruling_length, 0.5) << form.name;
      EXPECT_EQ(bank.sounds[0].free_border, 0.25) << form.name;
    }
  }
}

TEST_F(BankFiles, BadOnesAreNamed) {
  test::expect_error([&] { read_bank(folder() / "none", notes_, inputs_); }, {"none"});
  expect_read_error("bank.csv");
  const auto with = [&](const std::string& rows, const std::string& error) {
    write("bank.csv", "file,kind,l_r,l_c,speed\n" + rows);
    expect_read_error(error);
  };
  write_wav("a.wav", {48000, Eigen::MatrixXd::Constant(480, 1, 0.25)});
  write("broken.wav", "RIFFxxxxWAVE");
  write("empty.wav", "");
  with("b.wav,flap,0.1,0.1,\n", "which is not there");
  with(",flap,0.1,0.1,0\n", "bank.csv:2");
  with("../a.wav,flap,0.1,0.1,0\n", "in the bank's folder");
  with("/a.wav,flap,0.1,0.1,0\n", "in the bank's folder");
  with("a.wav,bang,0.1,0.1,0\n", "flap, crac, friction, tear");
  with("a.wav,flap,-0.1,0.1,0\n", "negative");
  with("a.wav,flap,x,0.1,0\n", "no finite number");
  with("a.wav,flap\n", "a row as long as the first");
  with("broken.wav,flap,0.1,0.1,0\n", "broken.wav");
  with("empty.wav,flap,0.1,0.1,0\n", "empty.wav");
  with("a.wav,friction,0,0,0.1\n", "no sound of a flap or crac");
  with("", "no sound of a flap or crac");
  with("a.wav,flap,,0.1,0\n", "has no l_r");
  write("bank.csv", "file,kind\na.wav,flap\n");
  expect_read_error("has no l_r");
}

class SheetFrames : public test::ScratchFolder {
 protected:
  /// Two triangles over a square of 0.2 m, with `line` in place of the last texture coordinate.
  void write_obj(const std::string& name, const std::string& line = "vt -0.1 0.1",
                 const std::string& faces = "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n") {
    std::ofstream(folder() / name) << "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0.1 0.1 0.01\nv -0.1 0.1 0\n"
                                   << "vt -0.1 -0.1\nvt 0.1 -0.1\nvt 0.1 0.1\n"
                                   << line << "\n"
                                   << faces;
  }
  std::shared_ptr<const SheetAnimation> open(const std::string& name, double width = 0.2,
                                             int every = 1) {
    SheetFileOptions options;
    options.sequence.path = (folder() / name).string();
    options.sequence.frames_per_second = 50;
    options.every = every;
    return open_sheet_files(options, {}, paper::rectangle_pattern(width, 0.2), warnings_, inputs_);
  }

  std::vector<std::string> warnings_;
  std::vector<fs::path> inputs_;
};

TEST_F(SheetFrames, AreReadWithTheirPattern) {
  write_obj("sheet_0000.obj");
  write_obj("sheet_0001.obj");
  const auto sheet = open("sheet_%04d.obj");
  ASSERT_EQ(sheet->frame_count(), 2);
  EXPECT_DOUBLE_EQ(sheet->time(1), 0.02);
  const SheetSnapshot frame = sheet->snapshot(1);
  EXPECT_EQ(frame.mesh.triangle_count(), 2);
  EXPECT_DOUBLE_EQ(frame.mesh.pattern(3, 0), -0.1);
  EXPECT_DOUBLE_EQ(frame.x(2, 2), 0.01);
  EXPECT_EQ(frame.v.rows(), 0);
  EXPECT_EQ(inputs_.size(), 2u);
  for (const char* more : {"sheet_0002.obj", "sheet_0003.obj", "sheet_0004.obj"}) write_obj(more);
  inputs_.clear();
  const auto half = open("sheet_%04d.obj", 0.2, 2);
  EXPECT_EQ(inputs_.size(), 3u);
  ASSERT_EQ(half->frame_count(), 3);
  EXPECT_DOUBLE_EQ(half->time(2), 0.08);
}

TEST_F(SheetFrames, BadOnesAreNamed) {
  write_obj("none_0000.obj", "", "f 1 2 3\nf 1 3 4\n");
  test::expect_error([&] { open("none_%04d.obj"); }, {"no coordinates of the pattern"});
  write_obj("seam_0000.obj", "vt -0.1 0.1\nvt 0 0", "f 1/1 2/2 3/3\nf 1/1 3/5 4/4\n");
  test::expect_error([&] { open("seam_%04d.obj"); }, {"no coordinates of the pattern"});
  write_obj("nan_0000.obj", "vt -0.1 nan");
  test::expect_error([&] { open("nan_%04d.obj"); }, {"nan_0000.obj"});
  write_obj("turned_0000.obj", "vt -0.1 0.1", "f 1/1 3/3 2/2\nf 1/1 4/4 3/3\n");
  test::expect_error([&] { open("turned_%04d.obj"); }, {"turned over"});
  write_obj("sheet_0000.obj");
  test::expect_error([&] { open("sheet_%04d.obj", 0.3); }, {"of another sheet"});
  test::expect_error([&] { open("missing_%04d.obj"); }, {"missing"});
  write_obj("sheet_0001.obj");
  test::expect_error([&] { open("sheet_%04d.obj", 0.2, 2); }, {"leaves one of 2 frames"});
}

}  // namespace
}  // namespace geoprior::sound
