#include "testbed/commands/shell/completion.h"

#include <algorithm>
#include <set>

#include "testbed/catalogue.h"

namespace geoprior {
namespace {

std::string joined_by(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// With `with` in the place of each character of `which`, where "&" is that character.
std::string escaped_for(const std::string& text, const std::string& which,
                        const std::string& before) {
  std::string out;
  for (const char c : text) out += (which.find(c) == std::string::npos ? "" : before) + c;
  return out;
}

/// Between single quotes, as bash and zsh read them.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::vector<std::string> names_of_commands(const CommandTree& program) {
  std::vector<std::string> names;
  for (const CommandTree& command : program.commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> all_flags(const CommandTree& command) {
  std::vector<std::string> flags;
  for (const CommandWord& option : command.options) {
    flags.insert(flags.end(), option.flags.begin(), option.flags.end());
  }
  return flags;
}

std::vector<std::string> flags_with_values(const CommandTree& command) {
  std::vector<std::string> flags;
  for (const CommandWord& option : command.options) {
    if (option.takes_value()) flags.insert(flags.end(), option.flags.begin(), option.flags.end());
  }
  return flags;
}

std::string first_line_of_script(const std::string& shell) {
  return "# Made by: geoprior completion " + shell + "\n";
}

// ---------------------------------------------------------------------------------------- bash

// Names of files are quoted by bash, and a folder is gone on into, where it is told that they are
// names of files; an identifier is written like one.
constexpr const char* kBashHelpers = R"(
_geoprior_offer() {
  local current=$1 offer=$2
  case $offer in
    experiments | runs | files | folders) compopt -o filenames 2>/dev/null ;;
  esac
  case $offer in
    experiments) mapfile -t COMPREPLY < <(compgen -W "$_geoprior_experiments" -- "$current"; compgen -f -X '!*.toml' -- "$current"; compgen -d -- "$current") ;;
    runs) mapfile -t COMPREPLY < <(compgen -W "$_geoprior_experiments" -- "$current"; compgen -f -- "$current") ;;
    names) mapfile -t COMPREPLY < <(compgen -W "$_geoprior_names" -- "$current") ;;
    files) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
    folders) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    nothing) COMPREPLY=() ;;
    *) mapfile -t COMPREPLY < <(compgen -W "${offer#choices }" -- "$current") ;;
  esac
}

# How many arguments stand before the word that is completed: neither options nor their values, of those in $1.
_geoprior_place() {
  local i
  place=0
  for ((i = 2; i < COMP_CWORD; i++)); do
    if [[ " $1 " == *" ${COMP_WORDS[i]} "* ]]; then
      [[ ${COMP_WORDS[i + 1]} == = ]] && i=$((i + 1))
      i=$((i + 1))
      # bash parts words at "=": KEY=VALUE are three.
      while [[ ${COMP_WORDS[i + 1]} == = ]] && ((i + 2 < COMP_CWORD)); do i=$((i + 2)); done
    elif [[ ${COMP_WORDS[i]} != -* ]]; then
      place=$((place + 1))
    fi
  done
}

_geoprior() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
  COMPREPLY=()
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)";

std::string bash_offer(const CommandWord& word) {
  switch (word.offer) {
    case Offer::experiments:
      return "experiments";
    case Offer::runs:
      return "runs";
    case Offer::names:
      return "names";
    case Offer::files:
      return "files";
    case Offer::folders:
      return "folders";
    case Offer::choices:
      return "choices " + joined_by(word.choices, " ");
    case Offer::nothing:
      break;
  }
  return "nothing";
}

/// What follows an option that takes a value, of one command.
std::string bash_values(const CommandTree& command) {
  std::string text;
  for (const CommandWord& option : command.options) {
    if (!option.takes_value()) continue;
    std::vector<std::string> patterns;
    for (const std::string& flag : option.flags) patterns.push_back(command.name + ":" + flag);
    text += "    " + joined_by(patterns, " | ") + ") _geoprior_offer \"$current\" " +
            shell_quoted(bash_offer(option)) + "; return ;;\n";
  }
  return text;
}

/// What may stand at each place: of the last argument also behind it, where it takes several.
std::string bash_arguments(const CommandTree& command) {
  std::string text;
  for (const CommandWord& argument : command.arguments) {
    text += (text.empty() ? "" : " ") + shell_quoted(bash_offer(argument));
  }
  const bool has_no_end = !command.arguments.empty() && command.arguments.back().repeated;
  return "(" + text +
         ") more=" + shell_quoted(has_no_end ? bash_offer(command.arguments.back()) : "nothing");
}

std::string bash_words(const CommandTree& command) {
  return "    " + command.name + ") options=" + shell_quoted(joined_by(all_flags(command), " ")) +
         " valued=" + shell_quoted(joined_by(flags_with_values(command), " ")) +
         " arguments=" + bash_arguments(command) + " ;;\n";
}

