#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "testbed/runner/options/listing.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/topic.h"

// Which options somebody turns: the rule of docs/experiments.md ("Options that somebody turns").

namespace geoprior::test {

/// The options of a column as dotted keys ("handles[1].stiffness") with the JSON text of their
/// value. Tables have the text "table", or "false" where they are absent; a list of tables has the
/// number of its elements.
using FlatOptions = std::map<std::string, std::string>;

FlatOptions flat_options(const nlohmann::ordered_json& options);

/// "handles[].stiffness" of "handles[1].stiffness": as the rows of a listing are called.
std::string row_key(const std::string& key);

/// The rows of a listing, to be found by their keys.
class OptionRows {
 public:
  explicit OptionRows(std::vector<OptionRow> rows);
  [[nodiscard]] const std::vector<OptionRow>& rows() const { return rows_; }
  /// Null where there is none.
  [[nodiscard]] const OptionRow* find(const std::string& key) const;

 private:
  std::vector<OptionRow> rows_;
  std::map<std::string, std::size_t> index_;
};

/// The options in which two columns differ, but for those that another difference takes along: the
/// members that a choice selects, what is in a table that one of them lacks, the elements of lists
/// of different lengths. Elements of one list count as one option.
std::set<std::string> turned_rows(const FlatOptions& a, const FlatOptions& b,
                                  const OptionRows& rows);

/// How far an option, or a value of a choice, has come to be turned.
enum class Turned {
  never,           ///< no two columns differ in it alone
  unknown,         ///< two do, but the reference does not say what they came to
  without_effect,  ///< two do, and came to the same
  with_effect
};

/// A row of the options of a scene or a method, one of its values where it is a choice.
struct OptionUnit {
  std::string where;  ///< "skinning/implicit", "skinning/scene"
  std::string key;    ///< "weights.kind=heat" for a value of a choice
  Turned turned = Turned::never;
  std::string columns = {};  ///< that say so

  /// "skinning/implicit blend=union: never turned".
  [[nodiscard]] std::string text() const;
};

/// An option that is a matter of the user's taste or input, and the test that drives it.
struct UsersChoice {
  std::string where;
  std::string key;
  std::string file;
  std::string test;   ///< "Suite.Test"
  std::string place;  ///< "sketch.txt:3"
};

/// What experiments of a topic turn.
class TurnedOptions {
 public:
  explicit TurnedOptions(const Topic& topic);

  /// Compares the columns of an experiment.
  /// @param blessed  its reference of the same size, null where there is none
  void add(const Experiment& experiment, const BlessedSet* blessed);

  /// Takes over what is known of the scene of a topic that this one uses, of the rows that both
  /// describe alike: what is turned, or a user's choice, there need not be so here.
  /// @param choices  those of the topic that is used
  void share_scene(const TurnedOptions& used, const std::vector<UsersChoice>& choices);

  /// Every row, in the order of the listings: scene first, then the methods in theirs.
  [[nodiscard]] std::vector<OptionUnit> units() const;

 private:
  struct Column;
  struct Evidence {
    Turned turned = Turned::never;
    std::string columns;
  };

  [[nodiscard]] const OptionRows& rows_of(const std::string& place) const;
  void compare(const Experiment& experiment, const BlessedSet* blessed, const Column& a,
               const Column& b);
  void note(const std::string& place, const std::string& row, const std::string& value,
            const Evidence& evidence);
  [[nodiscard]] Evidence evidence_of(const std::string& place, const OptionRow& row,
                                     const std::string& value) const;
  /// Of what several methods share, the best that is known of any.
  [[nodiscard]] Evidence shared_evidence_of(const std::string& place, const OptionRow& row,
                                            const std::string& value) const;
  [[nodiscard]] Turned effect(const Experiment& experiment, const BlessedSet* blessed,
                              const Column& a, const Column& b) const;

  std::string topic_;
  std::vector<std::string> places_;  ///< "scene", then the methods
  std::map<std::string, OptionRows> rows_;
  std::set<std::string> reference_metrics_;
  /// By place, row, and value of a choice ("" of other options).
  std::map<std::string, std::map<std::string, std::map<std::string, Evidence>>> found_;
};

/// One choice a line, `<where> <key> <test file> <Suite.Test>`; lines that begin with # are none.
/// @throws Error  naming the line
std::vector<UsersChoice> users_choices(const std::string& text, const std::string& source);

/// What is wrong, a line each: options that are neither turned nor a user's choice, choices that
/// are turned or that there are not, and tests that do not stand in their file (below `root`) or
/// whose file never says the option's name.
std::vector<std::string> option_problems(const std::vector<OptionUnit>& units,
                                         const std::vector<UsersChoice>& choices,
                                         const std::filesystem::path& root);

}  // namespace geoprior::test
