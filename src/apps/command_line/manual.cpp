// lightgrid manual FORM: the man page, and completions for shells, from the same table as --help.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/version.h"
#include "command_line/commands.h"
#include "plan/settings.h"
#include "scenes/builtin.h"
#include "techniques/technique.h"

namespace lightgrid::app {
namespace {

std::vector<CLI::App*> commands_of(CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// The options of a command and those of all commands, without positional arguments.
std::vector<const CLI::Option*> options_of(const CLI::App& command, const CLI::App& app) {
  std::vector<const CLI::Option*> options;
  const auto add = [&](const CLI::Option* option) {
    const bool there = std::ranges::find(options, option->get_name(),
                                         [](const CLI::Option* o) { return o->get_name(); }) != options.end();
    if (!option->get_positional() && !there) options.push_back(option);
  };
  for (const CLI::Option* option : command.get_options()) add(option);
  for (const CLI::Option* option : app.get_options()) add(option);
  return options;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

// The values that may follow an option, or stand for the scene; empty: anything.
std::vector<std::string> values_of(const std::string& name) {
  std::vector<std::string> values;
  if (name == "--technique" || name == "--techniques") {
    for (const Technique* technique : techniques()) values.emplace_back(technique->name);
  } else if (name == "scene") {
    for (const BuiltinScene& scene : builtin_scenes()) values.emplace_back(scene.name);
  } else if (name == "--set" || name == "--vary") {
    for (const auto& [key, value] : to_strings(Settings{})) {
      values.push_back(key + "=");
      std::ranges::replace(values.back(), '_', '-');
    }
  } else if (name == "--gl") {
    values = {"auto", "osmesa", "egl", "none"};
  } else if (name == "--shadows") {
    values = {"all", "none"};
  }
  return values;
}

bool is_scene(const CLI::App& command) {
  const auto positionals = command.get_options([](const CLI::Option* o) { return o->get_positional(); });
  return !positionals.empty() && positionals.front()->get_name().starts_with("scene");
}

std::string replaced(std::string text, const std::vector<std::pair<char, const char*>>& replacements) {
  std::string out;
  for (const char c : text) {
    const auto found = std::ranges::find(replacements, c, &std::pair<char, const char*>::first);
    out += found == replacements.end() ? std::string(1, c) : found->second;
  }
  return out;
}

std::string roff(const std::string& text) { return replaced(text, {{'\\', "\\e"}, {'-', "\\-"}}); }

void add_page_options(std::string& page, const std::vector<const CLI::Option*>& options) {
  for (const CLI::Option* option : options) {
    const std::string type = option->get_type_name(), value = type.substr(0, type.find(':'));
    const std::string names = option->get_positional()
                                  ? option->get_name(true)
                                  : fmt::format("{}", fmt::join(names_of(*option), ", "));
    page += fmt::format(".TP\n\\fB{}\\fR{}\n\\&{}\n", roff(names),
                        takes_value(*option) && !option->get_positional() ? " \\fI" + value + "\\fR" : "",
                        roff(option->get_description()));
    if (!option->get_default_str().empty())
      page += roff(fmt::format("(default: {})\n", option->get_default_str()));
  }
}

std::string man_page(CLI::App& app) {
  std::string page = fmt::format(
      ".TH LIGHTGRID 1 \"\" \"lightgrid {}\" \"User Commands\"\n.SH NAME\nlightgrid \\- {}\n.SH SYNOPSIS\n"
      ".B lightgrid\n\\fICOMMAND\\fR [\\fIOPTION\\fR...] [\\fIARGUMENT\\fR...]\n.SH OPTIONS OF EVERY "
      "COMMAND\n",
      version_of_build(), roff(app.get_description().substr(app.get_description().find(": ") + 2)));
  add_page_options(page, options_of(app, app));
  page += ".SH COMMANDS\n";
  for (CLI::App* command : commands_of(app)) {
    page += fmt::format(".SS lightgrid {}\n\\&{}\n", command->get_name(), roff(command->get_description()));
    const CLI::App& own = *command;
    std::vector<const CLI::Option*> options;
    for (const CLI::Option* option : own.get_options()) options.push_back(option);
    add_page_options(page, options);
  }
  page +=
      ".SH EXIT STATUS\n0: done. 1: the run found a failure that it looks for, such as a lost light. 2: "
      "wrong "
      "arguments or files. 3: the machine lacks something.\n.SH SETTINGS\nKeys of \\fB\\-\\-set\\fR: " +
      roff(fmt::format("{}", fmt::join(values_of("--set"), " "))) + "\n";
  return page;
}

std::string bash_completion(CLI::App& app) {
  std::string commands, options, values;
  for (CLI::App* command : commands_of(app)) {
    commands += command->get_name() + " ";
    std::string words;
    for (const CLI::Option* option : options_of(*command, app))
      words += fmt::format("{} ", fmt::join(names_of(*option), " "));
    options += fmt::format("    {}) options=\"{}\"; scenes={} ;;\n", command->get_name(), words,
                           is_scene(*command) ? 1 : 0);
  }
  for (const char* name : {"--set", "--vary", "--gl", "--shadows"})
    values += fmt::format("    {}) words=\"{}\" ;;\n", name, fmt::join(values_of(name), " "));
  values += fmt::format("    -t|--technique|--techniques) words=\"{}\" ;;\n",
                        fmt::join(values_of("--technique"), " "));
  return fmt::format(R"(# bash completion for lightgrid, made by `lightgrid manual bash`
_lightgrid() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} words="" options="" scenes=0
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "{}" -- "$current")
    return
  fi
  case $before in
{}  esac
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ -n $words ]]; then
    [[ $words != *= ]] || compopt -o nospace 2>/dev/null
  elif [[ $current == -* ]]; then
    words=$options
  elif ((scenes)) && [[ $before != -* ]]; then
    words="{}"
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o bashdefault -o default -F _lightgrid lightgrid
)",
                     commands, values, options, fmt::join(values_of("scene"), " "));
}

