#include "tests/fuzz/program_input.h"

#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/frame.h"
#include "experiments/fluid/scene/feature_files.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/vtk/files.h"
#include "tests/fuzz/fuzzed_program.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/sample_features.h"
#include "tests/fuzz/sample_layouts.h"
#include "tests/testbed/await.h"
#include "tests/testbed/program_process.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const fs::path kSource = GEOPRIOR_SOURCE_DIR;
constexpr const char* kProgram = GEOPRIOR_PROGRAM;
constexpr const char* kToyProgram = GEOPRIOR_TOY_PROGRAM;

Words run_command(const std::string& experiment) {
  return {"run", experiment, "--no-pictures", "--threads", "1"};
}

/// Experiments of tests/fuzz/home/<topic>, with their data, as files of a home.
Files topic_folder(const std::string& topic) {
  Files files;
  for (const auto& [name, bytes] : read_files(kSource / "tests/fuzz/home" / topic)) {
    files["experiments/" + topic + "/" + name] = bytes;
  }
  return files;
}

/// The experiments of tests/topics/small.
Files small_experiments() { return read_files(kSource / "tests/topics/small"); }

std::string replaced(std::string text, const std::string& word, const std::string& by) {
  return text.replace(text.find(word), word.size(), by);
}

// Inputs of experiments.

/// A file beside an experiment of a topic that names it.
ProgramInput input_of(const std::string& topic, const std::string& experiment,
                      const std::string& file, std::vector<std::string> seeds = {}) {
  ProgramInput input;
  input.home = topic_folder(topic);
  const std::string place = "experiments/" + topic + "/" + file;
  if (seeds.empty()) seeds.push_back(input.home.at(place));
  input.seeds = std::move(seeds);
  input.commands = {{run_command(topic + "/" + experiment), place, kProgram}};
  return input;
}

ProgramInput experiment_input() {
  ProgramInput input;
  for (const auto& [name, text] : small_experiments()) input.seeds.push_back(text);
  for (const char* name : {"blocks.assembly.toml", "drag.gesture.toml", "rules.lua"}) {
    const std::string named = std::string("fuzz/corpus/") + name;  // by those of assembly, grammar
    input.home[named] = read_whole_file(kSource / "tests" / named);
  }
  const std::string file = "experiments/fuzzed/small.toml";
  Words quick = run_command("fuzzed/small");
  quick.emplace_back("--quick");
  for (const Words& words : {run_command("fuzzed/small"), quick, Words{"list", "--claims"}}) {
    input.commands.push_back({words, file, kProgram});
  }
  return input;
}

/// The skinned one first: it is a character by itself.
ProgramInput gltf_input() {
  std::vector<std::string> seeds = corpus(".gltf");
  std::reverse(seeds.begin(), seeds.end());
  return input_of("skinning", "gltf", "character.gltf", seeds);
}

ProgramInput capture_input() {
  return input_of("skinning", "capture", "capture.bvh", corpus(".bvh"));
}

/// Models of parts of which a variation is made.
ProgramInput model_input(const std::string& extension, const std::string& seed) {
  const std::string folder = "experiments/assembly/", model = "model" + extension;
  const std::string text = topic_folder("assembly").at(folder + "model.toml");
  ProgramInput input;
  input.seeds = {seed};
  input.home[folder + "model.toml"] = replaced(text, "MODEL", model);
  const Words vary{"vary", folder + model, "--count", "1", "--out", "results/variations"};
  for (const Words& words : {run_command("assembly/model"), vary})
    input.commands.push_back({words, folder + model, kProgram});
  return input;
}

/// A character whose skeleton file is written.
ProgramInput rig_input(const std::string& file, const std::vector<std::string>& seeds) {
  return {seeds, {}, {{{"rig", file}, file, kProgram}}};
}

/// A drawing that becomes a surface and a pattern, and the corpus of the reader.
ProgramInput views_input() {
  const std::string boot = read_whole_file(kSource / "experiments/sketch/boot.svg");
  std::vector<std::string> seeds{boot, boot, boot};
  for (const std::string& drawing : corpus(".svg")) seeds.push_back(drawing);
  return input_of("sketch", "views", "views.svg", seeds);
}

