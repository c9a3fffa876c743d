#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// The lines of journal.jsonl (docs/file-formats.md). What a run knows is the sum of its lines: the
/// running program and a resumed one build their state by the same `RunState::apply`.
namespace journal {

using Numbers = std::map<std::string, double>;

struct Place {
  std::string case_name;
  std::string variant;
};

struct RunLine {
  int schema_version = 1;
  std::string experiment_id;
  std::string spec_hash;
  std::string start;                 ///< UTC, "2025-01-31T12:00:00Z"
  std::string experiment_file = {};  ///< as `input_name`; empty in older journals
};
struct CaseLine {
  std::string case_name;
  std::string parameter_name;
  std::string parameter_unit;
  Numbers facts;
  std::vector<std::string> warnings;
  std::vector<StoredFile> inputs;
  double seconds = 0;  ///< of loading
  std::string camera;  ///< as in CaseRecord
};
struct BeginLine {
  Place place;
  Numbers timing;                       ///< "prepare" and the phases in it, s
  std::vector<StoredFile> inputs = {};  ///< that the variant reads beside the scene's
};
/// A variant that failed begins anew: what it has is void.
struct RetryLine {
  Place place;
};
struct FrameLine {
  Place place;
  std::size_t index = 0;
  double parameter = 0;
  std::vector<StoredFile> files;
  Numbers metrics;
  Numbers diagnostics;
  Numbers timing;  ///< of a process: "run" and the phases in it since the frame before, s
};
struct EventLine {
  Place place;
  Event event;
};
struct ArtifactLine {
  Place place;
  StoredFile file;
};
struct CheckpointLine {
  Place place;
  StoredFile file;
  std::size_t frames = 0;
  std::size_t events = 0;
  std::size_t artifacts = 0;
  Numbers timing;  ///< "run" and the phases in it since the last frame, s
};
struct ResumeLine {
  Place place;
  std::size_t frames = 0;
  std::size_t events = 0;
  std::size_t artifacts = 0;
};
struct EndLine {
  Place place;
  Numbers summary;    ///< metrics of the sequence
  Numbers timing;     ///< of a process: "run" and the phases in it after the last frame, s
  std::string error;  ///< why the variant ended early; empty: it is complete
  std::optional<MemoryUse> memory;
};
struct TimingLine {
  std::string case_name;
  /// variant: phase: [frame][repetition] s
  std::map<std::string, std::map<std::string, std::vector<std::vector<double>>>> timing;
  std::vector<TimingRatio> ratios;
};
struct ErrorLine {
  Place place;
  std::string message;
};
/// Processor time of a case in one program that worked on it, input runs excluded.
struct ProcessorLine {
  double seconds = 0;  ///< user and system, of all threads and of child processes
};
/// The last line of a finished run: what the journal says was assembled into this file.
struct ResultLine {
  StoredFile file;  ///< run.h5
};

using Line =
    std::variant<RunLine, CaseLine, BeginLine, FrameLine, EventLine, ArtifactLine, CheckpointLine,
                 ResumeLine, RetryLine, EndLine, TimingLine, ErrorLine, ProcessorLine, ResultLine>;

/// One JSON object without line break; numbers are exact.
std::string to_text(const Line& line);
/// @throws Error  when the text is no line of a journal
Line from_text(std::string_view text);

/// The first line of a journal that somebody may be writing; absent when it is not whole.
std::optional<RunLine> read_head(const std::filesystem::path& file);

}  // namespace journal

/// The append-only log of a run folder, locked against other programs as long as it lives.
class Journal {
 public:
  /// Opens or makes `file` and locks it; the first `append` cuts off a torn last line.
  /// @throws Error  when another program writes this run, or a line but the last is damaged
  explicit Journal(std::filesystem::path file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The lines that were there when the journal was opened.
  [[nodiscard]] const std::vector<journal::Line>& lines() const { return lines_; }
  /// Appends a line; `flush` waits until it and all before it are on the disk.
  /// @throws Error  disk full …; the journal is then as before
  void append(const journal::Line& line, bool flush);

 private:
  void lock();
  void read();
  void cut_torn_line();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::vector<journal::Line> lines_;
  std::optional<off_t> torn_at_;  ///< where a torn last line begins that no append has cut off
};

/// Whether some program has the journal of the run open at the moment.
bool is_being_written(const std::filesystem::path& run_folder);

}  // namespace geoprior
