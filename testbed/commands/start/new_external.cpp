#include "testbed/commands/start/new_external.h"

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/external/method.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/joined.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

/// Experiments whose small scene a topic begins with, and the variant that stands beside.
const std::map<std::string, std::string>& beginnings() {
  static const std::map<std::string, std::string> of_topic{{"assembly", "assembly/substructures"},
                                                           {"details", "details/options-motion"},
                                                           {"embryo", "embryo/cloaca"},
                                                           {"fluid", "fluid/options-extract"},
                                                           {"grammar", "grammar/imported"},
                                                           {"paper", "paper/options-scene"},
                                                           {"sketch", "sketch/options-flat"},
                                                           {"skinning", "skinning/cylinder-bend"},
                                                           {"sound", "sound/options"},
                                                           {"torus", "torus/zoom"}};
  return of_topic;
}

constexpr const char* kProgramName = "my_method.py";

constexpr const char* kProgram = R"PY(#!/usr/bin/env python3
"""A method of your own. Edit `move`; scene.json says what the scene is, reference/ has the frames of the variant beside.

It is started in a folder of the run, and leaves its frames in out/ (docs/external-methods.md).
"""
import base64
import json
import re
import shutil
import struct
import zlib
from pathlib import Path

import numpy as np

SCENE = json.loads(Path("scene.json").read_text())


def move(part: str, parameter: float, points: np.ndarray) -> np.ndarray:
    """Where the points (n x 3, metres) of a part of the frame at this parameter go."""
    return points


def moved(text: str, part: str) -> str:
    """The text of a .vtp with other points."""
    found = re.search(r"<Points>.*?<DataArray[^>]*>\s*(.*?)\s*<(?:InformationKey|/DataArray)", text, re.DOTALL)
    time = re.search(r'Name="TimeValue"[^>]*>\s*(.*?)\s*</DataArray', text, re.DOTALL)
    if not found or not found[1]:
        return text
    points = numbers(found[1]).reshape(-1, 3)
    if not len(points):
        return text
    points = np.ascontiguousarray(move(part, numbers(time[1])[0], points), dtype="<f8").tobytes()
    packed = zlib.compress(points)
    head = struct.pack("<4I", 1, len(points), 0, len(packed))
    coded = (base64.b64encode(head) + base64.b64encode(packed)).decode()
    return text[: found.start(1)] + coded + text[found.end(1) :]


def numbers(text: str) -> np.ndarray:
    """The doubles of a binary array: base64 of a head, then of blocks of zlib."""
    blocks = struct.unpack("<I", base64.b64decode(text[:8])[:4])[0]
    size = 4 * (3 + blocks)
    coded = 4 * -(-size // 3)
    head = struct.unpack(f"<{3 + blocks}I", base64.b64decode(text[:coded])[:size])
    data, at, bytes_ = base64.b64decode(text[coded:]), 0, b""
    for length in head[3:]:
        bytes_ += zlib.decompress(data[at : at + length])
        at += length
    return np.frombuffer(bytes_, "<f8")


def main() -> None:
    reference, out = Path(SCENE["reference"]["folder"]), Path(SCENE["frames"]["folder"])
    shutil.copytree(reference, out, dirs_exist_ok=True)
    for file in sorted((out / "frames").glob("*.vtp")):
        file.write_text(moved(file.read_text(), file.stem.rsplit("_", 1)[0]))


if __name__ == "__main__":
    main()
)PY";

std::string readme(const std::string& topic, const std::string& base) {
  return "# A method of your own beside those of `" + topic +
         "`\n\n"
         "    geoprior run experiment.toml --allow-commands\n\n"
         "starts `my_method.py` for each case, measures its frames as it measures all, and draws "
         "them beside\n`" +
         base +
         "`. Edit the function `move` of the program; as it stands it returns what the variant "
         "beside makes,\nso that every number is equal. `--allow-commands` is there because an "
         "experiment file can start any program:\nread files of others before you give it.\n\n"
         "`geoprior compare` sets two runs beside each other; `docs/external-methods.md` says what "
         "is in `scene.json`,\nhow frames are written, and what happens to a program that fails.\n";
}

/// Names of files beside the experiment that they come from become those of the files.
void name_files(toml::node& node, const fs::path& folder) {
  if (toml::table* table = node.as_table()) {
    for (auto&& [key, value] : *table) name_files(value, folder);
  } else if (toml::array* array = node.as_array()) {
    for (toml::node& value : *array) name_files(value, folder);
  } else if (toml::value<std::string>* text = node.as_string()) {
    std::error_code ignored;
    const fs::path file = folder / text->get();
    if (!text->get().empty() && fs::is_regular_file(file, ignored)) {
      *text = fs::absolute(file).lexically_normal().string();
    }
  }
}

toml::table variant(const toml::table& first) {
  toml::table base = first;
  base.insert_or_assign("role", "baseline");
  base.erase("reference");
  base.erase("quick");
  return base;
}

/// The small version of an experiment with its first variant and the external one.
toml::table beginning_of(const std::string& id, const std::vector<Topic>& topics,
                         std::string& base_name) {
  LoadRequest load;
  load.quick = true;
  const Experiment from = load_experiment(experiment_file(id), topics, load);
  toml::table all = toml::parse(from.resolved_toml);
  name_files(*all.get("scene"), from.file.parent_path());
  const toml::table base = variant(*all["variant"].as_array()->front().as_table());
  base_name = base["name"].value_or(std::string());
  toml::table mine;
  mine.insert("name", "mine");
  mine.insert("method", kExternalMethod);
  mine.insert("reference", base_name);
  mine.insert("options", toml::table{{"command", toml::array{"python3", kProgramName}}});
  toml::table experiment;
  experiment.insert("title", "A method of my own beside " + base_name);
  experiment.insert("topic", from.topic);
  experiment.insert("seed", 1);
  experiment.insert("scene", *all["scene"].as_table());
  experiment.insert("variant", toml::array{base, mine});
  return experiment;
}

void require_new_folder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return;
  if (!fs::is_directory(folder, ignored) || !fs::is_empty(folder, ignored)) {
    throw Error("is there already", folder.string(), "a new or empty folder (--out)");
  }
}

}  // namespace

int new_command(const CommandContext& context, const NewRequest& request) {
  std::vector<std::string> topics;
  for (const auto& [topic, id] : beginnings()) topics.push_back(topic);
  const auto begin = beginnings().find(request.topic);
  if (begin == beginnings().end()) {
    throw Error("unknown topic '" + request.topic + "'", "new external", joined(topics));
  }
  const fs::path folder = request.out.empty() ? "my-" + request.topic + "-method" : request.out;
  require_new_folder(folder);
  std::string base;
  std::ostringstream experiment;
  experiment << "# " << begin->second << ", made small, and a method from outside.\n\n"
             << beginning_of(begin->second, context.topics, base) << "\n";
  const MadeFolders made(folder);
  write_file_atomically(folder / kProgramName, std::string_view(kProgram));
  write_file_atomically(folder / "experiment.toml", std::string_view(experiment.str()));
  write_file_atomically(folder / "README.md", std::string_view(readme(request.topic, base)));
  say("program     " + (folder / kProgramName).string() + " (edit `move`)");
  say("experiment  " + (folder / "experiment.toml").string());
  say("next        geoprior run " + (folder / "experiment.toml").string() + " --allow-commands");
  if (context.json) print_json({{"folder", folder.string()}, {"beside", base}});
  return done;
}

}  // namespace geoprior
