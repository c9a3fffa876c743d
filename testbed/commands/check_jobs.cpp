#include "testbed/commands/check_jobs.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "core/error.h"
#include "testbed/commands/console.h"
#include "testbed/runner/process/jobs.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/streams.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

/// Processor seconds that the experiment took when it was blessed; 0: not known.
double cost_of(const std::string& id, bool quick) {
  try {
    const Reference reference = read_reference(reference_file(id));
    const auto set = reference.find(quick ? "quick" : "full");
    return set == reference.end() ? 0 : set->second.processor_s.value_or(0);
  } catch (const Error&) {
    return 0;  // its check says what is wrong with the file
  }
}

std::vector<std::size_t> longest_first(const std::vector<std::string>& ids, bool quick) {
  std::vector<double> costs;
  for (const std::string& id : ids) costs.push_back(cost_of(id, quick));
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  return order;
}

std::vector<std::string> job_arguments(const CommandContext& context, const CheckRequest& request,
                                       const std::string& id) {
  std::vector<std::string> words{"check", "--json", "--threads", std::to_string(request.threads)};
  if (request.quick) words.emplace_back("--quick");
  if (request.mutations) words.emplace_back("--mutations");
  if (context.allow_commands) words.emplace_back("--allow-commands");
  words.insert(words.end(), {"--", id});
  return words;
}

/// The experiment's entry in what a process printed; none where it printed no such thing.
std::optional<Json> verdict_of(const JobResult& result) {
  const Json printed = Json::parse(result.out, nullptr, false);
  if (!printed.is_object() || !printed.contains("experiments")) return std::nullopt;
  const Json& experiments = printed["experiments"];
  if (!experiments.is_array() || experiments.size() != 1) return std::nullopt;
  return experiments[0];
}

/// Why there is no verdict: in how the process ended, or what it said last.
std::string problem_of(const JobResult& result) {
  if (result.signal != 0) {
    return "the process that checked it was ended by signal " + std::to_string(result.signal) +
           " (" + ::strsignal(result.signal) + ")";
  }
  return "it could not be checked (exit code " + std::to_string(result.exit_code) + ")";
}

/// Adds up what the processes found.
class Findings {
 public:
  void add(const std::string& id, const JobResult& result) {
    std::istringstream said(result.err);
    for (std::string line; std::getline(said, line);) say(line);
    const std::optional<Json> verdict = verdict_of(result);
    if (verdict) {
      json_.push_back(*verdict);
    } else {
      say(tinted("failed", Tint::bad) + "  " + id + ": " + problem_of(result));
      json_.push_back({{"experiment", id}, {"passed", false}, {"error", problem_of(result)}});
    }
    const bool crashed = result.signal != 0 || (!verdict && result.exit_code < wrong_use);
    worst_ = std::max(worst_, crashed ? static_cast<int>(internal_error) : result.exit_code);
  }
  [[nodiscard]] int worst() const { return std::min<int>(worst_, internal_error); }
  [[nodiscard]] const Json& json() const { return json_; }

 private:
  Json json_ = Json::array();
  int worst_ = done;
};

}  // namespace

int check_in_jobs(const CommandContext& context, const CheckRequest& request,
                  const std::vector<std::string>& ids) {
  install_stop_handler();
  JobArguments jobs;
  for (const std::string& id : ids) jobs.push_back(job_arguments(context, request, id));
  Findings findings;
  run_jobs(jobs, longest_first(ids, request.quick), request.jobs,
           [&](std::size_t index, const JobResult& result) { findings.add(ids[index], result); });
  if (context.json) {
    print_json({{"passed", findings.worst() == done}, {"experiments", findings.json()}});
  }
  return findings.worst();
}

}  // namespace geoprior
