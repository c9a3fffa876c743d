#include "tests/topics/named_files.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>

#include "testbed/formats/wav_file.h"
#include "testbed/topic.h"
#include "tests/embryo/ontology/small_ontology.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/program_process.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

std::string text_of_bytes(const std::vector<std::byte>& bytes) {
  std::string text(bytes.size(), '\0');
  std::memcpy(text.data(), bytes.data(), bytes.size());
  return text;
}

void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// A closed box from the origin, as OBJ.
std::string box(double x, double y, double z) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string((i & 1) != 0 ? x : 0) + " " +
            std::to_string((i & 2) != 0 ? y : 0) + " " + std::to_string((i & 4) != 0 ? z : 0) +
            "\n";
  }
  return text +
         "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\n"
         "f 1 7 3\nf 2 4 8\nf 2 8 6\n";
}

auto writes(const std::string& name, std::function<std::string(bool changed)> text) {
  return [=](const fs::path& folder, bool changed) { write_text(folder / name, text(changed)); };
}

/// A square plate of a grid of vertices at height `z`, as OBJ with its pattern as texture.
std::string plate(double side, double z, int cells, double shift = 0) {
  std::string text;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double u = side * (static_cast<double>(i) / cells - 0.5),
                   v = side * (static_cast<double>(j) / cells - 0.5);
      const double wave = z * std::sin(std::numbers::pi * (u + shift) / side);
      text += "v " + std::to_string(u) + " " + std::to_string(v) + " " + std::to_string(wave) +
              "\nvt " + std::to_string(u) + " " + std::to_string(v) + "\n";
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i + 1, b = a + cells + 1;
      const auto corner = [](int k) { return " " + std::to_string(k) + "/" + std::to_string(k); };
      text += "f" + corner(a) + corner(a + 1) + corner(b + 1) + "\nf" + corner(a) + corner(b + 1) +
              corner(b) + "\n";
    }
  }
  return text;
}

void write_frames(const fs::path& folder, bool changed) {
  for (int i = 0; i < 3; ++i) {
    const double z = 0.02 * i + (changed && i == 2 ? 0.005 : 0);
    write_text(folder / ("wave_" + std::to_string(i) + ".obj"), plate(0.2, z, 6));
  }
}
const std::vector<std::string> kFrames{"wave_0.obj", "wave_1.obj", "wave_2.obj"};

void add_details(std::map<std::string, NamedFile>& files) {
  const std::string plane = "surface = { kind = \"plane\", width = 1, height = 1, edge = 0.2 }\n",
                    few = "pattern = { kind = \"poisson-disk\", count = 12 }\n",
                    two = "motion = { frames = 2 }\n";
  files["details surface.file"] = {
      writes("plate.obj", [](bool changed) { return plate(1, changed ? 0.2 : 0.1, 6); }),
      "surface = { kind = \"file\", file = \"plate.obj\" }\n" + few + two,
      {"plate.obj"},
      "naive-stretch"};
  files["details pattern.file"] = {
      writes("places.csv",
             [](bool changed) {
               return std::string("x,y,z\n0.1,0.1,0\n-0.2,0.3,0\n0.3,") +
                      (changed ? "-0.3" : "-0.2") + ",0\n-0.3,-0.3,0\n";
             }),
      plane + "pattern = { kind = \"file\", file = \"places.csv\" }\n" + two,
      {"places.csv"},
      "naive-stretch"};
  files["details drawing.file"] = {
      writes("stud.obj", [](bool changed) { return box(1, 1, changed ? 2 : 1); }),
      plane + few + two +
          "drawing = { parameters = [1], look = { kind = \"mesh\", instance = { shape = "
          "\"given\" } }, file = \"stud.obj\" }\n",
      {"stud.obj"},
      "naive-stretch"};
  files["details motion.sequence.path"] = {
      write_frames,
      "surface = { kind = \"sequence\" }\nmotion = { sequence = { path = \"wave_%d.obj\" } }\n" +
          few,
      kFrames, "naive-stretch"};
}