/// A mesh is the surface of details, or a body in a tank.
ProgramInput mesh_input(const std::string& extension, const std::vector<std::string>& seeds) {
  ProgramInput input;
  input.seeds = seeds;
  const std::string mesh = "mesh" + extension;
  const std::map<std::string, std::string> experiments{{"details", "surface"}, {"fluid", "solid"}};
  for (const auto& [topic, experiment] : experiments) {
    const std::string folder = "experiments/" + topic + "/";
    const std::string file = folder + experiment + ".toml";
    input.home[file] = replaced(topic_folder(topic).at(file), "MESH", mesh);
    input.commands.push_back({run_command(topic + "/" + experiment), folder + mesh, kProgram});
  }
  return input;
}

std::string octahedron_as_vtp() {
  const TriMesh mesh = octahedron();
  Part part;
  part.points = mesh.V;
  part.triangles = mesh.F;
  part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, mesh.V});
  return part_to_vtk_xml(part, 0.5);
}

std::string sample_library() {
  const std::vector<std::byte> bytes = fluid::feature_library_bytes(sample_features());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// An experiment that takes a library and a list of edits; one of them is mutated.
ProgramInput sculpt_input(const std::string& mutated) {
  const std::string library = sample_library();
  ProgramInput input =
      input_of("fluid", "edits", mutated, mutated == "features.h5" ? Words{library} : Words{});
  input.home["experiments/fluid/features.h5"] = library;
  return input;
}

/// An experiment that measures frames of another program; one file of them is mutated.
ProgramInput outside_input(const std::string& topic, const std::string& file) {
  const Files layout = topic == "fluid" ? water_layout() : sheet_layout();
  ProgramInput input = input_of(topic, "outside", "theirs/" + file, {layout.at(file)});
  for (const auto& [name, bytes] : layout) {
    input.home["experiments/" + topic + "/theirs/" + name] = bytes;
  }
  return input;
}

// Inputs that are runs.

/// What draws a report: a home has it.
Files with_scripts(Files home) {
  for (const char* folder : {"results", "results/geoprior_results"}) {
    for (const auto& entry : fs::directory_iterator(kSource / folder)) {
      if (!entry.is_regular_file()) continue;
      home[(folder / entry.path().filename()).string()] = read_whole_file(entry.path());
    }
  }
  return home;
}

// Below the home, which is the working folder.
const std::string kRun = "results/runs/fuzzed";

const Words kRunSmall{"run", "small", "--no-pictures", "--threads", "1", "--out", kRun};
const Words kResume{"run", "small", "--no-pictures", "--threads", "1", "--out", kRun, "--resume"};
const Words kExport{"export", kRun, "--force", "--format", "ply"};
const Words kRender{"render", kRun, "--force"};
const Words kMeasure{"measure", kRun, "--no-pictures"};
const Words kReport{"report", kRun, "--force"};

/// Runs an experiment in a home; `during` sees its folder while it goes on.
void make_run(const ScratchHome& home, const Words& arguments,
              const std::function<void(ProgramProcess&)>& during = {}) {
  ProgramProcess program([&] { return fuzzed_program(home.path(), arguments); }, home.output());
  if (during) during(program);
  const int code = program.wait();
  if (code != 0 && !during) throw Error("the run to be mutated failed: " + arguments.at(1));
}

/// A home with an experiment of tests/topics/small, and a finished run of it in kRun.
Files finished_run(const std::string& experiment) {
  const ScratchHome home(
      {{"experiments/small.toml", small_experiments().at(experiment + ".toml")}});
  make_run(home, kRunSmall);
  return read_files(home.path());
}

/// One of the pendulum without run.h5: to resume it is to read what the journal names, and assemble
/// it.
Files unassembled_run() {
  Files files = finished_run("toy-pendulum");
  files.erase(kRun + "/run.h5");
  return files;
}

bool holds(const fs::path& file, const std::string& word) {
  std::ifstream in(file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  return text.find(word) != std::string::npos;
}

/// A home with a run of the pendulum that was killed after a checkpoint.
Files interrupted_run() {
  const ScratchHome home({{"experiments/small.toml", small_experiments().at("toy-pendulum.toml")}});
  make_run(home, kRunSmall, [&](ProgramProcess& program) {
    const fs::path journal = home.path() / kRun / "journal.jsonl";
    if (!await([&] { return holds(journal, "\"kind\":\"checkpoint\""); }))
      throw Error("the run made no checkpoint");
    program.signal(SIGKILL);
  });
  return read_files(home.path());
}

/// Files of a run whose names end so.
std::vector<std::string> named(const Files& files, const std::string& end) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : files) {
    if (name.starts_with(kRun) && name.ends_with(end)) names.push_back(name);
  }
  if (names.empty()) throw Error("the run has no file", end);
  return names;
}