std::string zsh_quoted(const std::string& text) {
  return replaced(text, {{'\'', "'\\''"}, {'[', "("}, {']', ")"}, {':', "\\:"}});
}

std::string zsh_completion(CLI::App& app) {
  std::string commands, cases;
  for (CLI::App* command : commands_of(app)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), zsh_quoted(command->get_description()));
    cases += fmt::format("    {}) _arguments \\\n", command->get_name());
    for (const CLI::Option* option : options_of(*command, app)) {
      const std::vector<std::string> names = names_of(*option);
      const std::vector<std::string> values = values_of(names.back());
      for (const std::string& name : names) {
        cases += fmt::format("      '*{}[{}]{}' \\\n", name, zsh_quoted(option->get_description()),
                             !takes_value(*option) ? ""
                             : values.empty()      ? ":value:_files"
                                                   : fmt::format(":value:({})", fmt::join(values, " ")));
      }
    }
    cases += fmt::format("      '*:argument:{}' ;;\n",
                         is_scene(*command)
                             ? fmt::format("{{_values scene {}; _files}}", fmt::join(values_of("scene"), " "))
                             : "_files");
  }
  return fmt::format(R"(#compdef lightgrid
# zsh completion for lightgrid, made by `lightgrid manual zsh`
_lightgrid() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  shift words; ((CURRENT--))
  case $words[1] in
{}  esac
}}
_lightgrid "$@"
)",
                     commands, cases);
}

std::string fish_quoted(const std::string& text) { return replaced(text, {{'\\', "\\\\"}, {'\'', "\\'"}}); }

std::string fish_completion(CLI::App& app) {
  std::string text = "# fish completion for lightgrid, made by `lightgrid manual fish`\n";
  for (CLI::App* command : commands_of(app)) {
    text += fmt::format("complete -c lightgrid -n __fish_use_subcommand -a {} -d '{}'\n", command->get_name(),
                        fish_quoted(command->get_description()));
    const std::string of =
        fmt::format("complete -c lightgrid -n '__fish_seen_subcommand_from {}'", command->get_name());
    if (is_scene(*command)) text += fmt::format("{} -a '{}'\n", of, fmt::join(values_of("scene"), " "));
    for (const CLI::Option* option : options_of(*command, app)) {
      text += of;
      for (const std::string& name : option->get_snames()) text += " -s " + name;
      for (const std::string& name : option->get_lnames()) text += " -l " + name;
      const std::string name = names_of(*option).back();
      const std::vector<std::string> values = values_of(name);
      if (takes_value(*option))
        text += values.empty() ? " -r" : fmt::format(" -x -a '{}'", fmt::join(values, " "));
      text += fmt::format(" -d '{}'\n", fish_quoted(option->get_description()));
    }
  }
  return text;
}

}  // namespace

std::string CommandLine::manual(const std::string& form) const {
  if (form == "page") return man_page(*app_);
  if (form == "bash") return bash_completion(*app_);
  if (form == "zsh") return zsh_completion(*app_);
  if (form == "fish") return fish_completion(*app_);
  throw input_error("form {}: neither page, bash, zsh nor fish", form);
}

void add_manual(CommandLine& line) {
  auto form = std::make_shared<std::string>("page");
  Subcommand command = line.add("manual", "the man page, or completions for a shell", [&line, form] {
    fmt::print("{}", line.manual(*form));
    return 0;
  });
  command.option("form", *form, "page (for man), bash, zsh or fish");
}

}  // namespace lightgrid::app
