#include "testbed/external/method.h"

#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "testbed/external/child.h"
#include "testbed/external/frame_layout.h"
#include "testbed/external/options.h"
#include "testbed/external/scene_folder.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/wav_file.h"
#include "testbed/runner/benchmark.h"
#include "testbed/runner/process/run_context.h"
#include "testbed/shell_word.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOut = "out";

// Diagnostics of a command's first frame.
constexpr const char* kWall = "process_wall";
constexpr const char* kProcessor = "process_processor";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

/// {case} and {variant} replaced.
std::string at_site(const std::string& text, const MethodSite& site) {
  return replaced(replaced(text, "{case}", site.case_name), "{variant}", site.variant);
}

/// The file beside the experiment file that an argument names, wherever the program runs; absent:
/// it is a word.
std::optional<fs::path> file_of(const std::string& argument, const MethodSite& site) {
  const fs::path file = fs::absolute(site.folder / argument).lexically_normal();
  std::error_code ignored;
  if (argument.empty() || !fs::is_regular_file(file, ignored)) return std::nullopt;
  return file;
}

const ExternalOptions& external_options(const OptionSet& options) {
  return dynamic_cast<const TypedOptions<ExternalOptions>&>(options).options;
}

/// No clock runs while one lives.
class UntimedReading {
 public:
  explicit UntimedReading(RunContext& context) {
    if (auto* timed = dynamic_cast<TimedContext*>(&context)) pause_.emplace(*timed);
  }

 private:
  std::optional<TimedContext::Pause> pause_;
};

/// Pushes the frames that another program made, or makes as part of the run.
class ExternalProcess final : public Process {
 public:
  ExternalProcess(MethodSite site, const Scene& scene, ExternalOptions options)
      : site_(std::move(site)), scene_(scene), options_(std::move(options)) {
    options_.frames = at_site(options_.frames, site_);
    if (options_.command.empty() && options_.frames.empty()) {
      throw Error("neither frames nor a command", "options",
                  "frames = \"folder\", or command = [...]");
    }
    if (options_.correspondence) {
      vertex_ = read_correspondence(site_.folder / *options_.correspondence);
    }
  }

  void run(FrameSink& sink, RunContext& context, const std::optional<State>&) override {
    if (options_.command.empty()) {
      push(sink, context, site_.folder, {});
      return;
    }
    const WorkFolder work(site_.work, context);
    {
      const UntimedReading untimed(context);
      write_scene_folder(site_.work, site_, scene_);
    }
    const CommandEnd end = started(context);
    if (end.stopped) return;
    if (!end.failure.empty()) throw NotApplicable(end.failure, options_.command.front());
    push_made(sink, context, end);
  }

 private:
  /// Of the command, gone with its files when it is done: what counts was recorded. All of
  /// <run>/external goes, whatever the command made or renamed there.
  class WorkFolder {
   public:
    WorkFolder(const fs::path& folder, RunContext& context)
        : room_(folder.parent_path().parent_path()), context_(context) {
      remove();
      std::error_code ignored;
      // Frames of an earlier program must not pass for those of this one.
      if (fs::exists(room_, ignored)) {
        throw NotApplicable("what an earlier program left cannot be removed", room_.string());
      }
      make_folders(folder);
    }
    ~WorkFolder() {
      const UntimedReading untimed(context_);
      remove();
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

   private:
    void remove() const {
      std::error_code failed, ignored;
      fs::remove_all(room_, failed);
      if (!failed) return;
      // A folder that may not be written keeps its files.
      for (auto it = fs::recursive_directory_iterator(room_, ignored);
           it != fs::recursive_directory_iterator(); it.increment(ignored)) {
        std::error_code gone;
        if (it->is_directory(gone) && !it->is_symlink(gone)) {
          fs::permissions(it->path(), fs::perms::owner_all, fs::perm_options::add, gone);
        }
      }
      fs::remove_all(room_, ignored);
    }
    fs::path room_;
    RunContext& context_;
  };

  CommandEnd started(RunContext& context) const {
    std::vector<std::string> command;
    for (const std::string& argument : options_.command) {
      const auto file = file_of(argument, site_);
      command.push_back(file ? file->string() : at_site(argument, site_));
    }
    const fs::path work = fs::absolute(site_.work);
    return run_external_command(command, work,
                                {"GEOPRIOR_SCENE=" + (work / "scene.json").string(),
                                 "GEOPRIOR_OUT=" + (work / kOut).string()},
                                {options_.time_limit_s, options_.output_limit_MB}, context);
  }

  /// What the command made. Messages name its files as it knows them: the folder goes.
  void push_made(FrameSink& sink, RunContext& context, const CommandEnd& end) {
    const auto in_its_words = [&](const Error& error) {
      return replaced(error.what(), site_.work.string() + "/", "");
    };
    try {
      push(sink, context, site_.work, end);
    } catch (const NotApplicable& error) {
      throw NotApplicable(in_its_words(error));
    } catch (const Error& error) {
      throw Error(in_its_words(error));
    }
  }

