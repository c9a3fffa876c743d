#pragma once

#include <string>
#include <vector>

namespace geoprior {

/// What the program of a starter does with the frames of the variant beside, before they are its
/// own: what its user edits.
enum class StarterChanges {
  points,  ///< `move`: the points of every part
  pieces,  ///< `move`: the places of pieces, rows of a table, with what is drawn of them
  sound    ///< `heard`: the samples of sound.wav
};

/// What `geoprior new external <topic>` begins with.
struct Starter {
  std::string topic;
  std::string experiment;              ///< whose scene it has, as small as that of quick runs
  std::string beside;                  ///< variant of it
  std::vector<std::string> sets = {};  ///< keys that make it smaller, KEY=VALUE
  std::string view;                    ///< TOML of [figure_view]
  StarterChanges changes = StarterChanges::points;
  /// Of `pieces`: the table, the array of cells that names its rows, the columns of their places.
  std::string pieces = {};
  /// What the function may return in place of its argument. A test holds that a judged number
  /// changes by it.
  std::string instance;
};

/// One for each topic, in the order of their names.
const std::vector<Starter>& starters();

std::vector<std::string> topics_of_starters();

/// The program of a starter, in Python.
std::string starter_program(const Starter& starter);

/// The function of it that is the method.
std::string starter_function(const Starter& starter);

}  // namespace geoprior
