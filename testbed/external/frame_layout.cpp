#include "testbed/external/frame_layout.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "core/error.h"
#include "testbed/external/part_file.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/sequence/find.h"
#include "testbed/formats/text/csv_table.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/runner/journal/event_table.h"
#include "testbed/runner/journal/frame_files.h"
#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/names.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/quantity.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using Entry = ExternalFrames::Entry;

constexpr std::size_t kMostFrames = 1'000'000;

// Files and folders of the layout.
constexpr const char* kParameters = "frames.csv";
constexpr const char* kDiagnostics = "diagnostics.csv";
constexpr const char* kEvents = "events.csv";
constexpr const char* kFrames = "frames";
constexpr const char* kArtifacts = "artifacts";

/// Whether the option means numbered files, not a folder.
bool is_pattern(const ExternalOptions& options) {
  return options.frames.find('%') != std::string::npos;
}

/// Also where it is a link that leads nowhere.
bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() != fs::file_type::not_found;
}

/// What a program left lies in its folder; files may be anywhere.
fs::path path_of_frames(const ExternalOptions& options, const fs::path& base) {
  return options.command.empty() ? (base / options.frames).lexically_normal()
                                 : path_below(base, options.frames);
}

/// Number of a frame in a column.
std::size_t index_of(const CsvTable& table, const CsvTable::Row& row, const char* column) {
  const double x = *table.number(row, column);
  if (x < 0 || x != std::floor(x) || x >= static_cast<double>(kMostFrames)) {
    throw Error("'" + number_text(x) + "' is no number of a frame", row.place, "0, 1, 2 …");
  }
  return static_cast<std::size_t>(x);
}

/// Parameters by frames.csv; rows may stand in any order.
std::vector<double> parameters_of_file(const fs::path& file) {
  const CsvTable table(file, {"frame", "parameter"}, {});
  std::vector<std::optional<double>> at(table.rows().size());
  for (const CsvTable::Row& row : table.rows()) {
    const std::size_t frame = index_of(table, row, "frame");
    if (frame >= at.size()) {
      throw Error("frame " + std::to_string(frame) + " in a list of " + std::to_string(at.size()),
                  row.place, "every frame from 0 on, without gaps");
    }
    if (at[frame]) throw Error("frame " + std::to_string(frame) + " is there twice", row.place);
    at[frame] = table.number(row, "parameter");
  }
  std::vector<double> parameters;
  for (const std::optional<double>& parameter : at) parameters.push_back(*parameter);
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    if (parameters[i] > parameters[i - 1]) continue;
    throw Error("parameters do not increase: frame " + std::to_string(i) + " is at " +
                    number_text(parameters[i]) + ", the one before at " +
                    number_text(parameters[i - 1]),
                file.string());
  }
  return parameters;
}

/// "surface" and 12 of "surface_0012.vtp".
struct PieceName {
  std::string name;
  std::size_t frame = 0;
};

PieceName piece_name(const fs::path& file) {
  const std::string name = part_of_file(file);
  require_name(name, "a part or table", file.string());
  const std::string digits = file.stem().string().substr(name.size() + 1);
  PieceName piece{name, 0};
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), piece.frame);
  if (error != std::errc() || end != digits.data() + digits.size() || piece.frame >= kMostFrames) {
    throw Error("'" + digits + "' is no number of a frame", file.string(),
                "<part>_0000" + file.extension().string());
  }
  return piece;
}

/// Whether a file is a part or a table of a frame, by its name.
bool is_piece(const fs::path& file) {
  const std::string name = file.filename().string(), extension = file.extension().string();
  std::error_code ignored;
  if (name.starts_with('.') || fs::is_directory(file, ignored)) return false;
  if (name == kParameters || name == kEvents || name == kDiagnostics) return false;
  return extension == ".csv" || is_part_extension(extension);
}

