#pragma once

#include <string>

#include "core/error.h"

namespace geoprior {

/// What may be asked for. Counts and bytes are estimated as doubles, where nothing wraps, and
/// refused before the work begins. `where` is the key ("scene.duration") or element that asks.

/// Most frames of a variant, and most values of a key that counts frames.
inline constexpr int kMostFrames = 100000;
/// Most vertices of a mesh: the six half-edges of each are numbered with 32 bits.
inline constexpr double kMostVertices = 3.5e8;
/// What a vertex of a closed triangle mesh, its two triangles, their connectivity, the frames and
/// the trees of the metrics take at least (B); measured on cylinders of a million vertices.
inline constexpr double kBytesPerVertex = 1000;

/// Bytes that a run may take: GEOPRIOR_MEMORY_GB (1 GB = 10^9 B) where the environment has it, else
/// four fifths of the machine's memory, or of what the process is limited to (ulimit -v).
/// @throws Error  when GEOPRIOR_MEMORY_GB is no positive number
double memory_limit();

/// "12.5 GB", "640 kB".
std::string bytes_text(double bytes);

/// "100000", from 1e15 on "2e+18".
std::string count_text(double count);

/// @param what  is counted, and why so many: "frames of 1e-09 s"
/// @throws Error  "asks for 1000000000 frames of 1e-09 s" when `count` is more than `most` or NaN
void require_count(double count, const std::string& what, double most, const std::string& where);

/// @throws Error  "asks for 4000000 vertices, about 4.0 GB" when `bytes` is more than
///                `memory_limit()` or NaN
void require_memory(double bytes, double count, const std::string& what, const std::string& where);

/// Count and memory of a triangle mesh of so many vertices.
void require_vertices(double vertices, const std::string& where);

/// What an allocation that failed is to the user. @param where  what was being done
Error out_of_memory(const std::string& where);

/// Frames of a process from its start to `duration`, at every `interval` (s).
void require_frames(double duration, double interval, const std::string& where);

}  // namespace geoprior
