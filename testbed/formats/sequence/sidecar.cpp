#include "testbed/formats/sequence/sidecar.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/formats/text/parsed_text.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

using Json = nlohmann::json;

/// The beginning of a value, for messages.
std::string beginning_of(const Json& value) { return value.dump().substr(0, 60); }

double number(const Json& value, const std::string& key, bool positive, const std::string& name) {
  const double x = value.is_number() ? value.get<double>() : std::nan("");
  if (!std::isfinite(x) || (positive && !(x > 0))) {
    throw Error("\"" + key + "\" is " + beginning_of(value), name,
                positive ? "a positive number" : "a number");
  }
  return x;
}

bool is_y(const Json& value, const std::string& name) {
  if (value == "y" || value == "z") return value == "y";
  throw Error("\"up\" is " + beginning_of(value), name, "\"y\", \"z\"");
}

}  // namespace

SequenceSidecar parse_sidecar(std::string_view text, const std::string& name) {
  const Json json = parse_json(text, name);
  if (!json.is_object()) throw Error("is no JSON object", name);
  SequenceSidecar sidecar;
  for (const auto& [key, value] : json.items()) {
    if (key == "frames_per_second") {
      sidecar.frames_per_second = number(value, key, true, name);
    } else if (key == "scale") {
      sidecar.scale = number(value, key, true, name);
    } else if (key == "start") {
      sidecar.start = number(value, key, false, name);
    } else if (key == "up") {
      sidecar.y_up = is_y(value, name);
    } else {
      throw Error("has the unknown key \"" + key + "\"", name,
                  "frames_per_second, up, scale, start");
    }
  }
  return sidecar;
}

SequenceSidecar read_sidecar(const std::filesystem::path& file) {
  return parse_sidecar(read_text_file(file), file.string());
}

}  // namespace geoprior