/// Folder of the pieces in a folder of the layout.
fs::path room_of_frames(const fs::path& root) {
  std::error_code ignored;
  return fs::is_directory(root / kFrames, ignored) ? path_below(root, kFrames) : root;
}

void read_pieces(const fs::path& folder, ExternalFrames& found) {
  for (const fs::path& file : sorted_entries(folder)) {
    if (!is_piece(file)) continue;
    const PieceName piece = piece_name(file);
    if (piece.frame >= found.frames.size()) found.frames.resize(piece.frame + 1);
    auto& pieces = found.frames[piece.frame].pieces;
    for (const ExternalFrames::Piece& other : pieces) {
      // A part and a table of a frame may have one name.
      const bool alike = (other.file.extension() == ".csv") == (file.extension() == ".csv");
      if (other.name != piece.name || !alike) continue;
      throw Error("'" + piece.name + "' of frame " + std::to_string(piece.frame) +
                      " is there twice: " + other.file.filename().string(),
                  file.string());
    }
    pieces.push_back({piece.name, path_below(folder, file.filename())});
  }
}

/// Numbers may begin anywhere and go in steps, but none is left out.
void require_even_numbers(const std::vector<FoundFile>& files) {
  for (std::size_t i = 2; i < files.size(); ++i) {
    const int step = files[1].number - files[0].number;
    if (files[i].number == files[i - 1].number + step) continue;
    throw Error(
        "follows " + files[i - 1].file.filename().string() + ": files are missing between them",
        files[i].file.string(), "numbers in even steps, as those before");
  }
}

void read_pattern(const fs::path& pattern, const std::string& part, ExternalFrames& found) {
  if (!is_part_extension(pattern.extension().string())) {
    throw Error("unknown extension '" + pattern.extension().string() + "'", pattern.string(),
                part_extensions());
  }
  const std::vector<FoundFile> files = find_numbered(pattern).files;
  require_even_numbers(files);
  for (const FoundFile& one : files) {
    const fs::path file = path_below(pattern.parent_path(), one.file.filename());
    found.frames.push_back({{}, {{part, file}}, {}});
  }
}

void read_diagnostics(const fs::path& file, ExternalFrames& found) {
  const CsvTable table(file, {"frame"}, {}, CsvTable::Others::read);
  std::set<std::size_t> seen;
  for (const CsvTable::Row& row : table.rows()) {
    const std::size_t frame = index_of(table, row, "frame");
    if (frame >= found.frames.size()) {
      throw Error("there is no frame " + std::to_string(frame), row.place,
                  "0 to " + std::to_string(found.frames.size() - 1));
    }
    if (!seen.insert(frame).second) {
      throw Error("frame " + std::to_string(frame) + " is there twice", row.place);
    }
    for (const std::string& name : table.others()) {
      require_plain_name(name, "a diagnostic", file.string());
      if (const auto value = table.number(row, name)) {
        found.frames[frame].diagnostics[name] = *value;
      }
    }
  }
}

std::vector<Event> read_events_csv(const fs::path& file) {
  const CsvTable table(file, {"time_s", "kind", "x", "y", "z", "energy_J", "duration_s"}, {},
                       CsvTable::Others::read);
  std::vector<Event> events;
  for (const CsvTable::Row& row : table.rows()) {
    const auto number = [&](const char* column) { return *table.number(row, column); };
    Event event;
    event.time_s = number("time_s");
    event.kind = *table.text(row, "kind");
    event.position = {number("x"), number("y"), number("z")};
    event.energy_J = number("energy_J");
    event.duration_s = number("duration_s");
    for (const std::string& name : table.others()) {
      if (const auto value = table.number(row, name)) event.numbers[name] = *value;
    }
    require_event_numbers(event, row.place);
    events.push_back(std::move(event));
  }
  return events;
}