void add_fluid(std::map<std::string, NamedFile>& files) {
  const std::string tank =
      "duration = 0.04\nframe_interval = 0.04\ntank = { size = [1, 1, 1], cell = 0.125, ";
  const std::string body =
      "shape = { kind = \"mesh\", file = \"body.obj\", centre = [0.3, 0.3, "
      "0.1] }";
  const auto solid =
      writes("body.obj", [](bool changed) { return box(0.4, changed ? 0.5 : 0.4, 0.4); });
  const std::vector<std::string> read{"body.obj"};
  files["fluid tank.volumes[].shape.file"] = {solid, tank + "volumes = [{ " + body + " }] }\n",
                                              read, "liquid"};
  files["fluid tank.sources[].shape.file"] = {
      solid, tank + "sources = [{ " + body + ", until = 1, velocity = [0, 0, -1] }] }\n", read,
      "liquid"};
  files["fluid tank.solids[].shape.file"] = {
      solid,
      tank +
          "volumes = [{ shape = { centre = [0.5, 0.5, 0.25], size = [1, 1, 0.5] } }], solids = "
          "[{ " +
          body + " }] }\n",
      read, "liquid"};
  const std::string injected =
      "duration = 0.08\ninjected = { bumps = 1, rings = 0, drops = 0, crossings = 0, frames = 4, "
      "cell = 0.05 }\n";
  files["fluid target.file"] = {
      writes("bed.obj", [](bool changed) { return plate(4, changed ? 0.02 : 0.01, 80); }),
      injected +
          "target = { kind = \"mesh\", file = \"bed.obj\" }\nedits = [{ name = \"a\", "
          "source = \"injected\" }]\n",
      {"bed.obj"},
      "sculpt",
      "extraction.map.texel = 2"};
  files["fluid target.path"] = {
      [](const fs::path& folder, bool changed) {
        for (int i = 0; i < 3; ++i)
          write_text(folder / ("wave_" + std::to_string(i) + ".obj"),
                     plate(4, changed ? 0.02 : 0.01, 80));
      },
      injected +
          "target = { kind = \"sequence\", path = \"wave_%d.obj\" }\nedits = [{ name = "
          "\"a\", source = \"injected\" }]\n",
      kFrames, "sculpt", "extraction.map.texel = 2"};
  files["fluid sequences[].path"] = {write_frames,
                                     "sequences = [{ name = \"mine\", path = \"wave_%d.obj\" }]\n",
                                     kFrames, "extract"};
}

/// Features that were lifted out of an animation, stored by the program.
void write_library(const fs::path& folder, bool changed) {
  const fs::path file = folder / "lift.toml", out = folder / "lifted";
  write_text(
      file,
      std::string("title = \"Features\"\ntopic = \"fluid\"\n[scene]\ninjected = { bumps = ") +
          (changed ? "2" : "1") +
          ", rings = 0, drops = 0, crossings = 0, frames = 4, cell = 0.05 }\n[[variant]]\nname = "
          "\"v\"\nmethod = \"extract\"\noptions = { lift = true, extraction = { map = { "
          "texel = 2 } } }\n");
  fs::remove_all(out);
  ProgramProcess program(
      [&] {
        return run_as_program({"run", file.string(), "--no-pictures", "--out", out.string()},
                              all_topics());
      },
      folder / "lift.log");
  program.wait();
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    if (entry.path().filename() == "features.h5")
      fs::copy_file(entry.path(), folder / "mine.h5", fs::copy_options::overwrite_existing);
  }
}

void add_edits(std::map<std::string, NamedFile>& files) {
  const std::string pasted =
      "duration = 0.08\ninjected = { bumps = 1, rings = 0, drops = 0, crossings = 0, frames = 4, "
      "cell = 0.05 "
      "}\ntarget = { kind "
      "= "
      "\"injected\" }\n";
  files["fluid libraries[].path"] = {
      write_library,
      pasted +
          "libraries = [{ name = \"stored\", path = \"mine.h5\" }]\nedits = [{ name = \"a\", "
          "source = \"stored\" }]\n",
      {"mine.h5"},
      "sculpt"};
  files["fluid edit_list"] = {
      writes("edits.toml",
             [](bool changed) {
               return std::string("[[edit]]\nname = \"a\"\nsource = \"injected\"\nscale = ") +
                      (changed ? "[1.5, 1, 1]" : "[1.25, 1, 1]") + "\n";
             }),
      pasted + "edit_list = \"edits.toml\"\n",
      {"edits.toml"},
      "sculpt",
      "extraction.map.texel = 2"};
}

