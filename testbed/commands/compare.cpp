#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/comparison/comparison.h"
#include "testbed/runner/comparison/document.h"
#include "testbed/runner/comparison/pages.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of a table on the terminal; the pages have the rest.
constexpr std::size_t kMostSaidRows = 12;
/// Digits of the content hash that name a folder.
constexpr std::size_t kFolderDigits = 8;

/// "a=b" of --variants.
std::vector<std::pair<std::string, std::string>> variant_pairs(
    const std::vector<std::string>& written) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& text : written) {
    const std::size_t at = text.find('=');
    if (at == std::string::npos || at == 0 || at + 1 == text.size()) {
      throw Error("'" + text + "' names no two variants", "--variants",
                  "<variant of the first run>=<variant of the second>");
    }
    pairs.emplace_back(text.substr(0, at), text.substr(at + 1));
  }
  return pairs;
}

const Topic& topic_of_record(const RunRecord& record, const std::vector<Topic>& topics,
                             const fs::path& folder) {
  for (const Topic& topic : topics) {
    if (topic.name == record.topic) return topic;
  }
  std::vector<std::string> names;
  for (const Topic& topic : topics) names.push_back(topic.name);
  throw Error("is of the topic '" + record.topic + "', which this program does not have",
              folder.string(), allowed_names(record.topic, names));
}

void say_section(const DocumentSection& section) {
  say();
  say(tinted(section.heading, Tint::strong));
  for (const std::string& paragraph : section.paragraphs) say("  " + paragraph);
  for (const DocumentPicture& picture : section.pictures) {
    if (!picture.file) say("  " + picture.caption);
  }
  if (section.table.rows.empty()) return;
  std::vector<std::vector<std::string>> rows{section.table.head};
  const std::size_t count = std::min(section.table.rows.size(), kMostSaidRows);
  for (std::size_t i = 0; i < count; ++i) rows.push_back(section.table.rows[i].cells);
  say_table(rows);
  if (section.table.rows.size() > count) {
    say("  " + std::to_string(section.table.rows.size() - count) + " more rows in compare.html");
  }
}

void say_document(const ComparisonDocument& document) {
  say(tinted(document.title, Tint::strong));
  say(tinted(document.verdict, document.tone == Tone::bad ? Tint::bad : Tint::good));
  for (const DocumentSection& section : document.sections) {
    const bool has_missing_picture =
        std::any_of(section.pictures.begin(), section.pictures.end(),
                    [](const DocumentPicture& picture) { return !picture.file; });
    if (section.pictures.empty() || has_missing_picture) say_section(section);
  }
  say();
}

Json run_json(const OpenedRun& run) {
  const RunRecord& record = run.record();
  Json json{{"run", run.folder().string()},
            {"experiment", record.experiment_id},
            {"content_sha256", record.content_sha256}};
  for (const char* key : {"start", "git_commit", "git_dirty", "version", "cpu", "compiler"}) {
    const auto found = record.provenance.find(key);
    if (found != record.provenance.end()) json[key] = found->second;
  }
  return json;
}

Json keys_json(const std::vector<KeyDifference>& keys) {
  Json json = Json::array();
  for (const KeyDifference& one : keys) {
    json.push_back({{"key", one.key}, {"before", one.before}, {"after", one.after}});
  }
  return json;
}

Json inputs_json(const std::vector<InputDifference>& inputs) {
  Json json = Json::array();
  for (const InputDifference& one : inputs) {
    json.push_back({{"name", one.name}, {"before", one.before}, {"after", one.after}});
  }
  return json;
}

Json values_json(const RunComparison& comparison) {
  Json json = Json::array();
  for (const ValueChange& one : comparison.values) {
    json.push_back({{"change", text_of(one.change)},
                    {"case", one.case_name},
                    {"variant", one.variant},
                    {"metric", one.metric},
                    {"unit", one.unit},
                    {"direction", direction_text(one.direction)},
                    {"before", json_number(one.before)},
                    {"after", json_number(one.after)},
                    {"tolerance", json_number(one.tolerance)},
                    {"unjudged", one.unjudged}});
  }
  return json;
}

Json claims_json(const RunComparison& comparison) {
  Json json = Json::array();
  for (const ClaimChange& one : comparison.claims) {
    json.push_back({{"change", text_of(one.change)},
                    {"text", one.text},
                    {"case", one.case_name},
                    {"before", one.before},
                    {"after", one.after},
                    {"detail", one.detail},
                    {"unjudged", one.unjudged}});
  }
  return json;
}

