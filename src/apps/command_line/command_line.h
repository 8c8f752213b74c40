// Wraps the command-line parser: CLI11 is a large header, and is compiled only once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace lightgrid::app {

// Returns the exit status.
using Command = std::function<int()>;

// One subcommand, for options. Names as in CLI11: "-o,--output", or "scene" for a positional argument. The
// current value of the variable is the default, and --help shows it.
class Subcommand {
 public:
  explicit Subcommand(CLI::App& app) : app_(app) {}
  void option(const std::string& names, std::string& value, const std::string& help);
  // Values outside least … most are errors; a default outside means "not given".
  void option(const std::string& names, int& value, const std::string& help, int least, int most);
  void option(const std::string& names, uint64_t& value, const std::string& help);
  void flag(const std::string& names, bool& value, const std::string& help);
  // May be given more than once; with a separator, one word may hold several values.
  void list(const std::string& names, std::vector<std::string>& values, const std::string& help,
            char separator = 0);

  // While it exists, options are added below this heading of --help, instead of "Options".
  class Heading {
   public:
    Heading(Subcommand& command, std::string text);
    ~Heading();
    Heading(const Heading&) = delete;
    Heading& operator=(const Heading&) = delete;

   private:
    Subcommand& command_;
    const std::string outer_;
  };

 private:
  CLI::App& app_;
  std::string heading_ = "Options";
};

class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& summary);
  ~CommandLine();

  Subcommand add(const std::string& name, const std::string& summary, Command run);

  // The command that the words select. Help is printed here and returns a command that does nothing; an error
  // is printed in one line on stderr and returns a command that ends with status 2.
  Command parse(int argc, const char* const* argv);

  // A message of a run, which begins with the name of a field ("size 0x0: …"), as the user gave it ("--size
  // 0x0: …"). Other messages stay as they are.
  std::string with_option(const std::string& message) const;

  // All commands described as text: a man page ("page", roff) or completions for "bash", "zsh" or "fish".
  // Throws Error(input) for another form.
  std::string manual(const std::string& form) const;

  bool quiet() const { return quiet_; }

 private:
  std::unique_ptr<CLI::App> app_;
  Command chosen_;
  bool quiet_ = false;
  std::string unused_gl_ = "auto";  // for commands that open no OpenGL and only check the option
};

}  // namespace lightgrid::app