void add_paper_and_sound(std::map<std::string, NamedFile>& files) {
  const auto pattern = writes("cut.svg", [](bool changed) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" height=\"200mm\" viewBox=\"0 "
           "0 200 200\"><rect id=\"p\" x=\"0\" y=\"0\" width=\"" +
           std::string(changed ? "180" : "200") + "\" height=\"200\"/></svg>\n";
  });
  const std::string svg =
      "pattern = { kind = \"svg\", file = \"cut.svg\", path = \"p\", unit = \"page\" }\n";
  files["paper pattern.file"] = {pattern,
                                 svg +
                                     "gravity = [0, 0, 0]\nimperfection = 0\nduration = 0.01\n"
                                     "frame_interval = 0.01\nsubsteps = 1\n",
                                 {"cut.svg"},
                                 "dense",
                                 "triangles = 60"};
  const std::string frames = "animation = { path = \"wave_%d.obj\", frames_per_second = 50 }\n",
                    square = "pattern = { kind = \"rectangle\", width = 0.2, height = 0.2 }\n";
  files["sound pattern.file"] = {[pattern](const fs::path& folder, bool changed) {
                                   pattern(folder, changed);
                                   for (int i = 0; i < 3; ++i)
                                     write_text(folder / ("wave_" + std::to_string(i) + ".obj"),
                                                plate(0.2, 0.02 * i, 6));
                                 },
                                 svg + frames,
                                 {"cut.svg"},
                                 "clicks",
                                 "",
                                 "is of another sheet"};
  files["sound animation.path"] = {write_frames, square + frames, kFrames, "clicks"};
  files["sound others[].path"] = {
      write_frames, square + frames + "others = [{ name = \"same\", path = \"wave_%d.obj\" }]\n",
      kFrames, "clicks", "animation = \"same\""};
  files["sound bank"] = {[](const fs::path& folder, bool changed) {
                           const auto tone = [](double cycles) {
                             Sound sound;
                             sound.sample_rate = 48000;
                             sound.samples.resize(4800, 1);
                             for (Eigen::Index i = 0; i < 4800; ++i) {
                               const double t = static_cast<double>(i) / 4800;
                               sound.samples(i, 0) =
                                   0.5 * (1 - t) * std::sin(2 * std::numbers::pi * cycles * t);
                             }
                             return text_of_bytes(wav_bytes(sound));
                           };
                           write_text(folder / "bank" / "a.wav", tone(changed ? 90 : 60));
                           write_text(folder / "bank" / "b.wav", tone(40));
                           write_text(folder / "bank" / "bank.csv",
                                      "file,kind,l_r,l_c,speed\na.wav,flap,0.03,0.06,0.1\n"
                                      "b.wav,friction,0.03,0.06,0.1\n");
                         },
                         "swatches = { rulings = [0.03], widths = [0.03] }\nbank = \"bank\"\n",
                         {"bank/bank.csv", "bank/a.wav", "bank/b.wav"},
                         "sound"};
}

/// The square of a knee, or the same a little wider.
void write_square(const fs::path& folder, bool changed) {
  GltfSample sample = skinned_square();
  if (changed) sample.binary[3] = std::byte{0xBF};  // the first coordinate
  write_text(folder / "my.glb", text_of_bytes(sample.bytes()));
}