Json statuses_json(const RunComparison& comparison) {
  Json json = Json::array();
  for (const StatusChange& one : comparison.statuses) {
    json.push_back({{"change", text_of(one.change)},
                    {"case", one.case_name},
                    {"variant", one.variant},
                    {"before", one.before},
                    {"after", one.after}});
  }
  return json;
}

Json times_json(const RunComparison& comparison) {
  Json json = Json::array();
  for (const TimeRatio& one : comparison.times) {
    json.push_back({{"case", one.case_name},
                    {"variant", one.variant},
                    {"phase", one.phase},
                    {"before_s", json_number(one.before_s)},
                    {"after_s", json_number(one.after_s)},
                    {"median_ratio", json_number(one.ratio.value)},
                    {"low", json_number(one.ratio.low)},
                    {"high", json_number(one.ratio.high)},
                    {"pairs", one.pairs}});
  }
  return json;
}

Json comparison_json(const RunComparison& comparison, const OpenedRun& before,
                     const OpenedRun& after, const fs::path& out) {
  return {{"fell", comparison.fell()},
          {"same_bytes", comparison.same_bytes},
          {"before", run_json(before)},
          {"after", run_json(after)},
          {"differing_keys", keys_json(comparison.keys)},
          {"differing_options", keys_json(comparison.options)},
          {"differing_inputs", inputs_json(comparison.inputs)},
          {"values", values_json(comparison)},
          {"within_tolerance", comparison.within},
          {"added_metrics", comparison.added},
          {"gone_metrics", comparison.gone},
          {"lost_metrics", comparison.lost},
          {"claims", claims_json(comparison)},
          {"variants", statuses_json(comparison)},
          {"only_before", comparison.only_before},
          {"only_after", comparison.only_after},
          {"times", times_json(comparison)},
          {"same_processor", comparison.same_processor},
          {"html", (out / "compare.html").string()},
          {"markdown", (out / "compare.md").string()}};
}

/// Both are made before either is written.
void write_pages(const ComparisonDocument& document, const fs::path& out, bool is_asked_for) {
  const std::string html = html_of(document), markdown = markdown_of(document);
  throw_if_stopped();
  try {
    const MadeFolders made(out);
    write_file_atomically(out / "compare.html", std::string_view(html));
    write_file_atomically(out / "compare.md", std::string_view(markdown));
  } catch (const Error& error) {
    if (is_asked_for) throw;
    throw Error(error.what(), "", "pages in another folder, with --out DIR");
  }
}

/// One thing compared with itself says nothing.
void require_two_things(const fs::path& first, const fs::path& second,
                        const ComparisonRequest& request) {
  if (!fs::equivalent(first, second)) return;
  const std::string allowed = "two runs, or --variants A=B to compare two variants of one";
  if (request.variants.empty()) throw Error("is the same run twice", first.string(), allowed);
  for (const auto& [a, b] : request.variants) {
    if (a == b)
      throw Error("is one variant of one run, twice", "--variants " + a + "=" + b, allowed);
  }
}

}  // namespace

int compare_command(const CommandContext& context, const CompareRequest& request) {
  install_stop_handler();
  const fs::path first = run_folder_of(request.before), second = run_folder_of(request.after);
  const ComparisonRequest wanted{request.common, variant_pairs(request.variants)};
  require_two_things(first, second, wanted);
  const OpenedRun before(first, request.unverified), after(second, request.unverified);
  const Topic& topic = topic_of_record(after.record(), context.topics, second);
  const RunComparison comparison = compare_runs(before, after, topic, wanted);
  const ComparisonDocument document = describe_comparison(comparison, before, after);
  const fs::path out = request.out
                           ? fs::path(*request.out)
                           : path_below(second, "compare-" + before.record().content_sha256.substr(
                                                                 0, kFolderDigits));
  say_document(document);  // first: it stands also where no page can be written
  write_pages(document, out, request.out.has_value());
  say("page     " + (out / "compare.html").string());
  say("text     " + (out / "compare.md").string());
  if (context.json) print_json(comparison_json(comparison, before, after, out));
  return comparison.fell() ? fell_short : done;
}

}  // namespace geoprior