// ----------------------------------------------------------------------------------------- zsh

/// Within the specification of an option or an argument.
std::string zsh_text(const std::string& text) { return escaped_for(text, "\\[]:", "\\"); }

std::string zsh_action(const CommandWord& word) {
  switch (word.offer) {
    case Offer::experiments:
      return "_geoprior_experiments";
    case Offer::runs:
      return "_geoprior_runs";
    case Offer::names:
      return "_geoprior_names";
    case Offer::files:
      return "_files";
    case Offer::folders:
      return "_files -/";
    case Offer::choices:
      return "(" + joined_by(word.choices, " ") + ")";
    case Offer::nothing:
      break;
  }
  return " ";
}

/// A flag of a value, which may follow it in the same word: --format=ply, -fply.
std::string zsh_flag(const std::string& flag) {
  return flag + (flag.starts_with("--") ? "=" : "+");
}

std::string zsh_option(const CommandWord& option) {
  std::string rest = "[" + zsh_text(option.description) + "]";
  if (option.takes_value()) rest += ":" + zsh_text(option.value) + ":" + zsh_action(option);
  std::vector<std::string> flags = option.flags;
  if (option.takes_value()) std::transform(flags.begin(), flags.end(), flags.begin(), zsh_flag);
  const std::string often = option.repeated ? "*" : "";
  if (flags.size() == 1) return shell_quoted(often + flags.front() + rest);
  const std::string others = option.repeated ? "*" : "(" + joined_by(option.flags, " ") + ")";
  return shell_quoted(others) + "{" + joined_by(flags, ",") + "}" + shell_quoted(rest);
}

std::string zsh_argument(const CommandWord& argument, std::size_t place) {
  const std::string at = argument.repeated ? "*" : std::to_string(place);
  return shell_quoted(at + ":" + zsh_text(argument.value) + ":" + zsh_action(argument));
}

std::string zsh_arguments(const CommandTree& command, const std::string& indent) {
  std::string text;
  for (const CommandWord& option : command.options) {
    text += " \\\n" + indent + zsh_option(option);
  }
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    text += " \\\n" + indent + zsh_argument(command.arguments[i], i + 1);
  }
  return text;
}

std::string zsh_list(const std::string& function, const std::vector<std::string>& words) {
  return "\n" + function + "() {\n  local -a words\n  words=(" + joined_by(words, " ") +
         ")\n  compadd -a words\n}\n";
}

// ---------------------------------------------------------------------------------------- fish

std::string fish_quoted(const std::string& text) {
  return "'" + escaped_for(text, "\\'", "\\") + "'";
}

/// The part of a `complete` that says what may stand there.
std::string fish_action(const CommandWord& word) {
  switch (word.offer) {
    case Offer::experiments:
      return " -k -a '(__geoprior_experiments; __fish_complete_suffix .toml)'";
    case Offer::runs:
      return " -F -k -a '(__geoprior_experiments)'";
    case Offer::names:
      return " -a '(__geoprior_names)'";
    case Offer::files:
      return " -F";
    case Offer::folders:
      return " -a '(__fish_complete_directories)'";
    case Offer::choices:
      return " -a " + fish_quoted(joined_by(word.choices, " "));
    case Offer::nothing:
      break;
  }
  return "";
}

std::string fish_option(const CommandWord& option) {
  std::string text;
  for (const std::string& flag : option.flags) {
    const bool is_long = flag.starts_with("--");
    text += is_long ? " -l " + flag.substr(2) : " -s " + flag.substr(1);
  }
  if (option.takes_value()) {
    text += (option.offer == Offer::files ? " -r" : " -x") + fish_action(option);
  }
  return text + " -d " + fish_quoted(option.description);
}

constexpr const char* kFishPlace = R"(
# How many arguments stand before the word that is completed: neither options nor their values, of those in $argv.
function __geoprior_place
  set -l place 0
  set -l is_value no
  for word in (commandline -opc)[3..-1]
    if test $is_value = yes
      set is_value no
    else if contains -- $word $argv
      set is_value yes
    else if not string match -q -- '-*' $word
      set place (math $place + 1)
    end
  end
  echo $place
end
)";

std::string fish_list(const std::string& function, const std::vector<std::string>& words) {
  return "\nfunction " + function + "\n  printf '%s\\n' " + joined_by(words, " ") + "\nend\n";
}

/// Arguments are offered at their places only; the last one also behind, where it takes several.
std::string fish_command(const CommandTree& command) {
  const std::string of_command =
      "complete -c geoprior -n '__geoprior_command " + command.name + "'";
  std::string text;
  for (const CommandWord& option : command.options) text += of_command + fish_option(option) + "\n";
  const std::string valued = joined_by(flags_with_values(command), " ");
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const CommandWord& argument = command.arguments[i];
    text += "complete -c geoprior -n '__geoprior_command " + command.name +
            "; and test (__geoprior_place " + valued + ") " +
            (argument.repeated ? "-ge " : "-eq ") + std::to_string(i) + "'" +
            fish_action(argument) + "\n";
  }
  return text;
}

}  // namespace

