#pragma once

#include <cstring>
#include <string>
#include <string_view>

#include "core/frame.h"

namespace geoprior {

/// A file of a run with these bytes.
inline Artifact artifact_of(const std::string& name, std::string_view bytes) {
  Artifact artifact;
  artifact.name = name;
  artifact.bytes.resize(bytes.size());
  std::memcpy(artifact.bytes.data(), bytes.data(), bytes.size());
  return artifact;
}

}  // namespace geoprior