  /// Reads and pushes everything. A failure before the first frame is that of the variant alone.
  void push(FrameSink& sink, RunContext& context, const fs::path& base, const CommandEnd& end) {
    ExternalOptions options = options_;
    if (options.frames.empty()) options.frames = kOut;
    std::optional<ExternalFrames> found;
    std::size_t pushed = 0;
    try {
      {
        const UntimedReading untimed(context);
        found = find_external_frames(options, base, default_part(), scene_);
      }
      for (const ExternalFrames::Entry& entry : found->frames) {
        if (context.stop_requested()) return;
        std::optional<Frame> frame;
        {
          const UntimedReading untimed(context);
          frame = checked_frame(entry, pushed);
        }
        if (!options_.command.empty()) take_cost(*frame, pushed == 0 ? &end : nullptr);
        sink.frame(std::move(*frame));
        ++pushed;
        context.progress(static_cast<double>(pushed) / static_cast<double>(found->frames.size()));
      }
      push_rest(sink, context, *found);
    } catch (const NotApplicable&) {
      throw;
    } catch (const Error& error) {
      if (pushed > 0) throw;
      throw NotApplicable(error.what());
    }
  }

  /// What a command took is measured here, whatever its diagnostics say.
  /// @param end  where the frame is the first
  static void take_cost(Frame& frame, const CommandEnd* end) {
    for (const auto& [name, of_end] :
         {std::pair(kWall, &CommandEnd::wall_s), std::pair(kProcessor, &CommandEnd::processor_s),
          std::pair(kPeakMemory, &CommandEnd::peak_MB)}) {
      frame.diagnostics.erase(name);
      if (end != nullptr) frame.diagnostics[name] = end->*of_end;
    }
  }

  static void push_rest(FrameSink& sink, RunContext& context, const ExternalFrames& found) {
    const UntimedReading untimed(context);
    for (const Event& event : found.events) sink.event(event);
    for (const ExternalFrames::Piece& artifact : found.artifacts) {
      std::vector<std::string> notes;
      if (artifact.file.extension() == ".wav") (void)read_wav(artifact.file, notes);
      sink.artifact({artifact.name, bytes_of_file(artifact.file)});
    }
  }

  [[nodiscard]] Frame checked_frame(const ExternalFrames::Entry& entry, std::size_t index) const {
    Frame frame = read_external_frame(entry);
    const std::string where = entry.pieces.empty() ? "frame " + std::to_string(index)
                                                   : entry.pieces.front().file.string();
    for (const PartShape& shape : scene_.frame_shape()) {
      fit_to_shape(frame, shape, shape.vertices ? vertex_ : std::vector<int>{}, where);
    }
    return frame;
  }

  [[nodiscard]] std::string default_part() const {
    const std::vector<PartShape> shapes = scene_.frame_shape();
    return shapes.empty() ? "surface" : shapes.front().part;
  }

  MethodSite site_;
  const Scene& scene_;
  ExternalOptions options_;
  std::vector<int> vertex_;  ///< of the frames, for each of the scene; empty: the same
};

/// Files of the experiment's folder that make the result; frames of a command are its own.
std::vector<fs::path> external_inputs(const MethodSite& site, const OptionSet& set) {
  ExternalOptions options = external_options(set);
  options.frames = at_site(options.frames, site);
  std::vector<fs::path> files;
  for (const std::string& argument : options.command) {
    if (const auto file = file_of(argument, site)) files.push_back(*file);
  }
  if (options.command.empty()) {
    for (const fs::path& file : files_of_external_frames(options, site.folder)) {
      files.push_back(file);
    }
  }
  if (options.correspondence) files.push_back(site.folder / *options.correspondence);
  return files;
}

}  // namespace

void add_external_method(Topic& topic) {
  MethodEntry entry;
  entry.name = kExternalMethod;
  entry.summary = "frames of another program: files, or a command that is started for each case";
  entry.source = "docs/external-methods.md";
  entry.default_options = [] { return std::make_unique<TypedOptions<ExternalOptions>>(); };
  entry.make_at = [](const MethodSite& site, const Scene& scene, const OptionSet& set,
                     RunContext&) -> MethodEntry::Instance {
    try {
      return std::make_unique<ExternalProcess>(site, scene, external_options(set));
    } catch (const Error& error) {
      throw NotApplicable(error.what());
    }
  };
  entry.starts = [](const OptionSet& set) { return shell_line(external_options(set).command); };
  entry.inputs = external_inputs;
  topic.methods.push_back(std::move(entry));

  DiagnosticTable rows;
  rows.unmeasured("cost of another program, which no frame shows",
                  {{kWall, "s", "wall time of an external command, on its first frame"},
                   {kProcessor, "s",
                    "processor time of an external command and the children it waited for, on its "
                    "first frame"},
                   {kPeakMemory, "MB",
                    "resident memory of the largest process of an external command, on its first "
                    "frame"}});
  for (DiagnosticEntry& row : rows.rows()) topic.diagnostics.push_back(std::move(row));
}

}  // namespace geoprior