void add_skinning_and_sketch(std::map<std::string, NamedFile>& files) {
  files["sketch drawing"] = {[](const fs::path& folder, bool changed) {
                               const fs::path drawings = GEOPRIOR_SOURCE_DIR "/experiments/sketch";
                               fs::copy_file(drawings / (changed ? "tunic.svg" : "boot.svg"),
                                             folder / "mine.svg",
                                             fs::copy_options::overwrite_existing);
                             },
                             "drawing = \"mine.svg\"\nhull = { triangles = 300 }\n",
                             {"mine.svg"},
                             "visual-hull"};
  files["sketch photo"] = {
      [](const fs::path& folder, bool changed) {
        const fs::path drawings = GEOPRIOR_SOURCE_DIR "/experiments/sketch";
        for (const char* name : {"bag.svg", "bag.png"}) {
          fs::copy_file(drawings / name, folder / name, fs::copy_options::overwrite_existing);
        }
        fs::copy_file(drawings / (changed ? "tent.png" : "bag.png"), folder / "mine.png",
                      fs::copy_options::overwrite_existing);
      },
      "drawing = \"bag.svg\"\nphoto = \"mine.png\"\n",
      {"mine.png"},
      "one-view",
      {},
      "does not fit the drawing"};
  files["sketch surface"] = {
      writes("mine.obj", [](bool changed) { return plate(1, changed ? 0.3 : 0.2, 8); }),
      "surface = \"mine.obj\"\n",
      {"mine.obj"},
      "gauss-thinning",
      "iterations = 2"};
  const std::string character = "character = \"my.glb\"\nregions = [\"hip\"]\n",
                    turn =
                        "motion = { joint = \"knee\", axis = \"+z\", to_deg = 60, frames = 2 "
                        "}\n";
  files["skinning character"] = {write_square, character + turn, {"my.glb"}, "linear-blend"};
  files["skinning skeleton"] = {
      [](const fs::path& folder, bool changed) {
        write_square(folder, false);
        write_text(folder / "my.skeleton.toml",
                   std::string("[joint.hip]\nhead = [0, 0, 0]\n[joint.knee]\nparent = \"hip\"\n"
                               "head = [0, 1, 0]\naxes = { bend = \"") +
                       (changed ? "-z" : "+z") + "\" }\n");
      },
      character +
          "skeleton = \"my.skeleton.toml\"\nmotion = { joint = \"knee\", axis = \"bend\", "
          "to_deg = 60, frames = 2 }\n",
      {"my.glb", "my.skeleton.toml"},
      "linear-blend"};
  files["skinning motion.file"] = {
      [](const fs::path& folder, bool changed) {
        write_square(folder, false);
        write_text(folder / "my.poses.toml", std::string("[pose.bent]\nknee = { \"+z\" = ") +
                                                 (changed ? "50" : "40") + " }\n");
      },
      character + "motion = { kind = \"poses\", file = \"my.poses.toml\" }\n",
      {"my.glb", "my.poses.toml"},
      "linear-blend"};
}

void add_assembly(std::map<std::string, NamedFile>& files) {
  files["assembly inputs"] = {
      writes(
          "mine.assembly.toml",
          [](bool changed) {
            return std::string(
                       "[[part]]\nlabel = \"bar\"\nports = [{ name = \"a\", at = [0, 0, 0], "
                       "out = [-1, 0, 0] }, { name = \"b\", at = [0.1, 0, 0], out = [1, 0, 0] "
                       "}]\nsolids = [{ kind = \"box\", at = [0.05, 0, 0], size = [0.1, 0.02, ") +
                   (changed ? "0.03" : "0.02") +
                   "] }]\n[[model]]\nname = \"m\"\nparts = [{ id = \"p\", part = \"bar\" }, { "
                   "id = \"q\", part = \"bar\" }]\njoints = [\"p.b q.a\"]\n";
          }),
      "inputs = [\"mine.assembly.toml\"]\n",
      {"mine.assembly.toml"},
      "exact",
      "count = 1"};
}

void add_grammar(std::map<std::string, NamedFile>& files) {
  const auto stroke = writes("mine.gesture.toml", [](bool changed) {
    return std::string("[[stroke]]\nkind = \"grab\"\npath_x = [0.5, ") + (changed ? "0.6" : "0.7") +
           "]\npath_y = [0, 0]\npath_z = [0, 0.1]\nradius = 1\n";
  });
  const std::string pulled =
      "object = \"arm\"\ngesture = { file = \"mine.gesture.toml\", steps = 1 }\n";
  files["grammar gesture.file"] = {stroke, pulled, {"mine.gesture.toml"}, "free-form"};
  files["grammar rules"] = {
      [stroke](const fs::path& folder, bool changed) {
        stroke(folder, false);
        write_text(
            folder / "mine.lua",
            std::string("rule{ name = \"along z\", type = \"arm\", phase = \"down\", apply = "
                        "function(b) b:set_position(1, 0, 0, ") +
                (changed ? "0.2" : "0.1") + ") end }\n");
      },
      pulled + "rules = \"mine.lua\"\n",
      {"mine.lua"},
      "grammar",
      "rules = \"script\""};
  files["grammar imported.file"] = {write_square,
                                    "object = \"imported\"\nimported = { file = \"my.glb\" }\n",
                                    {"my.glb"},
                                    "nothing"};
}

