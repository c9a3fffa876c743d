#include "testbed/runner/journal/run_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "testbed/formats/hdf5/file.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/run_record.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

VariantRecord sample_variant(const std::string& name) {
  VariantRecord variant;
  variant.name = name;
  variant.method = "implicit";
  variant.role = "method";
  variant.options_json = R"({"step": 0.35})";
  variant.status = "failed";
  variant.error = "time 0.5 s: does not converge";
  const std::string place = "/stop_angle_deg=26/" + name + "/";
  variant.frames = {{0.1, {{"frames" + place + "surface_0000.vtp", std::string(64, 'a')}}},
                    {-0.0, {}},
                    {90,
                     {{"frames" + place + "x.vtp", std::string(64, 'b')},
                      {"frames" + place + "y.csv", std::string(64, 'c')}}}};
  variant.metrics["overlap_volume"] = {
      "m^3", "∫max(0, w−1)", "lower_is_better", {kNan, 0.1, 1e-300}};
  variant.summary["overlap_volume.max"] = {0.1, "m^3", "Largest.", "lower_is_better"};
  variant.diagnostics["iterations"] = {"1", "until ∆ < 1e−6", {3, kNan, kInfinity}};
  variant.timing["solve"] = {{0.25, 0.5}, {1, 2}, {3, kNan}};
  variant.timing["a/b 100%"] = {{1.5}};
  variant.events = {{0.5, "crossing", {1, 2, 3}, 0.25, 0.125, {{"l_r_m", 0.1}, {"sample", 7}}},
                    {0.75, "", {0, 0, 0}, 0, 0},
                    {1, "tear", {0, 0, 0}, 0, 0, {{"area_m2", 1e-300}, {"l_r_m", -0.0}}}};
  variant.artifacts = {{"artifacts" + place + "swing.wav", std::string(64, 'd')}};
  return variant;
}

RunRecord sample_record() {
  RunRecord record;
  record.experiment_id = "skinning/knee";
  record.title = "Knee: a “title”";
  record.figure = "3.2";
  record.topic = "skinning";
  record.quick = true;
  record.experiment_toml = std::string(100000, 'x') + "\n[scene]\n";  // past HDF5's 64 KiB limit
  record.spec_hash = std::string(64, '1');
  record.content_sha256 = std::string(64, '2');
  record.frames_sha256 = std::string(64, '4');
  record.metrics_sha256 = std::string(64, '5');
  record.provenance = {{"compiler", "GNU 12.2.0"}, {"git_difference", ""}};
  record.inputs = {{"human.glb", std::string(64, '3')}};
  CaseRecord one;
  one.name = "stop_angle_deg=26";
  one.parameter_name = "angle";
  one.parameter_unit = "deg";
  one.seed = std::numeric_limits<std::uint64_t>::max();
  one.threads = 2;
  one.scene_json = "{}";
  one.swept = {{"variant.implicit.options.stop_angle_deg", "26"}};
  one.facts = {{"vertices", 13380}};
  one.warnings = {"one", "two lines\nof it"};
  one.camera = "target = [0.0, 1.0, 0.0]\n";
  one.variants = {sample_variant("zeta"), sample_variant("alpha")};  // not sorted by name
  one.ratios = {{"zeta", "alpha", 1.5, 1.25, 2, "run"}, {"zeta", "beta", 1, kNan, kNan, "frame"}};
  record.cases = {one, {}};
  record.cases[0].variants[1].memory = MemoryUse{1 << 20, std::uint64_t{5} << 32};
  record.cases[1].name = "default";
  record.studies = {{"growth", "exponent", "timing:solve", 1.02, 0.9, 1.1, {1, 2}, {3, 4}, {}},
                    {"near", "within-spread", "x", kInfinity, 0, 1, {0, 1}, {3, 4}, {5, 5}}};
  record.claims = {{"it holds",
                    "default",
                    "1 <= 2",
                    1,
                    2,
                    true,
                    {"naive", Discrimination::discriminates, 3, 2, "3 <= 2"},
                    "alpha, zeta"},
                   {"it does not", "", "", kNan, 0, false}};
  return record;
}

/// Every field as text: NaN equals NaN, -0 differs from 0.
std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double x : values) {
    char one[40];
    std::snprintf(one, sizeof one, "%a ", std::isnan(x) ? kNan : x);
    text += one;
  }
  return text + "\n";
}

