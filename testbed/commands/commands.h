#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/topic.h"

namespace geoprior {

/// Exit codes of the program. A run that Ctrl-C stopped ends with `wrong_use`: it has no result.
enum ExitCode { done = 0, fell_short = 1, wrong_use = 2, internal_error = 3 };

/// What every command is given.
struct CommandContext {
  const std::vector<Topic>& topics;
  bool json = false;            ///< --json: results on stdout
  bool allow_commands = false;  ///< --allow-commands: variants may start programs
};

/// Which experiment and how; the overrides make another experiment of the same name.
struct ExperimentRequest {
  std::string id_or_file;
  LoadRequest load;
};

struct RunRequest {
  ExperimentRequest experiment;
  std::optional<std::string> out;
  bool resume = false;
  bool pictures = true;  ///< figure.png and the report, after the run
  bool table = false;    ///< the table of all numbers on the terminal as well
};

struct CheckRequest {
  std::vector<std::string> ids;  ///< empty: all of the clone
  bool quick = false;
  bool mutations = false;  ///< each experiment has a claim that a null fails
  int jobs = 1;            ///< experiments at once, each in a process of its own
  /// At most so many threads a process; 0: all. Not part of what names a run, as --threads of `run`
  /// is: results do not depend on it.
  int threads = 0;
};

struct MeasureRequest {
  std::string run;
  std::optional<std::string> out;
  bool pictures = true;
};

struct BlessRequest {
  std::string id;
  std::string reason;
  std::vector<std::string> rows;  ///< only these metrics, of a stored run; empty: all values
  bool quick = false;
};

/// A command that a topic brings, as it was called.
struct TopicCommandRequest {
  const TopicCommand* command = nullptr;
  std::string input;
  std::map<std::string, std::string> options;  ///< by key; as written
};

struct CompareRequest {
  std::string before;
  std::string after;
  bool common = false;                ///< runs of different specifications, where they agree
  std::vector<std::string> variants;  ///< "a=b": a of the first run with b of the second
  std::optional<std::string> out;     ///< absent: compare-<hash> in the second run's folder
  Unverified unverified = Unverified::refused;
};

struct RenderRequest {
  std::string run;
  std::optional<std::string> view;  ///< experiment file whose [figure_view] is drawn
  Unverified unverified = Unverified::refused;
};

struct VideoRequest {
  std::string run;
  std::optional<std::string> view;
  std::optional<std::string> out;
  std::optional<double> frames_per_second;  ///< absent: as VideoOptions
  Unverified unverified = Unverified::refused;
};

struct ReportRequest {
  std::vector<std::string> runs;  ///< empty: the newest run of every experiment
  bool published = false;         ///< instead of runs: the records in results/published
  std::optional<std::string> out;
  Unverified unverified = Unverified::refused;
};

struct ExportRequest {
  std::string run;
  std::string format;
  std::optional<std::string> out;
  Unverified unverified = Unverified::refused;
};

int list_command(const CommandContext& context);
int list_claims_command(const CommandContext& context);
int describe_command(const CommandContext& context, const std::string& name, bool markdown);
int run_command(const CommandContext& context, const RunRequest& request);
int check_command(const CommandContext& context, const CheckRequest& request);
int measure_command(const CommandContext& context, const MeasureRequest& request);
int bless_command(const CommandContext& context, const BlessRequest& request);
int compare_command(const CommandContext& context, const CompareRequest& request);
int render_command(const CommandContext& context, const RenderRequest& request);
int video_command(const CommandContext& context, const VideoRequest& request);
int report_command(const CommandContext& context, const ReportRequest& request);
int topic_command(const CommandContext& context, const TopicCommandRequest& request);
int export_command(const CommandContext& context, const ExportRequest& request);

}  // namespace geoprior
