#include "testbed/commands/doctor/doctor.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "testbed/commands/console.h"
#include "testbed/commands/doctor/findings.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

/// Pictures come before what opens libraries: they are drawn in a copy of this process.
std::vector<Finding> all_findings() {
  std::vector<Finding> all = folder_findings();
  for (const auto& more : {picture_findings(), python_findings(), program_findings()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

Json json_of(const std::vector<Finding>& findings, bool ready) {
  Json json{{"ready", ready}, {"findings", Json::array()}};
  for (const Finding& finding : findings) {
    json["findings"].push_back({{"what", finding.what},
                                {"required", finding.required},
                                {"found", finding.found},
                                {"where", finding.where},
                                {"needed_for", finding.needed_for},
                                {"get", finding.get}});
  }
  return json;
}

std::string state_of(const Finding& finding) {
  if (finding.found) return "found";
  return finding.required ? "MISSING" : "missing, optional";
}

void say_findings(const std::vector<Finding>& findings, bool ready) {
  std::vector<std::vector<std::string>> rows{{"what", "state", "needed for", "where"}};
  for (const Finding& finding : findings) {
    rows.push_back({finding.what, state_of(finding), finding.needed_for, finding.where});
  }
  say_table(rows, "");
  say();
  for (const Finding& finding : findings) {
    if (!finding.found) say(finding.what + ": " + finding.get);
  }
  say(ready ? tinted("all that `geoprior run skinning/knee` needs is there", Tint::good)
            : tinted("something that `geoprior run skinning/knee` needs is missing", Tint::bad));
}

}  // namespace

int doctor_command(const CommandContext& context) {
  const std::vector<Finding> findings = all_findings();
  const bool ready = std::all_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.found || !finding.required;
  });
  if (context.json) {
    print_json(json_of(findings, ready));
  } else {
    say_findings(findings, ready);
  }
  return ready ? done : fell_short;
}

}  // namespace geoprior