std::string dump(const VariantRecord& v) {
  std::string text =
      v.name + v.method + v.role + v.reference + v.options_json + v.status + v.error + "\n";
  if (v.memory) text += std::to_string(v.memory->start) + " " + std::to_string(v.memory->peak);
  for (const auto& frame : v.frames) {
    text += numbers({frame.parameter});
    for (const auto& file : frame.files) text += file.name + file.sha256 + "\n";
  }
  for (const auto& [name, c] : v.metrics) {
    text += name + c.unit + c.definition + c.direction + numbers(c.values);
  }
  for (const auto& [name, s] : v.summary) {
    text += name + s.unit + s.definition + s.direction + numbers({s.value});
  }
  for (const auto& [name, c] : v.diagnostics) {
    text += name + c.unit + c.definition + numbers(c.values);
  }
  for (const auto& [phase, rows] : v.timing) {
    text += phase;
    for (const auto& row : rows) text += numbers(row);
  }
  for (const auto& e : v.events) {
    text += e.kind + numbers({e.time_s, e.position.x(), e.position.y(), e.position.z(), e.energy_J,
                              e.duration_s});
    for (const auto& [name, x] : e.numbers) text += name + numbers({x});
  }
  for (const auto& file : v.artifacts) text += file.name + file.sha256 + "\n";
  return text;
}

std::string dump(const CaseRecord& c) {
  std::string text = c.name + c.parameter_name + c.parameter_unit + std::to_string(c.seed) + " " +
                     std::to_string(c.threads) + c.scene_json + "\n";
  for (const auto& [key, value] : c.swept) text += key + value + "\n";
  for (const auto& [key, value] : c.facts) text += key + numbers({value});
  for (const auto& warning : c.warnings) text += warning + "\n";
  text += c.camera;
  for (const auto& r : c.ratios)
    text += r.variant + r.of + r.paired + numbers({r.median_ratio, r.low, r.high});
  for (const auto& v : c.variants) text += dump(v);
  return text;
}

std::string dump(const RunRecord& r) {
  std::string text = std::to_string(r.schema_version) + r.experiment_id + r.title + r.figure +
                     r.topic + (r.quick ? "quick" : "full") + r.experiment_toml + r.spec_hash +
                     r.content_sha256 + r.frames_sha256 + r.metrics_sha256 + "\n";
  for (const auto& [key, value] : r.provenance) text += key + "=" + value + "\n";
  for (const auto& file : r.inputs) text += file.name + file.sha256 + "\n";
  for (const auto& c : r.cases) text += dump(c);
  for (const auto& s : r.studies) {
    text += s.name + s.kind + s.quantity + numbers({s.value, s.low, s.high}) + numbers(s.x) +
            numbers(s.y) + numbers(s.y_of);
  }
  for (const auto& c : r.claims) {
    text += c.text + c.case_name + c.detail + numbers({c.left, c.right}) + (c.holds ? "1" : "0");
  }
  return text;
}

class RunFile : public RunTest {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder() / "run.h5"; }
};

TEST_F(RunFile, GivesBackEveryFieldExactly) {
  const RunRecord record = sample_record();
  write_run_file(record, file());
  EXPECT_EQ(dump(read_run_file(file())), dump(record));
}

TEST_F(RunFile, GivesBackAnEmptyRun) {
  RunRecord empty;
  empty.experiment_id = "toy/empty";
  write_run_file(empty, file());
  EXPECT_EQ(dump(read_run_file(file())), dump(empty));
}

TEST_F(RunFile, CutAnywhereIsOneErrorThatNamesTheFile) {
  write_run_file(sample_record(), file());
  const std::string whole = text_of(file());
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{100}, whole.size() / 4, whole.size() / 2, whole.size() - 1}) {
    const auto cut = folder() / "cut.h5";
    std::ofstream(cut, std::ios::binary) << whole.substr(0, size);
    const std::string message = error_of([&] { (void)read_run_file(cut); });
    EXPECT_THAT(message, StartsWith(cut.string())) << size;
    EXPECT_THAT(message, HasSubstr("damaged")) << size;
  }
}

