// What is the user's of the scene: the animation, what holds the sheet, what it slides along, the
// bank.
#include "experiments/sound/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include "experiments/sound/scene/bank_files.h"
#include "experiments/sound/topic.h"
#include "tests/support/recording.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sound {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using ::testing::HasSubstr;

const std::string kSquare = "pattern = { kind = \"rectangle\", width = 0.2, height = 0.2 }\n";
const std::string kSwatch = "swatches = { rulings = [0.03], widths = [0.03] }\n";

class SoundScenes : public test::RunTest {
 protected:
  struct Loaded {
    Experiment experiment;
    std::shared_ptr<const SoundScene> scene;
  };

  /// What a [scene] table describes.
  /// @param method_lines  of the variant
  [[nodiscard]] Loaded load(const std::string& scene_lines,
                            const std::string& method_lines = "method = \"clicks\"\n") const {
    const fs::path file = write_experiment(
        "sound/scene", "title = \"A scene\"\ntopic = \"sound\"\n[scene]\n" + scene_lines +
                           "\n[[variant]]\nname = \"heard\"\n" + method_lines);
    Loaded loaded{load_experiment(file, {make_topic()}, {}), nullptr};
    loaded.scene = std::dynamic_pointer_cast<const SoundScene>(std::shared_ptr<Scene>(
        make_topic().load(*loaded.experiment.cases[0].scene, file.parent_path(), 1)));
    return loaded;
  }
  [[nodiscard]] std::shared_ptr<const SoundScene> scene(const std::string& lines) const {
    return load(lines).scene;
  }

  /// What the experiment's method makes of the scene.
  [[nodiscard]] static test::Recording record(const Loaded& loaded) {
    const VariantSpec& variant = loaded.experiment.cases[0].variants[0];
    test::Recording record;
    RunContext context;
    for (const MethodEntry& method : make_topic().methods) {
      if (method.name != variant.method) continue;
      const auto made = method.make(*loaded.scene, *variant.options, context);
      std::get<std::unique_ptr<Process>>(made)->run(record, context, {});
    }
    return record;
  }

  /// Energy of what is heard of a scene (J).
  [[nodiscard]] double energy(const std::string& scene_lines) const {
    double sum = 0;
    for (const Event& event : record(load(scene_lines)).events) sum += event.energy_J;
    return sum;
  }

  /// Beside the experiment file.
  [[nodiscard]] fs::path beside(const std::string& name) const {
    fs::create_directories(folder() / "experiments" / "sound");
    return folder() / "experiments" / "sound" / name;
  }

