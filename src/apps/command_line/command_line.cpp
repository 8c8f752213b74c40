#include "command_line/command_line.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/message_line.h"
#include "base/text.h"
#include "base/version.h"
#include "command_line/help.h"
#include "gl/context.h"

namespace lightgrid::app {

void Subcommand::option(const std::string& names, std::string& value, const std::string& help) {
  CLI::Option* option = app_.add_option(names, value, help)->group(heading_);
  if (!value.empty()) option->capture_default_str();
}

void Subcommand::option(const std::string& names, int& value, const std::string& help, int least, int most) {
  CLI::Option* option = app_.add_option(names, value, help)->check(CLI::Range(least, most))->group(heading_);
  if (value >= least && value <= most) option->capture_default_str();
}

void Subcommand::option(const std::string& names, uint64_t& value, const std::string& help) {
  app_.add_option(names, value, help)->capture_default_str()->group(heading_);
}

void Subcommand::flag(const std::string& names, bool& value, const std::string& help) {
  app_.add_flag(names, value, help)->group(heading_);
}

void Subcommand::list(const std::string& names, std::vector<std::string>& values, const std::string& help,
                      char separator) {
  CLI::Option* option = app_.add_option(names, values, help)->group(heading_);
  // An option takes one word each time: the next word may be a positional argument.
  if (names[0] == '-') option->allow_extra_args(false);
  if (separator) option->delimiter(separator);
  if (!values.empty()) option->capture_default_str();
}

Subcommand::Heading::Heading(Subcommand& command, std::string text)
    : command_(command), outer_(std::exchange(command.heading_, std::move(text))) {}

Subcommand::Heading::~Heading() { command_.heading_ = outer_; }

CommandLine::CommandLine(const std::string& name, const std::string& summary)
    : app_(std::make_unique<CLI::App>(summary, name)) {
  app_->require_subcommand(1);
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->fallthrough();
  app_->add_flag("--quiet", quiet_, "errors only on stderr");
  app_->set_version_flag("--version", name + " " + version_of_build() + ", commit " + commit_of_build(),
                         "the version, and the commit that it was built from");
}

CommandLine::~CommandLine() = default;

Subcommand CommandLine::add(const std::string& name, const std::string& summary, Command run) {
  CLI::App* command = app_->add_subcommand(name, summary);
  command->footer(examples_in_help(name));
  command->final_callback([this, run] { chosen_ = run; });
  return Subcommand(*command);
}

namespace {

// Options whose value is a list. A space after its comma is meant as part of it, and no file's name is one.
constexpr std::array lists = {"-t",     "--technique", "--techniques",   "--size",   "--lights", "--set",
                              "--vary", "--compare",   "--light-radius", "--camera", "--pixel"};

bool is_list(const std::string& option, const std::string& value) {
  if (option == "--camera" && !value.starts_with("eye:") && !value.starts_with("target:"))
    return false;  // a name
  return std::ranges::count(lists, option) > 0;
}

void remove_spaces_after_commas(std::string& value) {
  for (size_t at; (at = value.find(", ")) != std::string::npos;) value.erase(at + 1, 1);
}

// The words after the program's name. Those of a list after whose comma a word ended are joined.
std::vector<std::string> words_of(int argc, const char* const* argv) {
  std::vector<std::string> words;
  bool in_list = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool is_option = word.size() > 1 && word[0] == '-' && !std::isdigit(word[1]) && word[1] != '.';
    if (in_list && !is_option && words.back().ends_with(',')) {
      words.back() += word;
    } else {
      const size_t equals = word.find('=');
      in_list = (!words.empty() && is_list(words.back(), word)) ||
                (is_option && equals != std::string::npos &&
                 is_list(word.substr(0, equals), word.substr(equals + 1)));
      words.push_back(word);
    }
    if (in_list) remove_spaces_after_commas(words.back());
  }
  return words;
}

std::vector<std::string> names_of(const std::vector<CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

// "there is no command rendre; did you mean render?" of the first word that the parser did not expect.
std::string unexpected(const CLI::App& app, const std::vector<CLI::App*>& commands,
                       const std::vector<std::string>& words) {
  const std::vector<std::string> known = names_of(commands);
  const size_t command = size_t(std::ranges::find(known, words.front()) - known.begin());
  if (command == known.size()) {
    return fmt::format("there is no command {}{}; commands are {}", words.front(),
                       did_you_mean(words.front(), known), fmt::join(known, ", "));
  }
  std::vector<std::string> options;
  for (const CLI::App* of : {static_cast<const CLI::App*>(commands[command]), &app}) {
    for (const CLI::Option* option : of->get_options()) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
      for (const std::string& name : option->get_snames()) options.push_back("-" + name);
    }
  }
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (word.size() < 2 || word[0] != '-' || std::ranges::count(options, name) > 0 ||
        parse_number<double>(word))
      continue;
    return fmt::format("{} has no option {}{}", known[command], name, did_you_mean(name, options));
  }
  return {};
}

}  // namespace

Command CommandLine::parse(int argc, const char* const* argv) {
  std::vector<std::string> words = words_of(argc, argv);
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    if (!words.empty()) words.push_back("--help");
  }
  const std::vector<CLI::App*> commands = app_->get_subcommands([](const CLI::App*) { return true; });
  for (CLI::App* command : commands) {
    if (command->get_option_no_throw("--gl")) continue;
    command->add_option("--gl", unused_gl_, "as in other commands; this one opens no OpenGL of its own")
        ->group("Options");
  }
  if (words.empty()) {
    std::fputs(app_->help().c_str(), stdout);
    return [] { return 0; };
  }
  try {
    // The parser would only report that a command is missing.
    const bool is_command = std::ranges::count(names_of(commands), words.front()) > 0;
    if (words.front()[0] != '-' && !is_command) throw CLI::ExtrasError({words.front()});
    app_->parse(std::vector<std::string>(words.rbegin(), words.rend()));
    return [this, run = chosen_] {
      parse_gl_backend(unused_gl_);
      return run();
    };
  } catch (const CLI::ExtrasError& error) {
    const std::string told = unexpected(*app_, commands, words);
    std::fprintf(stderr, "lightgrid: %s (see --help)\n",
                 message_line(told.empty() ? error.what() : told).c_str());
    return [] { return int(ErrorKind::input); };
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help is reported as an error
      app_->exit(error);
      return [] { return 0; };
    }
    std::fprintf(stderr, "lightgrid: %s (see --help)\n", message_line(error.what()).c_str());
    return [] { return int(ErrorKind::input); };
  }
}

std::string CommandLine::with_option(const std::string& message) const {
  const std::string option = "--" + message.substr(0, message.find_first_of(" :"));
  for (const CLI::App* command : app_->get_subcommands()) {
    if (command->get_option_no_throw(option)) return "--" + message;
  }
  return message;
}

}  // namespace lightgrid::app
