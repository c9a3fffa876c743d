// One experiment in the many ways in which TOML can write it.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "core/random.h"
#include "tests/support/perturbed.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

/// What the experiment says.
struct DiscValues {
  int points = 24, frames = 3, segments = 16, seed = 1;
  double radius = 2, to_deg = 90;
};

class ExperimentWriter {
 public:
  ExperimentWriter(RandomStream& random, const DiscValues& values)
      : random_(random), values_(values) {}

  /// The plainest form.
  [[nodiscard]] std::string plain() const {
    std::array<char, 1000> text{};
    std::snprintf(text.data(), text.size(), R"(title = "Tom's \"disc\" # 1"
topic = "toy-circle"
seed = %d
[scene]
points = %d
radius_m = %.17g
[scene.motion]
to_deg = %.17g
frames = %d
[[variant]]
name = "exact"
method = "exact"
[[variant]]
name = "polygon"
method = "polygon"
role = "ablation"
reference = "exact"
[variant.options]
segments = %d
)",
                  values_.seed, values_.points, values_.radius, values_.to_deg, values_.frames,
                  values_.segments);
    return text.data();
  }

  std::string write() {
    static constexpr std::array<const char*, 3> kTitles{R"("Tom's \"disc\" # 1")",
                                                        R"("\u0054om's \u0022disc\" # 1")",
                                                        "\"\"\"Tom's \"disc\" # 1\"\"\""};
    std::vector<std::string> top{line("title", kTitles[random_.below(3)]),
                                 line("topic", text("toy-circle")),
                                 line("seed", integer(values_.seed))};
    std::vector<std::string> sections;
    scene(top, sections);
    variants(top, sections);
    std::string out;
    shuffle(top);
    for (const std::string& part : top) out += some_comment() + part;
    shuffle(sections);
    for (const std::string& part : sections) out += some_comment() + part;
    return out;
  }

 private:
  void shuffle(std::vector<std::string>& list) {
    for (std::size_t i = list.size(); i > 1; --i)
      std::swap(list[i - 1], list[random_.below(static_cast<std::uint32_t>(i))]);
  }
  std::string some_comment() {
    constexpr std::array<const char*, 4> kComments{"", "", "\n# points = 9\n", "\t# [scene]\n\n"};
    return kComments[random_.below(kComments.size())];
  }
  std::string key(const std::string& name) {
    const std::uint32_t kind = random_.below(6);
    return kind == 0 ? "\"" + name + "\"" : kind == 1 ? "'" + name + "'" : name;
  }
  std::string text(const std::string& value) {
    return random_.below(2) == 0 ? "\"" + value + "\"" : "'" + value + "'";
  }
  std::string integer(int value) {
    std::array<char, 40> out{};
    constexpr std::array<const char*, 4> kFormats{"%d", "+%d", "0x%X", "0o%o"};
    std::snprintf(out.data(), out.size(), kFormats[random_.below(kFormats.size())], value);
    return out.data();
  }
  std::string real(double value) {
    std::array<char, 40> out{};
    constexpr std::array<const char*, 4> kFormats{"%.6f", "%+.6f", "%.10e", "%.10E"};
    std::snprintf(out.data(), out.size(), kFormats[random_.below(kFormats.size())], value);
    return out.data();
  }
  std::string line(const std::string& name, const std::string& value) {
    constexpr std::array<const char*, 3> kEquals{" = ", "=", "  =\t"};
    return key(name) + kEquals[random_.below(3)] + value +
           (random_.below(5) == 0 ? "  # said \"so\"\n" : "\n");
  }
  static std::string inlined(const std::vector<std::string>& pairs) {
    std::string out = "{ ";
    for (const std::string& pair : pairs) out += (out.size() > 2 ? ", " : "") + pair;
    return out + " }";
  }

  void scene(std::vector<std::string>& top, std::vector<std::string>& sections) {
    const std::string points = integer(values_.points), radius = real(values_.radius),
                      to = real(values_.to_deg), frames = integer(values_.frames);
    const std::string motion = inlined({"to_deg = " + to, key("frames") + "=" + frames});
    const std::string of_scene = line("points", points) + line("radius_m", radius);
    const std::string of_motion = line("frames", frames) + line("to_deg", to);
    switch (random_.below(6)) {
      case 0:
        sections.push_back("[scene]\n" + of_scene + line("motion", motion));
        break;
      case 1:
        sections.push_back("[ scene ]\n" + of_scene);
        sections.push_back("[scene.motion]\n" + of_motion);
        break;
      case 2:
        top.push_back("scene.points = " + points + "\n");
        top.push_back("scene . radius_m = " + radius + "\n");
        top.push_back("scene.'motion'.to_deg = " + to + "\nscene.motion.frames = " + frames + "\n");
        break;
      case 3:
        top.push_back(line("scene", inlined({"motion = " + motion, "points = " + points,
                                             "radius_m = " + radius})));
        break;
      case 4:
        sections.push_back("[scene]\nmotion.to_deg = " + to + "\n" + of_scene +
                           "motion.frames = " + frames + "\n");
        break;
      default:
        sections.push_back("[\"scene\".motion]\n" + of_motion + "[scene]\n" + of_scene);
    }
  }

  void variants(std::vector<std::string>& top, std::vector<std::string>& sections) {
    const std::string segments = integer(values_.segments);
    const std::vector<std::string> exact{"name = " + text("exact"), "method = \"exact\""};
    std::vector<std::string> polygon{"name = " + text("polygon"), "method = 'polygon'",
                                     "role = \"ablation\"", "reference = " + text("exact")};
    if (random_.below(4) == 0) {
      polygon.push_back("options = { segments = " + segments + " }");
      top.push_back("variant = [  # two\n  " + inlined(exact) + ",\n\n  " + inlined(polygon) +
                    ",\n]\n");
      return;
    }
    std::string out = "[[variant]]\n";
    for (const std::string& pair : exact) out += pair + "\n";
    out += some_comment() + "[[ variant ]]\n";
    shuffle(polygon);
    for (const std::string& pair : polygon) out += "  " + pair + "\n";
    constexpr std::array<const char*, 3> kOptions{
        "options.segments = ", "[variant.options]\nsegments = ", "options = { segments = "};
    const std::uint32_t kind = random_.below(3);
    out += kOptions[kind] + segments + (kind == 2 ? " }\n" : "\n");
    sections.push_back(out);
  }

  RandomStream& random_;
  const DiscValues& values_;
};