void require_no_gaps(const ExternalFrames& found) {
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    if (!found.frames[i].pieces.empty()) continue;
    throw Error(
        "has no file of frame " + std::to_string(i) + " of " + std::to_string(found.frames.size()),
        found.root.string(), "<part>_" + stem_of_part("", i).substr(1) + ".vtp …");
  }
  if (found.frames.empty()) {
    throw Error("has no frames", found.root.string(),
                "<part>_0000 with one of " + part_extensions());
  }
}

void set_parameters(const std::vector<double>& parameters, const std::string& where,
                    ExternalFrames& found) {
  if (parameters.size() != found.frames.size()) {
    throw Error(std::to_string(found.frames.size()) + " frames, but " +
                    std::to_string(parameters.size()) + " parameters in " + where,
                found.root.string());
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) found.frames[i].parameter = parameters[i];
}

void require_parameters_of_scene(const Scene& scene, const ExternalFrames& found) {
  const std::vector<double> wanted = scene.parameters();
  if (wanted.empty()) return;
  if (found.frames.size() != wanted.size()) {
    throw Error(std::to_string(found.frames.size()) + " frames, but the scene has " +
                    std::to_string(wanted.size()) + " (" + scene.parameter_name() + " " +
                    number_text(wanted.front()) + " to " + number_text(wanted.back()) + " " +
                    scene.parameter_unit() + ")",
                found.root.string());
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!found.frames[i].parameter || same_parameter(*found.frames[i].parameter, wanted[i])) {
      continue;
    }
    throw Error("frame " + std::to_string(i) + " is at " + scene.parameter_name() + " " +
                    number_text(*found.frames[i].parameter) + ", that of the scene at " +
                    number_text(wanted[i]) + " " + scene.parameter_unit() +
                    ": are these frames of another case?",
                found.root.string());
  }
}

void find_parameters(const ExternalOptions& options, const fs::path& folder, const Scene& scene,
                     ExternalFrames& found) {
  if (!options.parameters.empty()) {
    set_parameters(options.parameters, "the option parameters", found);
  } else if (is_there(folder / kParameters)) {
    const fs::path file = path_below(folder, kParameters);
    set_parameters(parameters_of_file(file), file.string(), found);
  }
  require_parameters_of_scene(scene, found);
  if (found.frames.front().parameter) return;
  const std::vector<double> parameters = scene.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) found.frames[i].parameter = parameters[i];
}

/// Of a folder of the layout.
ExternalFrames find_in_layout(const ExternalOptions& options, const fs::path& root,
                              const Scene& scene) {
  ExternalFrames found;
  found.root = root;
  read_pieces(room_of_frames(root), found);
  require_no_gaps(found);
  find_parameters(options, root, scene, found);
  if (is_there(root / kDiagnostics)) {
    read_diagnostics(path_below(root, kDiagnostics), found);
  }
  if (is_there(root / kEvents)) {
    found.events = read_events_csv(path_below(root, kEvents));
  }
  for (const fs::path& file : sorted_entries(root / kArtifacts)) {
    const std::string name = file.filename().string();
    require_name(name, "an artifact", file.string());
    found.artifacts.push_back({name, path_below(root, fs::path(kArtifacts) / name)});
  }
  return found;
}

/// Names that any of the maps has, in order.
template <class Rows, class Map>
std::set<std::string> names_of(const Rows& rows, Map map_of) {
  std::set<std::string> names;
  for (const auto& row : rows) {
    for (const auto& [name, value] : map_of(row)) names.insert(name);
  }
  return names;
}

std::string cells_of(const std::map<std::string, double>& values,
                     const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    const auto found = values.find(name);
    text += "," + (found == values.end() ? "" : number_text(found->second));
  }
  return text;
}

std::string frames_csv(const std::vector<double>& parameters) {
  std::string text = "frame,parameter\n";
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    text += std::to_string(i) + "," + number_text(parameters[i]) + "\n";
  }
  return text;
}