TEST_F(RunFile, MissingPartOfAnHdf5FileIsNamed) {
  const H5File other = H5File::create();
  other.root().write_attribute("schema_version", std::int64_t{1});
  other.save(file());
  const std::string message = error_of([&] { (void)read_run_file(file()); });
  EXPECT_THAT(message, StartsWith(file().string()));
  EXPECT_THAT(message, HasSubstr("quick"));
}

TEST_F(RunFile, OfALaterSchemaIsRefused) {
  RunRecord record;
  record.schema_version = 99;
  write_run_file(record, file());
  EXPECT_THAT(error_of([&] { (void)read_run_file(file()); }), HasSubstr("schema version 99"));
}

TEST_F(RunFile, ThatCannotBeWrittenLeavesNothingBehind) {
  const auto nowhere = folder() / "absent" / "run.h5";
  EXPECT_THAT(error_of([&] { write_run_file({}, nowhere); }), HasSubstr(nowhere.string()));
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

TEST(ContentHash, SeesDataAndMetricsButNotTimes) {
  const RunRecord record = sample_record();
  const std::string hash = content_sha256(record);
  RunRecord timed = record;
  timed.cases[0].variants[0].timing["solve"][0][0] = 7;
  timed.cases[0].threads = 1;
  timed.provenance["cpu"] = "another";
  std::swap(timed.cases[0].variants[0], timed.cases[0].variants[1]);  // order is not content
  EXPECT_EQ(content_sha256(timed), hash);
  RunRecord measured = record;
  measured.cases[0].variants[0].metrics["overlap_volume"].values[1] =
      std::nextafter(0.1, 1.0);  // the last bit
  EXPECT_NE(content_sha256(measured), hash);
  RunRecord drawn = record;
  drawn.cases[0].variants[0].frames[0].files[0].sha256[0] = 'f';
  EXPECT_NE(content_sha256(drawn), hash);
}

TEST(ContentHash, OfTheFramesDoesNotSeeMetricsNorTheOtherWayRound) {
  const RunRecord record = sample_record();
  RunRecord measured = record;
  VariantRecord& of = measured.cases[0].variants[0];
  of.metrics["overlap_volume"].values[1] = std::nextafter(0.1, 1.0);
  of.metrics["new_metric"] = {"1", "", "none", {1, 2, 3}};
  of.summary["new_metric.max"] = {3, "1", "", "none"};
  EXPECT_EQ(frames_sha256(measured), frames_sha256(record));
  EXPECT_NE(metrics_sha256(measured), metrics_sha256(record));
  const auto only_frames_differ = [&](const auto& change) {
    RunRecord other = record;
    change(other.cases[0].variants[0]);
    EXPECT_NE(frames_sha256(other), frames_sha256(record));
    EXPECT_EQ(metrics_sha256(other), metrics_sha256(record));
  };
  only_frames_differ([](VariantRecord& v) { v.frames[0].files[0].sha256[0] = 'f'; });
  only_frames_differ([](VariantRecord& v) { v.frames[1].parameter = 0; });  // was -0
  only_frames_differ([](VariantRecord& v) { v.events[0].numbers["sample"] = 8; });
  only_frames_differ([](VariantRecord& v) { v.artifacts[0].sha256[0] = 'f'; });
}

TEST_F(RunFile, OfBeforeTheContentHashWasSplitGetsItsHalvesFromWhatItHolds) {
  RunRecord record = sample_record();
  record.frames_sha256 = record.metrics_sha256 = "";
  write_run_file(record, file());
  const std::string whole = text_of(file());
  ASSERT_EQ(read_run_file(file()).frames_sha256, "") << "they are read where they are written";
  // Attributes of other names in their place: what such a file has.
  std::string older = whole;
  for (const std::string name : {"frames_sha256", "metrics_sha256"}) {
    const std::size_t at = older.find(name);
    ASSERT_NE(at, std::string::npos);
    older[at] = 'x';
    ASSERT_EQ(older.find(name), std::string::npos) << "once in the file";
  }
  std::ofstream(file(), std::ios::binary) << older;
  const RunRecord read = read_run_file(file());
  EXPECT_EQ(read.frames_sha256, frames_sha256(record));
  EXPECT_EQ(read.metrics_sha256, metrics_sha256(record));
}

}  // namespace
}  // namespace geoprior::test
