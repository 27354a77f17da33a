#include "tools/manual/completion.h"

namespace misfit::tools {
namespace {

/// Adds the lines of one command for the functions below: "'image --vis') most=…".
void add_cases(const CommandFacts& command, std::string& words, std::string& values) {
  const std::string name = joined(command.words, " ");
  std::string all;
  for (const CommandFacts& each : command.commands) all += (all.empty() ? "" : " ") + each.words.back();
  for (const OptionFacts& option : command.options)
    for (const std::string& typed : option.names) {
      all += (all.empty() ? "" : " ") + typed;
      if (option.most == 0) continue;
      values += "    '" + name + ' ' + typed + "') most=" + std::to_string(option.most);
      if (!option.choices.empty()) values += " choices='" + joined(option.choices, " ") + '\'';
      if (option.takes_file() || option.takes_folder()) values += option.takes_file() ? " paths=-f" : " paths=-d";
      values += " ;;\n";
    }
  words += "    '" + name + "') words='" + all + "' ;;\n";
  for (const CommandFacts& each : command.commands) add_cases(each, words, values);
}

/// Words are as bash divides lines: --option=value is three of them. A word that begins with - and no digit is an option; a
/// word after the program, or after an option that takes no more values, is a command.
constexpr const char* complete_line = R"sh(
_misfit() {
  local word=${COMP_WORDS[COMP_CWORD]} command=misfit option='' given=0 i each
  local words most paths choices
  [[ $word != = ]] || word=''
  for ((i = 1; i < COMP_CWORD; ++i)); do
    each=${COMP_WORDS[i]}
    case $each in
      =) ;;
      -[!0-9.]*) option=$each given=0 ;;
      *)
        if [[ $option ]]; then
          given=$((given + 1))
        else
          command+=" $each"
        fi
        ;;
    esac
  done
  COMPREPLY=()
  _misfit_values "$command $option"
  if ((given < most)) && [[ $word != -[!0-9.]* ]]; then
    mapfile -t COMPREPLY < <(
      compgen -W "$choices" -- "$word"
      [[ ! $paths ]] || compgen "$paths" -- "$word"
    )
    [[ ! $paths ]] || compopt -o filenames 2>/dev/null
  else
    _misfit_words "$command"
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  fi
}
complete -F _misfit misfit
)sh";

}  // namespace

std::string bash_completion(const CommandFacts& program) {
  std::string words, values;
  add_cases(program, words, values);
  return "# bash completion for misfit, made from its options\n\n"
         "# what can follow a command\n"
         "_misfit_words() {\n  words=''\n  case $1 in\n" +
         words +
         "  esac\n}\n\n"
         "# how many values an option takes, which ones, and whether they are files (-f) or folders (-d)\n"
         "_misfit_values() {\n  most=0 choices='' paths=''\n  case $1 in\n" +
         values + "  esac\n}\n" + complete_line;
}

}  // namespace misfit::tools
