// The text of --help: wrapped lines, and examples of each command.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lightgrid::app {

// Wraps descriptions at the width of the terminal on stdout, else at 100 columns.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_description(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_group(std::string heading, bool positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool positional) const override;

 private:
  const size_t width_;
};

// Three calls of a command with a comment each, below "Examples:"; empty for a command without.
std::string examples_in_help(const std::string& command);

}  // namespace lightgrid::app
