#include "experiments/assembly/scene/inputs.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "experiments/assembly/files/assembly_file.h"
#include "experiments/assembly/files/gltf_parts.h"
#include "experiments/assembly/files/xtrackcad.h"
#include "models/assembly/exchange/embedding.h"
#include "testbed/formats/text/letters.h"

namespace geoprior::assembly {
namespace {

namespace fs = std::filesystem;

/// How far, in m, a motion may miss a part that it is a symmetry of: what files are rounded to.
constexpr double kSymmetryOfFile = 1e-6;
constexpr double kSymmetryOfLayout = 5e-4;
constexpr double kSymmetryOfScene = 1e-4;

bool have_same_ports(const PartType& a, const PartType& b) {
  if (a.ports.size() != b.ports.size()) return false;
  for (std::size_t i = 0; i < a.ports.size(); ++i)
    if (!a.ports[i].frame.isApprox(b.ports[i].frame, kSymmetryOfFile)) return false;
  return true;
}

void add(ReadAssemblies read, ReadAssemblies& into) {
  std::vector<int> number;
  for (PartType& type : read.set.types) {
    auto& types = into.set.types;
    const auto same = std::find_if(types.begin(), types.end(),
                                   [&](const PartType& t) { return t.label == type.label; });
    number.push_back(static_cast<int>(same - types.begin()));
    if (same == types.end())
      types.push_back(std::move(type));
    else if (!have_same_ports(*same, type))
      throw Error("has other ports than in a file before",
                  read.files.front().string() + ": part '" + type.label + "'",
                  "the same ports for one label");
  }
  for (Assembly& model : read.set.models) {
    for (PlacedPart& part : model.parts) part.type = number[part.type];
    into.set.models.push_back(std::move(model));
  }
  into.warnings.insert(into.warnings.end(), read.warnings.begin(), read.warnings.end());
  into.files.insert(into.files.end(), read.files.begin(), read.files.end());
}

void find_missing_symmetries(ReadAssemblies& read, double tolerance) {
  for (PartType& type : read.set.types)
    if (type.symmetries.empty()) type.symmetries = find_symmetries(type, tolerance);
}

}  // namespace

ReadAssemblies read_assemblies(const std::vector<fs::path>& files) {
  ReadAssemblies out;
  std::vector<fs::path> layouts;
  for (const fs::path& file : files) {
    const std::string extension = lower(file.extension().string());
    ReadAssemblies read;
    if (extension == ".xtc") {
      layouts.push_back(file);
      continue;
    }
    if (extension == ".toml" || extension == ".json") {
      read = read_assembly_file(file);
      find_missing_symmetries(read, kSymmetryOfFile);
    } else if (extension == ".glb" || extension == ".gltf") {
      read = read_gltf_parts(file).read;
      find_missing_symmetries(read, kSymmetryOfScene);
    } else {
      throw Error("is no file of assemblies", file.string(), ".toml, .json, .xtc, .glb, .gltf");
    }
    add(std::move(read), out);
  }
  if (!layouts.empty()) {
    ReadAssemblies read = read_xtrackcad(layouts);
    find_missing_symmetries(read, kSymmetryOfLayout);
    add(std::move(read), out);
  }
  require_valid(out.set);
  return out;
}

std::vector<Assembly> cut_pieces(const std::vector<Assembly>& models, const PiecesOptions& options,
                                 std::uint64_t seed) {
  RandomStream random(seed, "pieces");
  const auto draw = [&](std::size_t n) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
  };
  std::vector<Assembly> out;
  constexpr int kTries = 1000;  // in a row: parts that hang on nothing give no piece
  for (int tries = 0; tries < kTries && static_cast<int>(out.size()) < options.count; ++tries) {
    const Assembly& model = models[draw(models.size())];
    const int size = options.least + draw(options.most - options.least + 1);
    std::vector<int> number(model.parts.size(), -1), chosen{draw(model.parts.size())};
    number[chosen.front()] = 0;
    while (static_cast<int>(chosen.size()) < size) {
      std::vector<int> neighbours;
      for (const auto& [a, b] : model.connections)
        if ((number[a.part] < 0) != (number[b.part] < 0))
          neighbours.push_back(number[a.part] < 0 ? a.part : b.part);
      if (neighbours.empty()) break;
      const int next = neighbours[draw(neighbours.size())];
      number[next] = static_cast<int>(chosen.size());
      chosen.push_back(next);
    }
    if (static_cast<int>(chosen.size()) < size) continue;
    tries = 0;
    Assembly& piece = out.emplace_back();
    piece.name = model.name + ", piece " + std::to_string(out.size());
    for (const int part : chosen) piece.parts.push_back(model.parts[part]);
    for (const auto& [a, b] : model.connections)
      if (number[a.part] >= 0 && number[b.part] >= 0)
        piece.connections.push_back({{number[a.part], a.port}, {number[b.part], b.port}});
  }
  if (static_cast<int>(out.size()) < options.count)
    throw Error("no model has " + std::to_string(options.least) + " parts that hang together",
                "scene.pieces.least");
  return out;
}

}  // namespace geoprior::assembly