const std::string kEmbryoRules =
    "upto(S, S) :- stage(S).\nupto(S, T) :- upto(S, R), next(R, T).\n"
    "exists(E, S) :- existsFrom(E, A), existsUntil(E, B), upto(A, S), upto(S, B), not "
    "absent(E).\n"
    "absent(E) :- selected(D), disables(D, P), actsOn(P, E), disables(D, E).\n"
    "inactive(P) :- selected(D), disables(D, P).\n";

const std::string kEmbryoScene =
    "ontology = \"mine.ttl\"\nrules = \"mine.rules\"\nparameter_set = \"Slow\"\ndays = [15, 19]\n";

void write_ontology(const fs::path& folder, bool changed) {
  std::string text = embryo::test::small_ontology();
  const std::string radii = "e:radii (0.2 0.2 0.4)";
  if (changed) text.replace(text.find(radii), radii.size(), "e:radii (0.2 0.2 0.5)");
  write_text(folder / "mine.ttl", text);
}

/// What the scene names.
void write_embryo(const fs::path& folder) {
  write_ontology(folder, false);
  write_text(folder / "mine.rules", kEmbryoRules);
}

void add_embryo(std::map<std::string, NamedFile>& files) {
  files["embryo ontology"] = {[](const fs::path& folder, bool changed) {
                                write_embryo(folder);
                                write_ontology(folder, changed);
                              },
                              kEmbryoScene,
                              {"mine.ttl"},
                              "development"};
  files["embryo rules"] = {[](const fs::path& folder, bool changed) {
                             write_embryo(folder);
                             if (changed)
                               write_text(folder / "mine.rules",
                                          kEmbryoRules +
                                              "absent(E) :- type(E, e:EmbryologicalEntity), "
                                              "mirrorOf(E, _).\n");
                           },
                           kEmbryoScene,
                           {"mine.rules"},
                           "development"};
  files["embryo additions"] = {
      [](const fs::path& folder, bool changed) {
        write_embryo(folder);
        write_text(folder / "more.ttl",
                   std::string("@prefix e: <urn:geoprior:embryo#> .\n"
                               "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n"
                               "e:Bud a e:EmbryologicalEntity ; rdfs:label \"bud\" ; e:side "
                               "\"median\" ; e:kind \"bud\" ; e:existsFrom e:S2 ; e:existsUntil "
                               "e:S3 .\ne:BudS2 a e:SpatioTemporalEntity ; e:of e:Bud ; e:during "
                               "e:S2 ; e:geometry [ a e:Ovoid ; e:position (0 0.3 0) ; e:axis (0 0 "
                               "1) ; e:up (1 0 0) ; e:radii (0.1 0.1 ") +
                       (changed ? "0.2" : "0.3") + ") ; e:unit \"mm\" ; e:source e:Drawn ] .\n");
      },
      kEmbryoScene + "additions = [\"more.ttl\"]\n",
      {"more.ttl"},
      "development"};
}

void add_embryo_questions(std::map<std::string, NamedFile>& files) {
  files["embryo queries"] = {
      [](const fs::path& folder, bool changed) {
        write_embryo(folder);
        for (int q = 1; q <= 8; ++q)
          write_text(folder / "asked" / ("q" + std::to_string(q) + ".rq"),
                     "PREFIX e: <urn:geoprior:embryo#>\nSELECT ?x WHERE { ?x "
                     "a e:" +
                         std::string(changed ? "Disease" : "TemporalEntity") + " }\n");
      },
      kEmbryoScene + "queries = \"asked\"\n",
      {"asked/q1.rq"},
      "sparql"};
  files["embryo expected"] = {
      [](const fs::path& folder, bool changed) {
        write_embryo(folder);
        write_text(folder / "mine.toml", std::string("[Horseshoe]\n") +
                                             (changed ? "absnt" : "absent") + " = [\"Kidney\"]\n");
      },
      kEmbryoScene + "disease = \"Horseshoe\"\nexpected = \"mine.toml\"\n",
      {"mine.toml"},
      "development",
      {},
      "absnt"};
}

}  // namespace

const std::map<std::string, NamedFile>& named_files() {
  static const std::map<std::string, NamedFile> files = [] {
    std::map<std::string, NamedFile> made;
    add_details(made);
    add_fluid(made);
    add_edits(made);
    add_paper_and_sound(made);
    add_skinning_and_sketch(made);
    add_assembly(made);
    add_grammar(made);
    add_embryo(made);
    add_embryo_questions(made);
    return made;
  }();
  return files;
}

}  // namespace geoprior::test