  /// Frames of a square of 0.2 m that lies at z = 0, a millimetre farther along x in each.
  /// @param unit  of the files (m)
  void write_frames(const std::string& name, int count, double unit = 1) const {
    fs::create_directories(beside(name).parent_path());
    for (int i = 0; i < count; ++i) {
      std::ofstream out(beside(name + "_000" + std::to_string(i) + ".obj"));
      const double corners[4][2] = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
      for (const auto& [u, v] : corners) {
        out << "v " << (u + 1e-3 * i) / unit << ' ' << v / unit << " 0\nvt " << u / unit << ' '
            << v / unit << '\n';
      }
      out << "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    }
  }

  /// The square as a cylinder whose curvature is 12 cos(20 pi t) 1/m, a frame each 10 ms.
  void write_snaps(const std::string& name, int count) const {
    constexpr int kCells = 10;
    for (int i = 0; i < count; ++i) {
      const std::string number = std::to_string(10000 + i).substr(1);
      std::ofstream out(beside(name + "_" + number + ".obj"));
      const double k = 12 * std::cos(0.2 * std::numbers::pi * i);
      for (int a = 0; a <= kCells; ++a) {
        for (int b = 0; b <= kCells; ++b) {
          const double u = 0.02 * a - 0.1, v = 0.02 * b - 0.1;
          out << "v " << std::sin(k * u) / k << ' ' << v << ' ' << (1 - std::cos(k * u)) / k
              << "\nvt " << u << ' ' << v << '\n';
        }
      }
      const auto corner = [](int a, int b) {
        const std::string vertex = std::to_string(a * (kCells + 1) + b + 1);
        return " " + vertex + "/" + vertex;
      };
      for (int a = 0; a < kCells; ++a) {
        for (int b = 0; b < kCells; ++b) {
          out << 'f' << corner(a, b) << corner(a + 1, b) << corner(a + 1, b + 1) << "\nf"
              << corner(a, b) << corner(a + 1, b + 1) << corner(a, b + 1) << '\n';
        }
      }
    }
  }
};

TEST_F(SoundScenes, ListenToAnAnimationOrToSwatches) {
  write_frames("sheet", 3);
  const std::string animation =
      "animation = { path = \"sheet_%04d.obj\", frames_per_second = 50 }\n";
  EXPECT_EQ(scene(animation + kSquare)->animation->frame_count(), 3);
  EXPECT_EQ(scene(kSwatch)->animation->name(), "scene.swatches");
  EXPECT_THAT(error_of([&] { (void)scene(animation + kSwatch); }), HasSubstr("one of both"));
  EXPECT_THAT(error_of([&] { (void)scene(kSquare); }), HasSubstr("nothing to listen to"));
}

TEST_F(SoundScenes, VariantsListenToTheSameSheetByOthers) {
  write_frames("sheet", 3);
  write_snaps("snaps", 31);
  const std::string lines = "animation = { path = \"sheet_%04d.obj\", frames_per_second = 100 }\n" +
                            kSquare +
                            "others = [{ name = \"snapping\", path = \"snaps_%04d.obj\" }]\n";
  const auto events = [&](const std::string& method, const std::string& animation) {
    const std::string bank =
        method.find("sound") == std::string::npos ? "" : ", bank = { sizes = 1, variants = 1 }";
    return record(load(lines, "method = \"" + method + "\"\noptions = { animation = \"" +
                                  animation + "\"" + bank + " }\n"))
        .events.size();
  };
  for (const char* method : {"sound", "clicks", "random-sounds", "modal"}) {
    EXPECT_EQ(events(method, ""), 0U) << method;
    EXPECT_EQ(events(method, "snapping"), 6U) << method;
  }
  EXPECT_THAT(error_of([&] { (void)events("clicks", "silent"); }), HasSubstr("empty, snapping"));
  const std::string twice =
      "others = [{ name = \"a\", path = \"snaps_%04d.obj\" },"
      " { name = \"a\", path = \"snaps_%04d.obj\" }]\n";
  EXPECT_THAT(error_of([&] {
                (void)scene("animation = { path = \"sheet_%04d.obj\", frames_per_second = 100 }\n" +
                            kSquare + twice);
              }),
              HasSubstr("a name that no other has"));
}

TEST_F(SoundScenes, ReadTheFramesOfAnAnimationThatAreAskedFor) {
  write_frames("frames/sheet", 7, 1e-3);
  write_frames("frames/surface", 2, 1e-3);
  const auto animation = [&](const std::string& more) {
    return scene("animation = { path = \"frames\", scale = 1e-3" + more + " }\n" + kSquare)
        ->animation;
  };
  const std::string part = ", frames_per_second = 50, part = \"sheet\"";
  EXPECT_EQ(animation(", frames_per_second = 50")->frame_count(), 2) << "the part surface";
  const auto all = animation(part);
  ASSERT_EQ(all->frame_count(), 7);
  EXPECT_NEAR(all->time(6), 0.12, 1e-12);
  const Eigen::RowVector3d corner = all->snapshot(6).x.row(1);
  EXPECT_NEAR((corner - Eigen::RowVector3d(0.106, -0.1, 0)).norm(), 0, 1e-12);
  const auto some = animation(part + ", first = 1, last = 5, every = 2, start = 3");
  ASSERT_EQ(some->frame_count(), 3);
  EXPECT_NEAR(some->snapshot(2).x(1, 0), 0.105, 1e-12);
  EXPECT_NEAR(some->time(0), 3, 1e-12);
  EXPECT_NEAR(some->time(2), 3.08, 1e-12);
  const Eigen::RowVector3d turned = animation(part + ", up = \"y\"")->snapshot(0).x.row(1);
  EXPECT_NEAR((turned - Eigen::RowVector3d(0.1, 0, -0.1)).norm(), 0, 1e-12) << "y is up";
}

TEST_F(SoundScenes, AreHeldByPointsLinesAndDiscsForAsLongAsTheyAre) {
  write_frames("sheet", 3);
  const auto s =
      scene("animation = { path = \"sheet_%04d.obj\", frames_per_second = 50 }\n" + kSquare +
            "handles = [{ points = [{ u = 0.05, v = 0.02 }] },\n"
            "  { segment = [-0.1, -0.1, -0.1, 0.1], active = [{ from = 0, to = 1 }] },\n"
            "  { disc = { u = 0, v = -0.05, radius = 0.01 } }]\n");
  ASSERT_EQ(s->sheet.handles.size(), 3U);
  EXPECT_TRUE(s->sheet.handles[0].covers({0.05, 0.02}));
  EXPECT_FALSE(s->sheet.handles[0].covers({0.05, 0.03}));
  EXPECT_TRUE(s->sheet.handles[0].is_active(2));
  EXPECT_TRUE(s->sheet.handles[1].covers({-0.1, 0.04}));
  EXPECT_TRUE(s->sheet.handles[1].is_active(0.5));
  EXPECT_FALSE(s->sheet.handles[1].is_active(1.5));
  EXPECT_TRUE(s->sheet.handles[2].covers({0.005, -0.05}));
  EXPECT_FALSE(s->sheet.handles[2].covers({0.02, -0.05}));
}

// It slides at 5 cm/s over a plane that it touches: the energy is that of friction alone.
TEST_F(SoundScenes, SlideAsLoudAsTheFrictionSays) {
  write_frames("sheet", 4);
  const std::string sliding =
      "animation = { path = \"sheet_%04d.obj\", frames_per_second = 50 }\n" + kSquare +
      "obstacles = [{ kind = \"plane\" }]\nmaterial = { friction = ";
  const double once = energy(sliding + "0.2 }\n");
  EXPECT_GT(once, 0);
  EXPECT_NEAR(energy(sliding + "0.6 }\n"), 3 * once, 1e-9 * once);
}

// Snaps of an animation in slow motion: a cell that has just flipped is deaf for longer.
TEST_F(SoundScenes, SnapAgainOnceTheRefractoryTimeIsOver) {
  write_snaps("snaps", 31);
  const auto events = [&](const std::string& refractory) {
    const std::string lines =
        "animation = { path = \"snaps_%04d.obj\", frames_per_second = 100 }\n";
    return record(load(lines + kSquare,
                       "method = \"clicks\"\noptions = { surface = false, detection = { flips = { "
                       "refractory = " +
                           refractory + " } } }\n"))
        .events.size();
  };
  EXPECT_EQ(events("0.02"), 6U) << "every 50 ms";
  EXPECT_EQ(events("0.07"), 3U) << "every second one";
}

TEST_F(SoundScenes, AreDrawnWithTheirSurfaceOrWithout) {
  for (const char* method : {"sound", "clicks", "random-sounds", "modal"}) {
    const std::string lines = "method = \"" + std::string(method) + "\"\noptions = { ";
    const std::string bank = std::string(method).find("sound") == std::string::npos
                                 ? ""
                                 : "bank = { sizes = 1, variants = 1 }, ";
    const auto has_surface = [&](const std::string& options) {
      const test::Recording made = record(load(kSwatch, lines + bank + options + " }\n"));
      return !made.frames.empty() && made.frames.front().find_part("surface") != nullptr;
    };
    EXPECT_TRUE(has_surface("tail = 0.1")) << method;
    EXPECT_FALSE(has_surface("tail = 0.1, surface = false")) << method;
  }
}

TEST_F(SoundScenes, AreHeardThroughABankThatWasWrittenToAFolder) {
  SoundBank bank;
  for (const SoundKind kind : {SoundKind::flap, SoundKind::friction}) {
    BankSound& sound = bank.sounds.emplace_back();
    sound.kind = kind;
    sound.ruling_length = sound.free_border = sound.speed = 0.02;
    sound.samples = Eigen::VectorXf::LinSpaced(480, -0.003F, 0.002F);
  }
  EXPECT_EQ(scene(kSwatch)->bank, nullptr) << "one is generated";
  write_bank(bank, beside("my-bank"));
  const auto heard = scene(kSwatch + "bank = \"my-bank\"\n");
  ASSERT_NE(heard->bank, nullptr);
  ASSERT_EQ(heard->bank->sounds.size(), 2U);
  EXPECT_EQ(heard->bank->sounds[1].kind, SoundKind::friction);
  EXPECT_EQ(heard->inputs().size(), 3U);
  const auto error = [&](const std::string& name) {
    return error_of([&] { (void)scene(kSwatch + "bank = \"" + name + "\"\n"); });
  };
  EXPECT_THAT(error("my-bank/bank.csv"), HasSubstr("scene.bank"));
  EXPECT_THAT(error("my-bank/bank.csv"), HasSubstr("is no folder"));
  EXPECT_THAT(error("your-bank"), HasSubstr("no folder 'your-bank'"));
  EXPECT_THAT(error("your-bank"), HasSubstr(beside("your-bank").string()));
}

// What a program from outside is given: one clamped swatch of three is held along its ruling.
TEST_F(SoundScenes, GiveTheMeshOnceAndThenWhereItIs) {
  const auto s = scene(kSwatch);
  const Frame given = s->given();
  ASSERT_EQ(given.parts.size(), static_cast<std::size_t>(s->animation->frame_count()));
  const Part& first = given.require_part("sheet_0000", Part::Kind::triangles);
  const SheetSnapshot start = s->animation->snapshot(0);
  EXPECT_EQ(first.points, start.x);
  EXPECT_EQ(first.triangles, start.mesh.triangles);
  EXPECT_EQ(first.require_array("pattern", NamedArray::On::points, 2).values, start.mesh.pattern);
  const auto& handle = first.require_array("handle", NamedArray::On::points, 1).values;
  EXPECT_EQ((handle.array() == 0).count(), 9) << "3 cm in edges of 4 mm at most";
  EXPECT_EQ((handle.array() == -1).count(), handle.rows() - 9);
  const Part& later = given.require_part("sheet_0003", Part::Kind::points);
  EXPECT_EQ(later.points, s->animation->snapshot(3).x);
  EXPECT_NE(later.points, first.points) << "one swatch has snapped";
  EXPECT_EQ(given.require_table("frames").rows(3, 1), s->animation->time(3));
  EXPECT_EQ(given.require_table("tears").rows.rows(), 0);
}

/// A square that is torn a step a frame, and that has another mesh from the third frame on.
class TornSquare final : public SheetAnimation {
 public:
  [[nodiscard]] int frame_count() const override { return 4; }
  [[nodiscard]] double time(int frame) const override { return frame; }
  [[nodiscard]] std::string name() const override { return "torn"; }
  [[nodiscard]] SheetSnapshot snapshot(int frame) const override {
    SheetSnapshot out;
    out.time = time(frame);
    out.mesh.pattern.resize(4, 2);
    out.mesh.pattern << 0, 0, 0.1, 0, 0.1, 0.1, 0, 0.1;
    out.mesh.triangles.resize(2, 3);
    if (frame < 2) {
      out.mesh.triangles << 0, 1, 2, 0, 2, 3;
    } else {
      out.mesh.triangles << 0, 1, 3, 1, 2, 3;
    }
    out.x = Eigen::MatrixX3d::Constant(4, 3, frame);
    out.v = Eigen::MatrixX3d::Constant(4, 3, 1);
    for (int i = 0; i <= frame; ++i)
      out.torn.push_back({0, i - 0.5, {0.01 * i, 0.05}, {frame + 0.0, 0, 0}});
    return out;
  }
};

TEST(SoundGiven, HasAMeshWhereItIsAnotherOneAndTearsWhereTheyWereAtTheTime) {
  SoundScene scene;
  scene.animation = std::make_shared<TornSquare>();
  const Frame given = scene.given();
  using Kind = Part::Kind;
  const std::array<Kind, 4> kinds{Kind::triangles, Kind::points, Kind::triangles, Kind::points};
  for (int i = 0; i < 4; ++i) {
    const std::string name = "sheet_000" + std::to_string(i);
    const Part& part = given.require_part(name, kinds[i]);
    EXPECT_EQ(part.points(0, 0), i);
    EXPECT_EQ(part.require_array("velocity", NamedArray::On::points, 3).values(2, 1), 1);
  }
  const Eigen::MatrixXd& tears = given.require_table("tears").rows;
  ASSERT_EQ(tears.rows(), 4);
  EXPECT_EQ(tears.col(1), Eigen::Vector4d(-0.5, 0.5, 1.5, 2.5)) << "time";
  EXPECT_EQ(tears.col(4), Eigen::Vector4d(0, 1, 2, 3)) << "x, in the frame that has it first";
}

/// Still, and as large as asked for.
class LargeSheet final : public SheetAnimation {
 public:
  explicit LargeSheet(Eigen::Index vertices) : vertices_(vertices) {}
  [[nodiscard]] int frame_count() const override { return 2; }
  [[nodiscard]] double time(int frame) const override { return frame; }
  [[nodiscard]] std::string name() const override { return "large"; }
  [[nodiscard]] SheetSnapshot snapshot(int frame) const override {
    SheetSnapshot out;
    out.time = time(frame);
    out.mesh.pattern.setZero(vertices_, 2);
    out.x.setZero(vertices_, 3);
    return out;
  }

 private:
  Eigen::Index vertices_;
};

TEST(SoundGiven, HasNoSheetsBeyondItsLimit) {
  for (const int beyond : {0, 1}) {
    SoundScene scene;
    scene.animation = std::make_shared<LargeSheet>(SoundScene::kMostGiven / 2 + beyond);
    const Frame given = scene.given();
    EXPECT_EQ(given.parts.size(), beyond == 0 ? 2U : 0U);
    EXPECT_EQ(given.require_table("frames").rows.rows(), 2);
  }
}

}  // namespace
}  // namespace geoprior::sound