OfferedNames OfferedNames::of(const std::vector<Topic>& topics) {
  OfferedNames names;
  for (const CatalogueEntry& entry : catalogue()) names.experiments.push_back(entry.id);
  std::set<std::string> described{"experiment"};
  for (const Topic& topic : topics) {
    described.insert(topic.name);
    for (const MethodEntry& method : topic.methods) described.insert(method.name);
    for (const std::string& metric : metric_names(topic)) described.insert(metric);
    for (const TopicFile& file : topic.files) described.insert(file.name);
  }
  names.described.assign(described.begin(), described.end());
  return names;
}

std::string bash_completion(const CommandTree& program, const OfferedNames& names) {
  std::string text = first_line_of_script("bash");
  text += "_geoprior_experiments=" + shell_quoted(joined_by(names.experiments, " ")) + "\n";
  text += "_geoprior_names=" + shell_quoted(joined_by(names.described, " ")) + "\n";
  text += kBashHelpers;
  text += "  if ((COMP_CWORD == 1)); then\n    _geoprior_offer \"$current\" " +
          shell_quoted("choices " + joined_by(names_of_commands(program), " ") + " " +
                       joined_by(all_flags(program), " ")) +
          "\n    return\n  fi\n  case $command:$previous in\n";
  for (const CommandTree& command : program.commands) text += bash_values(command);
  text +=
      "  esac\n  local options='' valued='' arguments=() more=nothing place\n  case $command in\n";
  for (const CommandTree& command : program.commands) text += bash_words(command);
  text +=
      "  esac\n  if [[ $current == -* ]]; then\n    _geoprior_offer \"$current\" "
      "\"choices $options\"\n  else\n    _geoprior_place \"$valued\"\n"
      "    _geoprior_offer \"$current\" \"${arguments[place]:-$more}\"\n  fi\n}\n\n"
      "complete -F _geoprior geoprior\n";
  return text;
}

std::string zsh_completion(const CommandTree& program, const OfferedNames& names) {
  std::string text = "#compdef geoprior\n" + first_line_of_script("zsh");
  text += zsh_list("_geoprior_experiment_ids", names.experiments);
  text += zsh_list("_geoprior_names", names.described);
  text +=
      "\n_geoprior_experiments() { _alternative 'id:experiment:_geoprior_experiment_ids' "
      "'file:file:_files -g \"*.toml\"' }\n"
      "_geoprior_runs() { _alternative 'id:experiment:_geoprior_experiment_ids' "
      "'file:run:_files' }\n";
  text +=
      "\n_geoprior() {\n  local curcontext=$curcontext state line\n  typeset -A opt_args\n"
      "  _arguments -C" +
      zsh_arguments(program, "    ") +
      " \\\n    '1:command:->command' '*::argument:->argument' && return\n"
      "  case $state in\n    command)\n      local -a commands\n      commands=(\n";
  for (const CommandTree& command : program.commands) {
    text += "        " +
            shell_quoted(command.name + ":" + escaped_for(command.description, "\\:", "\\")) + "\n";
  }
  text +=
      "      )\n      _describe command commands ;;\n    argument)\n"
      "      case $words[1] in\n";
  for (const CommandTree& command : program.commands) {
    text += "        " + command.name + ")\n          _arguments" +
            zsh_arguments(command, "            ") + " ;;\n";
  }
  text +=
      "      esac ;;\n  esac\n}\n\n"
      "# Loaded by its name, or sourced.\n"
      "if [[ $funcstack[1] == _geoprior ]]; then\n  _geoprior \"$@\"\nelse\n"
      "  compdef _geoprior geoprior\nfi\n";
  return text;
}

std::string fish_completion(const CommandTree& program, const OfferedNames& names) {
  std::string text = first_line_of_script("fish");
  text += fish_list("__geoprior_experiments", names.experiments);
  text += fish_list("__geoprior_names", names.described);
  text += kFishPlace;
  text +=
      "\nfunction __geoprior_command\n  set -l words (commandline -opc)\n"
      "  test (count $words) -ge 2; and test $words[2] = $argv[1]\nend\n"
      "\nfunction __geoprior_no_command\n  test (count (commandline -opc)) -eq 1\nend\n\n"
      "complete -c geoprior -f\n";
  const std::string begin = "complete -c geoprior -n __geoprior_no_command";
  for (const CommandWord& option : program.options) text += begin + fish_option(option) + "\n";
  for (const CommandTree& command : program.commands) {
    text += begin + " -a " + command.name + " -d " + fish_quoted(command.description) + "\n";
  }
  for (const CommandTree& command : program.commands) text += "\n" + fish_command(command);
  return text;
}

}  // namespace geoprior