/// One of the run's files with this ending is mutated, and a command reads it.
ProgramInput run_input(Files home, const std::string& end, const std::vector<Words>& commands) {
  ProgramInput input;
  input.home = std::move(home);
  for (const std::string& file : named(input.home, end)) {
    input.seeds.push_back(input.home.at(file));
    for (const Words& words : commands) input.commands.push_back({words, file, kToyProgram});
  }
  return input;
}

/// A finished run, its reference, and the commands that hold them against each other.
ProgramInput reference_input() {
  const ScratchHome home(
      {{"experiments/toy-circle/small.toml", small_experiments().at("toy-circle.toml")}});
  make_run(home, {"bless", "toy-circle/small", "--reason", "first values"});
  ProgramInput input;
  input.home = read_files(home.path());
  const std::string file = "results/reference/toy-circle/small.txt";
  input.seeds = {input.home.at(file)};
  input.commands = {{{"check", "toy-circle/small"}, file, kToyProgram},
                    {{"bless", "toy-circle/small", "--reason", "again"}, file, kToyProgram}};
  return input;
}

}  // namespace

void PrintTo(const InputKind& kind, std::ostream* out) { *out << kind.name; }

namespace {

/// Frames that other programs made.
std::vector<InputKind> outside_kinds() {
  return {
      {"OutsideFrames", 0.3, [] { return outside_input("fluid", "frames.csv"); }},
      {"OutsideDiagnostics", 0.3, [] { return outside_input("paper", "diagnostics.csv"); }},
      {"OutsideEvents", 0.3, [] { return outside_input("fluid", "events.csv"); }},
      {"OutsideTable", 0.3, [] { return outside_input("fluid", "frames/sea_0000.csv"); }},
      {"OutsideVtp", 0.5, [] { return outside_input("fluid", "frames/surface_0000.vtp"); }},
      {"OutsideGrid", 0.5, [] { return outside_input("fluid", "frames/samples_0000.vti"); }},
      {"OutsidePly", 0.5, [] { return outside_input("fluid", "frames/surface_0001.ply"); }},
      {"OutsideObj", 0.3, [] { return outside_input("fluid", "frames/surface_0002.obj"); }},
      {"OutsideGlb", 0.3, [] { return outside_input("fluid", "frames/surface_0003.glb"); }},
      {"OutsideSheet", 1, [] { return outside_input("paper", "frames/surface_0001.ply"); }},
      {"OutsideHands", 0.3, [] { return outside_input("paper", "frames/handles_0001.ply"); }},
      {"OutsideTears", 0.3, [] { return outside_input("paper", "frames/tears_0001.ply"); }},
  };
}

/// Files that are inputs of experiments or commands, and what runs consist of.
std::vector<InputKind> own_kinds() {
  const auto circle = [] { return finished_run("toy-circle"); };
  const auto pendulum = [] { return finished_run("toy-pendulum"); };
  constexpr double kSlow = 0.1, kSlowest = 0.03;  // VTK draws for a second, Python plots for three
  return {
      {"Experiment", 2, experiment_input},
      {"Skeleton", 1, [] { return input_of("skinning", "poses", "bones.data.toml"); }},
      {"Poses", 1, [] { return input_of("skinning", "poses", "poses.data.toml"); }},
      {"Bvh", 1, capture_input},
      {"Gltf", 1, gltf_input},
      {"Glb", 1,
       [] { return input_of("skinning", "glb", "character.glb", {corpus_file("skinned.glb")}); }},
      {"Rig", 1, [] { return rig_input("rig.glb", {corpus_file("skinned.glb")}); }},
      {"RigOfText", 1, [] { return rig_input("rig.gltf", {corpus(".gltf").back()}); }},
      {"Obj", 1, [] { return mesh_input(".obj", corpus(".obj")); }},
      {"Ply", 1, [] { return mesh_input(".ply", corpus(".ply")); }},
      {"Off", 1, [] { return mesh_input(".off", corpus(".off")); }},
      {"Vtp", 1, [] { return mesh_input(".vtp", {octahedron_as_vtp()}); }},
      {"Collection", 1, [] { return input_of("details", "sequence", "sequence.pvd"); }},
      {"Sidecar", 1, [] { return input_of("details", "sidecar", "numbered_%d.off.json"); }},
      {"Points", 1, [] { return input_of("details", "points", "points.csv"); }},
      {"Drawing", 1, [] { return input_of("paper", "drawing", "drawing.svg"); }},
      {"Views", 1, views_input},
      {"Assembly", 1,
       [] { return model_input(".assembly.toml", corpus_file("blocks.assembly.toml")); }},
      {"AssemblyOfJson", 1, [] { return model_input(".json", corpus_file("blocks.json")); }},
      {"Layout", 1, [] { return model_input(".xtc", corpus_file("siding.xtc")); }},
      {"PartsOfGlb", 1, [] { return model_input(".glb", corpus_file("blocks.glb")); }},
      {"PartsOfGltf", 1,
       [] {
         const std::string file = "experiments/assembly/model.gltf";
         return model_input(".gltf", topic_folder("assembly").at(file));
       }},
      {"Gesture", 1, [] { return input_of("grammar", "pull", "pull.gesture.toml"); }},
      {"Rules", 1, [] { return input_of("grammar", "pull", "pull.rules.lua"); }},
      {"Ontology", 1, [] { return input_of("embryo", "limb", "limb.ttl"); }},
      {"OntologyRules", 1, [] { return input_of("embryo", "limb", "limb.rules"); }},
      {"ExpectedChanges", 1, [] { return input_of("embryo", "limb", "limb.expected.toml"); }},
      {"EditList", 1, [] { return sculpt_input("edits.data.toml"); }},
      {"FeatureLibrary", 1, [] { return sculpt_input("features.h5"); }},
      {"Reference", 1, reference_input},
      {"Journal", 1, [] { return run_input(interrupted_run(), "journal.jsonl", {kResume}); }},
      {"Checkpoint", 0.3, [] { return run_input(interrupted_run(), ".state", {kResume}); }},
      {"JournalOfFinishedRun", 0.3,
       [=] {
         return run_input(circle(), "journal.jsonl", {kExport, kResume});
       }},
      {"RunFile", 2, [=] { return run_input(circle(), "run.h5", {kExport}); }},
      {"RunFileMeasured", 0.3, [=] { return run_input(circle(), "run.h5", {kMeasure}); }},
      {"RunFileDrawn", kSlow, [=] { return run_input(circle(), "run.h5", {kRender}); }},
      {"RunFileReported", kSlowest,
       [=] { return run_input(with_scripts(circle()), "run.h5", {kReport}); }},
      {"Frame", 0.5, [=] { return run_input(circle(), ".vtp", {kExport}); }},
      {"FrameDrawn", kSlow,
       [=] { return run_input(circle(), "default/polygon/surface_0002.vtp", {kRender}); }},
      {"Grid", 0.3, [=] { return run_input(pendulum(), ".vti", {kExport}); }},
      {"Table", 0.3, [] { return run_input(unassembled_run(), ".csv", {kResume}); }},
  };
}

}  // namespace

std::vector<InputKind> input_kinds() {
  std::vector<InputKind> kinds = own_kinds();
  for (InputKind& kind : outside_kinds()) kinds.push_back(std::move(kind));
  return kinds;
}

}  // namespace geoprior::test
