#include "testbed/program.h"

#include <signal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/doctor/doctor.h"
#include "testbed/commands/message_line.h"
#include "testbed/commands/shell/shell_commands.h"
#include "testbed/commands/start/new_external.h"
#include "testbed/commands/start/starters.h"
#include "testbed/runner/process/build_info.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/streams.h"

namespace geoprior {
namespace {

constexpr const char* kFooter = R"(Examples:
  geoprior list
  geoprior run skinning/knee
  geoprior run skinning/knee --quick --variant implicit --set variant.implicit.options.step=0.2
  geoprior describe implicit
  geoprior measure skinning/knee
  geoprior check --quick
  geoprior bless skinning/knee --reason "sample caps by area, thesis 3.1"
  geoprior report skinning/knee
  geoprior compare RUN_FOLDER skinning/knee

Exit codes: 0 done; 1 a check or a claim fell short, or a comparison found less quality; 2 wrong use,
bad input, or stopped by Ctrl-C (the run can be resumed); 3 internal error.)";

/// Everything that the command line can say.
struct CommandLine {
  CLI::App app{"Geometric priors beside their baselines: scenes, methods, metrics, recorded runs",
               "geoprior"};
  bool json = false;
  bool allow_commands = false;
  bool list_claims = false;
  std::string described;
  std::string shell;  ///< that a completion script is for
  bool markdown = false;
  RunRequest run;
  bool no_pictures = false;
  MeasureRequest measure;
  CheckRequest check;
  BlessRequest bless;
  CompareRequest compare;
  RenderRequest render;
  VideoRequest video;
  ReportRequest report;
  ExportRequest exported;
  NewRequest begun;
  std::vector<TopicCommandRequest> of_topics;
};

CLI::App* add_command(CommandLine& line, const std::string& name, const std::string& what) {
  CLI::App* command = line.app.add_subcommand(name, what);
  command->add_flag("--json", line.json, "results as JSON on standard output");
  return command;
}

/// Lets variants of the method "external" start their programs.
void add_allow_commands(CommandLine& line, CLI::App& command) {
  command.add_flag("--allow-commands", line.allow_commands,
                   "let the experiment start the programs that it names");
}

/// An experiment that stands among values of an option is none of them.
/// @param is_value  whether a word may be a value
void give_back_experiment(std::vector<std::string>& values, std::string& experiment,
                          bool (*is_value)(const std::string&)) {
  const auto other = std::find_if_not(values.begin(), values.end(), is_value);
  if (!experiment.empty() || other == values.end()) return;
  experiment = *other;
  values.erase(other);
}

void add_run(CommandLine& line) {
  CLI::App* run = add_command(line, "run", "run an experiment and record it");
  RunRequest& request = line.run;
  LoadRequest& load = request.experiment.load;
  std::string& experiment = request.experiment.id_or_file;
  run->add_option("experiment", experiment, "identifier or .toml file; required");
  run->add_option("--variant", load.variants, "run only these variants")->type_name("NAME");
  run->add_option("--set", load.sets, "override a key of the file with a TOML value")
      ->type_name("KEY=VALUE");
  run->parse_complete_callback([&load, &experiment] {
    // No name of a variant has a slash or a dot, every setting has an equals sign.
    give_back_experiment(load.variants, experiment, [](const std::string& word) {
      return word.find_first_of("/.") == std::string::npos;
    });
    give_back_experiment(load.sets, experiment, [](const std::string& word) {
      return word.find('=') != std::string::npos;
    });
    if (experiment.empty()) throw CLI::RequiredError("experiment");
  });
  run->add_flag("--quick", load.quick, "the small version, as [quick] says");
  run->add_option("--threads", load.threads, "at most so many threads; 0: all")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  run->add_option("--out", request.out, "folder of the run")->type_name("DIR");
  run->add_flag("--resume", request.resume, "go on with an interrupted run");
  run->add_flag("--no-pictures", line.no_pictures, "numbers only: no figure.png, no report");
  add_allow_commands(line, *run);
  run->add_flag("--table", request.table, "print the table of all numbers (summary.md has it too)");
}

void add_measure(CommandLine& line) {
  CLI::App* measure =
      add_command(line, "measure", "compute the metrics of a run anew from its recorded frames");
  measure->add_option("run", line.measure.run, "folder, run.h5, or experiment (its newest run)")
      ->required();
  measure->add_option("--out", line.measure.out, "folder of the measured run")->type_name("DIR");
  measure->add_flag("--no-pictures", line.no_pictures, "numbers only: no figure.png, no report");
}

void add_checks(CommandLine& line) {
  CLI::App* check = add_command(line, "check", "compare runs with their reference values");
  check->add_option("experiment", line.check.ids, "identifiers or files; none: all");
  check->add_flag("--quick", line.check.quick, "the small versions");
  check->add_flag("--mutations", line.check.mutations,
                  "an experiment fails, too, when no claim of it notices that a method is replaced "
                  "by its null");
  check
      ->add_option("--jobs", line.check.jobs,
                   "so many experiments at once, each in a process of its own")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  check
      ->add_option("--threads", line.check.threads,
                   "at most so many threads for each; 0: all. Runs are the same")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  add_allow_commands(line, *check);
  CLI::App* bless = add_command(line, "bless", "make a run's values the reference values");
  bless->add_option("experiment", line.bless.id, "identifier or file")->required();
  bless->add_option("--reason", line.bless.reason, "why the new values are right")
      ->required()
      ->type_name("TEXT");
  add_allow_commands(line, *bless);
  bless->add_flag("--quick", line.bless.quick, "the values of quick runs");
  bless
      ->add_option("--rows", line.bless.rows,
                   "only the values of these metrics (a,b), measured on the run that was blessed: "
                   "nothing is simulated, other values stay")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("METRIC");
}

/// Lets a command read runs whose files are not what was recorded.
void add_force(CLI::App& command, Unverified& unverified) {
  command.add_flag_callback(
      "--force", [&unverified] { unverified = Unverified::used; },
      "use files whose checksums are missing or wrong, and say which");
}

void add_compare(CommandLine& line) {
  const std::string what = "folder, run.h5, or experiment (its newest run)";
  CompareRequest& request = line.compare;
  CLI::App* compare = add_command(
      line, "compare", "what changed between two runs: metrics, claims, pictures and times");
  compare->add_option("before", request.before, what)->required();
  compare->add_option("after", request.after, what)->required();
  compare->add_flag("--common", request.common,
                    "runs of different specifications: compare what both have");
  compare
      ->add_option("--variants", request.variants,
                   "only variant A of the first run, with variant B of the second (A=B,C=D)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("A=B");
  compare
      ->add_option("--out", request.out,
                   "folder of compare.html and compare.md; absent: one in that of the second run")
      ->type_name("DIR");
  add_force(*compare, request.unverified);
}

void add_views(CommandLine& line) {
  const std::string what = "folder, run.h5, or experiment (its newest run)";
  CLI::App* render = add_command(line, "render", "draw figure.png of a run");
  render->add_option("run", line.render.run, what)->required();
  render->add_option("--view", line.render.view, "experiment whose [figure_view] is drawn instead")
      ->type_name("EXPERIMENT");
  CLI::App* video = add_command(line, "video", "draw every frame of a run; a video with ffmpeg");
  video->add_option("run", line.video.run, what)->required();
  video->add_option("--view", line.video.view, "experiment whose [figure_view] is drawn instead")
      ->type_name("EXPERIMENT");
  video
      ->add_option("--fps", line.video.frames_per_second,
                   "frames a second; absent: real time with a sound, else 25")
      ->check(CLI::Range(1.0, 120.0));
  video->add_option("--out", line.video.out, "folder; absent: video in the run's")
      ->type_name("DIR");
  CLI::App* report = add_command(line, "report", "one HTML page about one or several runs");
  CLI::Option* of_runs =
      report->add_option("run", line.report.runs, what + "; none: the newest of every experiment");
  report
      ->add_flag("--published", line.report.published,
                 "instead of runs: all numbers of the records in results/published")
      ->excludes(of_runs);
  report->add_option("--out", line.report.out, "the page")->type_name("FILE");
  CLI::App* exported = add_command(line, "export", "write the frames of a run for other programs");
  exported->add_option("run", line.exported.run, what)->required();
  exported
      ->add_option("--format", line.exported.format,
                   "vtp (all that the metrics see), obj, ply or glb (animated)")
      ->required()
      ->check(CLI::IsMember({"vtp", "obj", "ply", "glb"}));
  exported->add_option("--out", line.exported.out, "folder")->type_name("DIR");
  add_force(*render, line.render.unverified);
  add_force(*video, line.video.unverified);
  add_force(*report, line.report.unverified);
  add_force(*exported, line.exported.unverified);
}

/// What says what the machine has, and what the commands say of themselves, for others to read.
void add_installation(CommandLine& line) {
  add_command(line, "doctor", "what of the machine is there or missing, and what each is for");
  CLI::App* completion = line.app.add_subcommand(
      "completion", "a script that completes commands and names, on stdout");
  completion->add_option("shell", line.shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  line.app.add_subcommand("manual", "the manual page, for man -l, on stdout");
}

void add_new(CommandLine& line) {
  CLI::App* begun = add_command(line, "new", "a folder to begin a method of your own with");
  begun->add_option("kind", line.begun.kind, "external: a program of any language")
      ->required()
      ->check(CLI::IsMember({"external"}));
  begun->add_option("topic", line.begun.topic, "whose scenes and metrics are meant")
      ->required()
      ->check(CLI::IsMember(topics_of_starters()));
  begun->add_option("--out", line.begun.out, "the folder; absent: my-<topic>-method")
      ->type_name("DIR");
}

/// "unit_m" as a flag: "--unit-m".
std::string flag_of(std::string key) {
  std::replace(key.begin(), key.end(), '_', '-');
  return "--" + key;
}

void add_topic_command(CommandLine& line, TopicCommandRequest& request) {
  const TopicCommand& about = *request.command;
  CLI::App* command = add_command(line, about.name, about.summary);
  command->footer("");  // its help is its flags
  command->add_option(about.input, request.input, about.input_meaning)->required();
  const auto options = about.default_options();
  for (const OptionRow& row : list_options([&](OptionVisitor& v) { options->visit(v); })) {
    const bool is_second = row.key == about.second_argument;
    const std::string names = flag_of(row.key) + (is_second ? "," + row.key : "");
    std::string& written = request.options[row.key];
    if (row.type == "boolean") {
      command->add_flag(names, written, row.doc);
    } else {
      command->add_option(names, written, row.doc)->type_name(row.type);
    }
  }
}

void add_topic_commands(CommandLine& line, const std::vector<Topic>& topics) {
  for (const Topic& topic : topics) {
    for (const TopicCommand& command : topic.commands) line.of_topics.push_back({&command, {}, {}});
  }
  // The command line keeps references to the requests.
  for (TopicCommandRequest& request : line.of_topics) add_topic_command(line, request);
}

void build(CommandLine& line, const std::vector<Topic>& topics) {
  line.app.footer(kFooter);
  line.app.set_version_flag("--version", version_line());
  line.app.require_subcommand(1);
  CLI::App* list = add_command(line, "list", "experiments, topics, methods and metrics");
  list->add_flag(
      "--claims", line.list_claims,
      "instead: the claims of all experiments, with value over limit and null in the newest run");
  CLI::App* describe = add_command(
      line, "describe",
      "options of a method or a topic, keys of an experiment file, meaning of a number");
  describe
      ->add_option(
          "name", line.described,
          "method, topic, metric, diagnostic or kind of file, with topic/ before it if need be, or "
          "the word experiment (the keys of its file)")
      ->required();
  describe->add_flag("--markdown", line.markdown, "a table for the documentation, on stdout");
  add_run(line);
  add_measure(line);
  add_checks(line);
  add_compare(line);
  add_views(line);
  add_installation(line);
  add_new(line);
  add_topic_commands(line, topics);
}

int dispatch(CommandLine& line, const std::vector<Topic>& topics) {
  const CommandContext context{topics, line.json, line.allow_commands};
  const std::string command = line.app.get_subcommands().front()->get_name();
  line.run.pictures = line.measure.pictures = !line.no_pictures;
  if (command == "list") {
    return line.list_claims ? list_claims_command(context) : list_command(context);
  }
  if (command == "describe") return describe_command(context, line.described, line.markdown);
  if (command == "run") return run_command(context, line.run);
  if (command == "new") return new_command(context, line.begun);
  if (command == "measure") return measure_command(context, line.measure);
  if (command == "check") return check_command(context, line.check);
  if (command == "bless") return bless_command(context, line.bless);
  if (command == "compare") return compare_command(context, line.compare);
  if (command == "render") return render_command(context, line.render);
  if (command == "video") return video_command(context, line.video);
  if (command == "report") return report_command(context, line.report);
  if (command == "doctor") return doctor_command(context);
  if (command == "completion") {
    return completion_command(context, command_tree(line.app), line.shell);
  }
  if (command == "manual") return manual_command(command_tree(line.app));
  for (const TopicCommandRequest& request : line.of_topics) {
    if (command == request.command->name) return topic_command(context, request);
  }
  return export_command(context, line.exported);
}

/// "run skinning/knee": what was asked for, for messages.
std::string command_text(int argc, const char* const* argv) {
  std::string text;
  for (int i = 1; i < argc; ++i) text += (text.empty() ? "" : " ") + std::string(argv[i]);
  return text;
}

int fail(const char* kind, const std::string& what, int code) {
  say(tinted(kind, Tint::bad) + message_line(what));
  return code;
}

/// --help and --version go to stdout, what is wrong with the arguments to stderr.
int end_of_parsing(const CommandLine& line, const CLI::ParseError& error) {
  std::ostringstream out, problem;
  if (line.app.exit(error, out, problem) != 0) {
    return fail("error: ", std::string(error.what()) + " (geoprior --help)", wrong_use);
  }
  print_out(out.str());
  return done;
}

}  // namespace

int run_program(int argc, const char* const* argv, const std::vector<Topic>& topics) {
  reserve_standard_streams();
  // A file size limit (ulimit -f) and a pipe that nobody reads shall be errors of the write that
  // meets them, not deaths.
  ::signal(SIGXFSZ, SIG_IGN);
  ::signal(SIGPIPE, SIG_IGN);
  try {
    CommandLine line;
    build(line, topics);
    try {
      line.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return end_of_parsing(line, error);
    }
    return dispatch(line, topics);
  } catch (const Stopped&) {
    say("stopped");
    return wrong_use;
  } catch (const Error& error) {
    return fail("error: ", error.what(), wrong_use);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail("error: ", error.what(), wrong_use);
  } catch (const std::bad_alloc&) {
    return fail("error: ", out_of_memory(command_text(argc, argv)).what(), wrong_use);
  } catch (const std::exception& error) {
    return fail("internal error: ", error.what(), internal_error);
  }
}

}  // namespace geoprior