std::string diagnostics_csv(const std::vector<std::map<std::string, double>>& of_frames) {
  const std::set<std::string> names = names_of(
      of_frames, [](const auto& values) -> const auto& { return values; });
  std::string text = "frame";
  for (const std::string& name : names) text += "," + name;
  text += "\n";
  for (std::size_t i = 0; i < of_frames.size(); ++i) {
    text += std::to_string(i) + cells_of(of_frames[i], names) + "\n";
  }
  return text;
}

std::string events_csv(const std::vector<Event>& events) {
  const std::set<std::string> names = names_of(
      events, [](const Event& event) -> const auto& { return event.numbers; });
  std::string text = "time_s,kind,x,y,z,energy_J,duration_s";
  for (const std::string& name : names) text += "," + name;
  text += "\n";
  for (const Event& event : events) {
    text += number_text(event.time_s) + "," + quoted_cell(event.kind);
    for (const double x : {event.position.x(), event.position.y(), event.position.z(),
                           event.energy_J, event.duration_s}) {
      text += "," + number_text(x);
    }
    text += cells_of(event.numbers, names) + "\n";
  }
  return text;
}

}  // namespace

ExternalFrames find_external_frames(const ExternalOptions& options, const fs::path& base,
                                    const std::string& default_part, const Scene& scene) {
  const fs::path path = path_of_frames(options, base);
  if (!is_pattern(options)) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) {
      throw Error(fs::exists(path, ignored) ? "is no folder" : "there is no such folder",
                  path.string(), "a folder of frames, or numbered files \"frame_%04d.ply\"");
    }
    return find_in_layout(options, path, scene);
  }
  ExternalFrames found;
  found.root = path;
  read_pattern(path, options.part.value_or(default_part), found);
  require_no_gaps(found);
  find_parameters(options, path.parent_path(), scene, found);
  return found;
}

std::vector<fs::path> files_of_external_frames(const ExternalOptions& options,
                                               const fs::path& base) {
  const fs::path path = path_of_frames(options, base);
  std::vector<fs::path> files;
  const auto add_if_file = [&](const fs::path& file) {
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored)) files.push_back(file);
  };
  if (is_pattern(options)) {
    if (!matches_any(path)) return files;
    for (const FoundFile& found : find_numbered(path).files) add_if_file(found.file);
    if (options.parameters.empty()) add_if_file(path.parent_path() / kParameters);
    return files;
  }
  if (options.parameters.empty()) add_if_file(path / kParameters);
  for (const char* table : {kDiagnostics, kEvents}) add_if_file(path / table);
  for (const fs::path& file : sorted_entries(room_of_frames(path))) {
    if (is_piece(file)) add_if_file(file);
  }
  for (const fs::path& file : sorted_entries(path / kArtifacts)) add_if_file(file);
  return files;
}

Frame read_external_frame(const Entry& entry) {
  Frame frame;
  frame.diagnostics = entry.diagnostics;
  std::optional<double> parameter = entry.parameter;
  for (const ExternalFrames::Piece& piece : entry.pieces) {
    if (piece.file.extension() == ".csv") {
      frame.tables[piece.name] = table_from_csv(read_text_file(piece.file), piece.file.string());
      continue;
    }
    std::optional<double> of_file;
    frame.parts[piece.name] = read_part_file(piece.file, of_file);
    if (of_file && parameter && !same_parameter(*of_file, *parameter)) {
      throw Error("is of " + number_text(*of_file) + " (TimeValue), its frame of " +
                      number_text(*parameter),
                  piece.file.string());
    }
    if (!parameter) parameter = of_file;
  }
  if (!parameter) {
    throw Error("nothing says at which parameter the frame is",
                entry.pieces.front().file.parent_path().string(),
                "frames.csv with the columns frame and parameter");
  }
  frame.parameter = *parameter;
  return frame;
}