class LongPerturbedExperiments : public SpecTest {};

TEST_F(LongPerturbedExperiments, AreTheSameExperiment) {
  for (int number = 0; number < perturbed_files(); ++number) {
    SCOPED_TRACE(number);
    RandomStream random(number, "toml");
    DiscValues values;
    values.points = 10 + static_cast<int>(random.below(90));
    values.frames = 2 + static_cast<int>(random.below(5));
    values.segments = 3 + static_cast<int>(random.below(60));
    values.seed = 1 + static_cast<int>(random.below(1000));
    values.radius = (1 + random.below(64)) / 8.0;
    values.to_deg = 1 + random.below(90);
    ExperimentWriter writer(random, values);
    const std::vector<TextForm> forms = text_forms(writer.write());
    const std::string& text = forms[random.below(5)].bytes;
    try {
      const Experiment e = load(text);
      EXPECT_EQ(e.title, "Tom's \"disc\" # 1");
      ASSERT_EQ(e.cases.size(), 1U);
      EXPECT_EQ(e.cases[0].seed, static_cast<unsigned>(values.seed));
      const json scene = json::parse(e.cases[0].scene_json);
      EXPECT_EQ(scene["points"], values.points);
      EXPECT_EQ(scene["radius_m"], values.radius);
      EXPECT_EQ(scene["motion"]["to_deg"], values.to_deg);
      EXPECT_EQ(scene["motion"]["frames"], values.frames);
      ASSERT_EQ(e.cases[0].variants.size(), 2U);
      EXPECT_EQ(e.cases[0].variants[1].role, "ablation");
      EXPECT_EQ(options(e, 0, 1)["segments"], values.segments);
      EXPECT_EQ(e.hash, load(writer.plain()).hash) << "the same run";
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
    if (HasFailure()) FAIL() << text;
  }
}

}  // namespace
}  // namespace geoprior::test
