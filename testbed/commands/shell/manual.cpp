#include "testbed/commands/shell/manual.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

namespace geoprior {
namespace {

struct Variable {
  const char* name;
  const char* meaning;
};

constexpr std::array<Variable, 5> kVariables{
    {{"GEOPRIOR_HOME",
      "the clone, or the folder with experiments/, data/ and results/ that is read"},
     {"GEOPRIOR_RUNS", "where runs go, and are looked for"},
     {"GEOPRIOR_PYTHON", "the interpreter that has h5py, matplotlib and numpy"},
     {"GEOPRIOR_MEMORY_GB", "how much memory a run may ask for, in 10^9 bytes"},
     {"XDG_DATA_HOME", "an installed program keeps runs in geoprior/results/runs below it"}}};

/// A text that the formatter takes for no command: hyphens stay hyphens when they are copied.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      const bool begins_line = out.empty() || out.back() == '\n';
      if (begins_line && (c == '.' || c == '\'')) out += "\\&";
      out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string heading_of(const CommandWord& option) {
  std::string text;
  for (const std::string& flag : option.flags) text += (text.empty() ? "" : ", ") + bold(flag);
  if (!option.takes_value()) return text;
  return text + (text.empty() ? "" : " ") + italic(option.value) + (option.repeated ? " ..." : "");
}

/// `[--option VALUE]`, or without brackets where it must be there.
std::string in_synopsis(const CommandWord& word) {
  return word.required ? heading_of(word) : "[" + heading_of(word) + "]";
}

std::string tagged(const std::string& heading, const std::string& meaning) {
  return ".TP\n" + heading + "\n" + roff(meaning) + "\n";
}

bool is_help(const CommandWord& option) { return option.flags.back() == "--help"; }

std::string section_of_command(const CommandTree& command) {
  std::string text = ".SS " + command.name + "\n" + bold("geoprior " + command.name);
  for (const CommandWord& option : command.options) {
    if (!is_help(option)) text += "\n" + in_synopsis(option);
  }
  for (const CommandWord& argument : command.arguments) text += "\n" + in_synopsis(argument);
  text += "\n.PP\n" + roff(command.description) + ".\n";
  for (const CommandWord& argument : command.arguments) {
    text += tagged(heading_of(argument), argument.description);
  }
  for (const CommandWord& option : command.options) {
    if (!is_help(option)) text += tagged(heading_of(option), option.description);
  }
  return text;
}

std::string in_capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// A paragraph "Title: text" of the footer as a section; indented lines stay lines.
std::string section_of_footer(const std::string& paragraph) {
  const std::size_t colon = paragraph.find(':');
  std::string text = ".SH " + in_capitals(paragraph.substr(0, colon)) + "\n";
  std::istringstream lines(paragraph.substr(colon + 1));
  bool as_it_is = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    if (begin >= 2 && !as_it_is) text += ".nf\n";
    as_it_is = as_it_is || begin >= 2;
    text += roff(line.substr(begin)) + "\n";
  }
  return text + (as_it_is ? ".fi\n" : "");
}

std::string sections_of_footer(const std::string& footer) {
  std::string text;
  for (std::size_t begin = 0; begin < footer.size();) {
    const std::size_t end = std::min(footer.find("\n\n", begin), footer.size());
    text += section_of_footer(footer.substr(begin, end - begin));
    begin = end + 2;
  }
  return text;
}

}  // namespace

std::string manual_page(const CommandTree& program, const std::string& date,
                        const std::string& version) {
  std::string text = ".TH GEOPRIOR 1 " + date + " \"geoprior " + version +
                     "\" \"User Commands\"\n.SH NAME\ngeoprior \\- " + roff(program.description) +
                     "\n.SH SYNOPSIS\n" + bold("geoprior") + "\n" + italic("command") + "\n[" +
                     italic("options") + "]\n[" + italic("arguments") + "]\n.SH OPTIONS\n";
  for (const CommandWord& option : program.options) {
    text += tagged(heading_of(option), option.description);
  }
  text += ".SH COMMANDS\n";
  for (const CommandTree& command : program.commands) text += section_of_command(command);
  text += ".SH ENVIRONMENT\n";
  for (const Variable& variable : kVariables) text += tagged(bold(variable.name), variable.meaning);
  return text + sections_of_footer(program.footer);
}

}  // namespace geoprior
