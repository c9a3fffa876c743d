#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace geoprior {

/// The rule for names that become files and folders (docs/experiments.md#names): cases, variants,
/// parts, tables, artifacts and the two halves of an experiment's identifier, whether an experiment
/// file, a method, a run.h5 or a journal says them. No such name leaves the folder it is put in.

/// Bytes; a number, an extension and the temporary suffix still fit behind it (255 in all).
inline constexpr std::size_t kLongestName = 128;

/// 1 to `kLongestName` letters, digits and _ - . + = , (ASCII), no dot in front, not what ends the
/// names of temporary files.
bool is_name(std::string_view name);
/// As `is_name`, but long enough for a frame's number and extension behind the name of a part.
bool is_file_name(std::string_view name);
/// Letters, digits, - and _ only: names that dotted keys and run references take apart.
bool is_plain_name(std::string_view name);

/// @param what   "a case", "an artifact"
/// @param where  file and line, or the place in a run
/// @throws Error  unless `is_name`, or `is_plain_name`
void require_name(std::string_view name, const std::string& what, const std::string& where);
void require_plain_name(std::string_view name, const std::string& what, const std::string& where);

/// A name that is no file's (a study's): UTF-8 of 1 to 200 bytes on one line.
void require_text_name(std::string_view name, const std::string& what, const std::string& where);

/// Words for people, a title or a claim: UTF-8 on one line, of any length.
void require_line(std::string_view text, const std::string& what, const std::string& where);

/// An experiment's identifier is two names: "skinning/knee".
bool is_experiment_id(std::string_view id);
void require_experiment_id(std::string_view id, const std::string& where);

/// The text with - in the place of each byte that no name has; its length stays.
std::string with_name_characters(std::string_view text);
/// A name made of any text, such as that of a file.
std::string name_from(std::string_view text);

/// The text on one line and not too long, in quotes, for messages about names that are none.
std::string quoted_name(std::string_view text);

}  // namespace geoprior
