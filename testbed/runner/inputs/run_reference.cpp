#include "testbed/runner/inputs/run_reference.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "testbed/runner/names.h"

namespace geoprior {

namespace {

constexpr std::string_view kPrefix = "run:";

}  // namespace

bool is_run_reference(const std::string& text) { return text.starts_with(kPrefix); }

RunReference parse_run_reference(const std::string& text) {
  std::vector<std::string> parts;
  const std::size_t hash = std::min(text.find('#'), text.size());
  const std::string place = text.substr(kPrefix.size(), hash - kPrefix.size());
  std::istringstream in(place);
  for (std::string part; std::getline(in, part, '/');) parts.push_back(part);
  const bool named = std::all_of(parts.begin(), parts.end(),
                                 [](const std::string& part) { return is_name(part); });
  const std::string artifact = text.substr(std::min(hash + 1, text.size()));
  if (!named || !(artifact.empty() || is_name(artifact)) || parts.size() < 3 || parts.size() > 4 ||
      place.ends_with('/') || text.ends_with('#')) {
    throw Error("no reference to a run: " + quoted_name(text), "",
                "\"run:<topic>/<experiment>/<variant>\" or "
                "\"run:<topic>/<experiment>/<case>/<variant>\", and \"#<file>\" for an artifact");
  }
  RunReference reference;
  reference.artifact = artifact;
  reference.experiment_id = parts[0] + "/" + parts[1];
  if (parts.size() == 4) reference.case_name = parts[2];
  reference.variant = parts.back();
  return reference;
}

}  // namespace geoprior
