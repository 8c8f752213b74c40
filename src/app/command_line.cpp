#include "app/command_line.h"

#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "base/error.h"

namespace lightgrid {

void Subcommand::option(const std::string& names, std::string& value, const std::string& help) {
  CLI::Option* option = app_.add_option(names, value, help);
  if (!value.empty()) option->capture_default_str();
}

void Subcommand::option(const std::string& names, int& value, const std::string& help, int least, int most) {
  CLI::Option* option = app_.add_option(names, value, help)->check(CLI::Range(least, most));
  if (value >= least && value <= most) option->capture_default_str();
}

void Subcommand::option(const std::string& names, uint64_t& value, const std::string& help) {
  app_.add_option(names, value, help)->capture_default_str();
}

void Subcommand::flag(const std::string& names, bool& value, const std::string& help) {
  app_.add_flag(names, value, help);
}

void Subcommand::list(const std::string& names, std::vector<std::string>& values, const std::string& help,
                      char separator) {
  CLI::Option* option = app_.add_option(names, values, help);
  // An option takes one word each time: the next word may be a positional argument.
  if (names[0] == '-') option->allow_extra_args(false);
  if (separator) option->delimiter(separator);
  if (!values.empty()) option->capture_default_str();
}

CommandLine::CommandLine(const std::string& name, const std::string& summary)
    : app_(std::make_unique<CLI::App>(summary, name)) {
  app_->require_subcommand(1);
  app_->fallthrough();
  app_->add_flag("--quiet", quiet_, "errors only on stderr");
}

CommandLine::~CommandLine() = default;

Subcommand CommandLine::add(const std::string& name, const std::string& summary, Command run) {
  CLI::App* command = app_->add_subcommand(name, summary);
  command->final_callback([this, run] { chosen_ = run; });
  return Subcommand(*command);
}

Command CommandLine::parse(int argc, const char* const* argv) {
  try {
    // The parser would only report that a command is missing.
    const auto is_command = [&](const std::string& name) {
      return !app_->get_subcommands([&](const CLI::App* c) { return c->get_name() == name; }).empty();
    };
    if (argc > 1 && argv[1][0] != '-' && !is_command(argv[1])) throw CLI::ExtrasError({argv[1]});
    app_->parse(argc, argv);
    return chosen_;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help is reported as an error
      app_->exit(error);
      return [] { return 0; };
    }
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::fprintf(stderr, "lightgrid: %s (see --help)\n", line.c_str());
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

}  // namespace lightgrid
