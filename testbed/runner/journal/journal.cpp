#include "testbed/runner/journal/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/input_file.h"
#include "testbed/formats/system_reason.h"
#include "testbed/formats/text/nesting.h"

namespace geoprior::journal {

namespace {

using SortedJson = nlohmann::json;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

/// JSON has no NaN and no infinities.
SortedJson number(double x) {
  if (std::isnan(x)) return nullptr;
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  return x;
}

double number(const SortedJson& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (json.is_string()) {
    const double infinity = std::numeric_limits<double>::infinity();
    if (json == "inf") return infinity;
    if (json == "-inf") return -infinity;
    throw Error("no number: " + json.dump());
  }
  return json.get<double>();
}

SortedJson numbers(const Numbers& map) {
  SortedJson out = SortedJson::object();
  for (const auto& [key, value] : map) out[key] = number(value);
  return out;
}

Numbers numbers(const SortedJson& json) {
  Numbers out;
  for (const auto& [key, value] : json.items()) out[key] = number(value);
  return out;
}

SortedJson files(const std::vector<StoredFile>& list) {
  SortedJson out = SortedJson::array();
  for (const StoredFile& file : list) out.push_back({{"name", file.name}, {"sha256", file.sha256}});
  return out;
}

StoredFile file(const SortedJson& json) { return {json.at("name"), json.at("sha256")}; }

std::vector<StoredFile> files(const SortedJson& json) {
  std::vector<StoredFile> out;
  for (const SortedJson& entry : json) out.push_back(file(entry));
  return out;
}

SortedJson at(const Place& place, const char* kind) {
  return {{"kind", kind}, {"case", place.case_name}, {"variant", place.variant}};
}

Place place(const SortedJson& json) { return {json.at("case"), json.at("variant")}; }

SortedJson rows(const std::vector<std::vector<double>>& seconds) {
  SortedJson out = SortedJson::array();
  for (const auto& row : seconds) {
    SortedJson& line = out.emplace_back(SortedJson::array());
    for (const double x : row) line.push_back(number(x));
  }
  return out;
}

std::vector<std::vector<double>> rows(const SortedJson& json) {
  std::vector<std::vector<double>> out;
  for (const SortedJson& line : json) {
    auto& row = out.emplace_back();
    for (const SortedJson& x : line) row.push_back(number(x));
  }
  return out;
}

SortedJson write(const RunLine& line) {
  return {{"kind", "run"},
          {"schema_version", line.schema_version},
          {"experiment_id", line.experiment_id},
          {"spec_hash", line.spec_hash},
          {"start", line.start},
          {"experiment_file", line.experiment_file}};
}

SortedJson write(const CaseLine& line) {
  SortedJson json = {{"kind", "case"},
                     {"case", line.case_name},
                     {"parameter_name", line.parameter_name},
                     {"parameter_unit", line.parameter_unit},
                     {"facts", numbers(line.facts)},
                     {"warnings", line.warnings},
                     {"inputs", files(line.inputs)},
                     {"seconds", number(line.seconds)}};
  if (!line.camera.empty()) json["camera"] = line.camera;
  return json;
}

SortedJson write(const BeginLine& line) {
  SortedJson json = at(line.place, "begin");
  json["timing"] = numbers(line.timing);
  if (!line.inputs.empty()) json["inputs"] = files(line.inputs);
  return json;
}

SortedJson write(const RetryLine& line) { return at(line.place, "retry"); }

SortedJson write(const FrameLine& line) {
  SortedJson json = at(line.place, "frame");
  json["index"] = line.index;
  json["parameter"] = number(line.parameter);
  json["files"] = files(line.files);
  json["metrics"] = numbers(line.metrics);
  json["diagnostics"] = numbers(line.diagnostics);
  json["timing"] = numbers(line.timing);
  return json;
}

SortedJson write(const EventLine& line) {
  SortedJson json = at(line.place, "event");
  const Event& event = line.event;
  json["time_s"] = number(event.time_s);
  json["kind_of_event"] = event.kind;
  json["position"] = {number(event.position.x()), number(event.position.y()),
                      number(event.position.z())};
  json["energy_J"] = number(event.energy_J);
  json["duration_s"] = number(event.duration_s);
  if (!event.numbers.empty()) json["numbers"] = numbers(event.numbers);
  return json;
}

SortedJson write(const ArtifactLine& line) {
  SortedJson json = at(line.place, "artifact");
  json["name"] = line.file.name;
  json["sha256"] = line.file.sha256;
  return json;
}

SortedJson write(const CheckpointLine& line) {
  SortedJson json = at(line.place, "checkpoint");
  json["name"] = line.file.name;
  json["sha256"] = line.file.sha256;
  json["frames"] = line.frames;
  json["events"] = line.events;
  json["artifacts"] = line.artifacts;
  json["timing"] = numbers(line.timing);
  return json;
}

SortedJson write(const ResumeLine& line) {
  SortedJson json = at(line.place, "resume");
  json["frames"] = line.frames;
  json["events"] = line.events;
  json["artifacts"] = line.artifacts;
  return json;
}

SortedJson write(const EndLine& line) {
  SortedJson json = at(line.place, "end");
  json["summary"] = numbers(line.summary);
  json["timing"] = numbers(line.timing);
  if (!line.error.empty()) json["error"] = line.error;
  if (line.memory) json["memory"] = {{"start", line.memory->start}, {"peak", line.memory->peak}};
  return json;
}

SortedJson write(const TimingLine& line) {
  SortedJson timing = SortedJson::object();
  for (const auto& [variant, phases] : line.timing) {
    SortedJson& of = timing[variant] = SortedJson::object();
    for (const auto& [phase, seconds] : phases) of[phase] = rows(seconds);
  }
  SortedJson ratios = SortedJson::array();
  for (const TimingRatio& ratio : line.ratios) {
    ratios.push_back({{"variant", ratio.variant},
                      {"of", ratio.of},
                      {"paired", ratio.paired},
                      {"median_ratio", number(ratio.median_ratio)},
                      {"low", number(ratio.low)},
                      {"high", number(ratio.high)}});
  }
  return {{"kind", "timing"}, {"case", line.case_name}, {"timing", timing}, {"ratios", ratios}};
}

SortedJson write(const ErrorLine& line) {
  SortedJson json = at(line.place, "error");
  json["message"] = line.message;
  return json;
}

SortedJson write(const ProcessorLine& line) {
  return {{"kind", "processor"}, {"seconds", number(line.seconds)}};
}

SortedJson write(const ResultLine& line) {
  return {{"kind", "result"}, {"name", line.file.name}, {"sha256", line.file.sha256}};
}

Line read_event(const SortedJson& json) {
  EventLine line{place(json), {}};
  line.event.time_s = number(json.at("time_s"));
  line.event.kind = json.at("kind_of_event");
  for (int axis = 0; axis < 3; ++axis) {
    line.event.position[axis] = number(json.at("position").at(axis));
  }
  line.event.energy_J = number(json.at("energy_J"));
  line.event.duration_s = number(json.at("duration_s"));
  if (json.contains("numbers")) line.event.numbers = numbers(json.at("numbers"));
  return line;
}

std::optional<MemoryUse> memory(const SortedJson& json) {
  if (!json.contains("memory")) return std::nullopt;
  return MemoryUse{json.at("memory").at("start"), json.at("memory").at("peak")};
}

Line read_timing(const SortedJson& json) {
  TimingLine line;
  line.case_name = json.at("case");
  for (const auto& [variant, phases] : json.at("timing").items()) {
    for (const auto& [phase, seconds] : phases.items()) line.timing[variant][phase] = rows(seconds);
  }
  for (const SortedJson& ratio : json.at("ratios")) {
    line.ratios.push_back({ratio.at("variant"), ratio.at("of"), number(ratio.at("median_ratio")),
                           number(ratio.at("low")), number(ratio.at("high")), ratio.at("paired")});
  }
  return line;
}

Line read_frame(const SortedJson& json) {
  return FrameLine{place(json),
                   json.at("index"),
                   number(json.at("parameter")),
                   files(json.at("files")),
                   numbers(json.at("metrics")),
                   numbers(json.at("diagnostics")),
                   numbers(json.at("timing"))};
}

Line read(const SortedJson& json) {
  const std::string kind = json.at("kind");
  if (kind == "frame") return read_frame(json);
  if (kind == "event") return read_event(json);
  if (kind == "timing") return read_timing(json);
  if (kind == "artifact") return ArtifactLine{place(json), file(json)};
  if (kind == "retry") return RetryLine{place(json)};
  if (kind == "begin") {
    return BeginLine{
        place(json), numbers(json.at("timing")),
        json.contains("inputs") ? files(json.at("inputs")) : std::vector<StoredFile>{}};
  }
  if (kind == "result") return ResultLine{file(json)};
  if (kind == "processor") return ProcessorLine{number(json.at("seconds"))};
  if (kind == "error") return ErrorLine{place(json), json.at("message")};
  if (kind == "run") {
    return RunLine{json.at("schema_version"), json.at("experiment_id"), json.at("spec_hash"),
                   json.at("start"), json.value("experiment_file", "")};
  }
  if (kind == "case") {
    return CaseLine{json.at("case"),
                    json.at("parameter_name"),
                    json.at("parameter_unit"),
                    numbers(json.at("facts")),
                    json.at("warnings"),
                    files(json.at("inputs")),
                    number(json.at("seconds")),
                    json.value("camera", "")};
  }
  if (kind == "checkpoint") {
    return CheckpointLine{place(json),       file(json),           json.at("frames"),
                          json.at("events"), json.at("artifacts"), numbers(json.at("timing"))};
  }
  if (kind == "resume") {
    return ResumeLine{place(json), json.at("frames"), json.at("events"), json.at("artifacts")};
  }
  if (kind == "end") {
    return EndLine{place(json), numbers(json.at("summary")), numbers(json.at("timing")),
                   json.value("error", ""), memory(json)};
  }
  throw Error("unknown kind of line '" + kind + "'");
}

}  // namespace

std::string to_text(const Line& line) {
  return std::visit([](const auto& of_kind) { return write(of_kind); }, line)
      .dump(-1, ' ', false, SortedJson::error_handler_t::replace);
}

Line from_text(std::string_view text) {
  require_shallow_json(text, "damaged line");
  try {
    return read(SortedJson::parse(text));
  } catch (const SortedJson::exception& error) {
    throw Error(std::string("damaged line: ") + error.what());
  }
}

std::optional<RunLine> read_head(const std::filesystem::path& file) {
  constexpr std::size_t kMost = 1 << 16;  // more than a head has
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::string text(kMost, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(in.gcount());
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return std::nullopt;
  try {
    const Line line = from_text(std::string_view(text).substr(0, end));
    const auto* head = std::get_if<RunLine>(&line);
    return head == nullptr ? std::nullopt : std::optional(*head);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace geoprior::journal

namespace geoprior {

Journal::Journal(std::filesystem::path file) : file_(std::move(file)) {
  const bool is_new = !std::filesystem::exists(file_);
  if (!is_new) require_regular_file(file_);
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw Error("cannot be opened: " + system_reason(errno), file_.string());
  try {
    lock();
    if (is_new) flush_to_disk(file_.parent_path());
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() { ::close(descriptor_); }

void Journal::lock() {
  // Who asks `is_being_written` holds the lock for an instant.
  constexpr int kAttempts = 10;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK) break;
  }
  if (errno == EWOULDBLOCK) {
    throw Error("another program is writing this run", file_.parent_path().string(),
                "wait for it, or choose another --out");
  }
  throw Error("cannot be locked: " + system_reason(errno), file_.string());
}

void Journal::read() {
  const std::string text = read_whole_file(file_);
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    try {
      lines_.push_back(journal::from_text(std::string_view(text).substr(begin, end - begin)));
    } catch (const Error& error) {
      // A crash of the machine can leave the last line at its length but without its bytes.
      if (end + 1 == text.size()) break;
      throw Error(error.what(), file_.string() + ":" + std::to_string(lines_.size() + 1));
    }
  }
  if (begin < text.size()) torn_at_ = static_cast<off_t>(begin);
}

void Journal::cut_torn_line() {
  if (!torn_at_) return;
  if (::ftruncate(descriptor_, *torn_at_) != 0) {
    throw Error("cannot be repaired: " + system_reason(errno), file_.string());
  }
  torn_at_.reset();
}

void Journal::append(const journal::Line& line, bool flush) {
  cut_torn_line();
  const off_t before = ::lseek(descriptor_, 0, SEEK_END);
  try {
    write_all(descriptor_, journal::to_text(line) + '\n', file_);
  } catch (const Error&) {
    // Half a line would be repaired on resume anyway; this keeps the file readable until then.
    if (::ftruncate(descriptor_, before) != 0) errno = 0;
    throw;
  }
  if (flush && ::fsync(descriptor_) != 0) {
    throw Error("cannot be flushed to the disk: " + system_reason(errno), file_.string());
  }
}

bool is_being_written(const std::filesystem::path& run_folder) {
  const std::filesystem::path file = run_folder / "journal.jsonl";
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool is_locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return is_locked;
}

}  // namespace geoprior