void fit_to_shape(Frame& frame, const PartShape& shape, const std::vector<int>& vertex,
                  const std::string& where) {
  const auto found = frame.parts.find(shape.part);
  const std::string place = where + ", part '" + shape.part + "'";
  if (found == frame.parts.end()) throw Error("is not there", place);
  Part& part = found->second;
  if (!shape.vertices) {
    if (part.kind != shape.kind) throw Error("is of another kind than the topic's", place);
    return;
  }
  const Eigen::Index wanted = *shape.vertices;
  if (!vertex.empty()) {
    if (std::ssize(vertex) != wanted) {
      throw Error("the correspondence has " + std::to_string(vertex.size()) + " rows, the scene " +
                      std::to_string(wanted) + " vertices",
                  place);
    }
    const int most = *std::max_element(vertex.begin(), vertex.end());
    if (most >= part.points.rows()) {
      throw Error("the correspondence names vertex " + std::to_string(most) + " of " +
                      std::to_string(part.points.rows()),
                  place);
    }
    part.points = Eigen::MatrixX3d(part.points(vertex, Eigen::all));
    part.arrays.clear();
    part.triangles = shape.triangles;
    part.kind = shape.kind;
  }
  if (part.points.rows() != wanted) {
    throw Error("has " + std::to_string(part.points.rows()) + " vertices, the scene " +
                    std::to_string(wanted),
                place, "the same vertices in the same order, or the option correspondence");
  }
  if (part.kind == Part::Kind::points || part.triangles.rows() == 0) {
    part.kind = shape.kind;
    part.triangles = shape.triangles;
    std::erase_if(part.arrays,
                  [](const NamedArray& array) { return array.on == NamedArray::On::cells; });
  }
  if (part.kind != shape.kind || part.triangles.rows() != shape.triangles.rows() ||
      part.triangles != shape.triangles) {
    throw Error("has other triangles than the scene", place,
                "the scene's in their order, none at all, or the option correspondence");
  }
}

std::vector<int> read_correspondence(const fs::path& file) {
  const CsvTable table(file, {"vertex"}, {});
  std::vector<int> vertex;
  for (const CsvTable::Row& row : table.rows()) {
    const double x = *table.number(row, "vertex");
    if (x < 0 || x != std::floor(x) || x > 2e9) {
      throw Error("'" + number_text(x) + "' is no number of a vertex", row.place, "0, 1, 2 …");
    }
    vertex.push_back(static_cast<int>(x));
  }
  if (vertex.empty()) throw Error("has no rows", file.string());
  return vertex;
}

void write_layout(const fs::path& folder, const VariantRecord& variant, LayoutParts parts,
                  const std::function<std::vector<std::byte>(const StoredFile&)>& bytes_of) {
  const auto copy = [&](const StoredFile& stored, const char* room) {
    throw_if_stopped();
    const fs::path to = path_below(folder, fs::path(room) / fs::path(stored.name).filename());
    make_folders(to.parent_path());
    write_file_atomically(to, bytes_of(stored));
  };
  std::vector<double> parameters;
  std::vector<std::map<std::string, double>> diagnostics(variant.frames.size());
  for (std::size_t i = 0; i < variant.frames.size(); ++i) {
    parameters.push_back(variant.frames[i].parameter);
    for (const auto& [name, column] : variant.diagnostics) {
      if (i < column.values.size() && !std::isnan(column.values[i])) {
        diagnostics[i][name] = column.values[i];
      }
    }
    for (const StoredFile& stored : variant.frames[i].files) {
      const bool is_table = fs::path(stored.name).extension() == ".csv";
      if (is_table || parts == LayoutParts::as_recorded) copy(stored, kFrames);
    }
  }
  make_folders(folder);
  write_file_atomically(folder / kParameters, frames_csv(parameters));
  write_file_atomically(folder / kDiagnostics, diagnostics_csv(diagnostics));
  if (!variant.events.empty()) {
    write_file_atomically(folder / kEvents, events_csv(variant.events));
  }
  for (const StoredFile& stored : variant.artifacts) copy(stored, kArtifacts);
}

}  // namespace geoprior
