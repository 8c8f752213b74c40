// The parser of the command line behind a narrow door: CLI11 is a large header, and is compiled once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace lightgrid {

// Returns the exit status.
using Command = std::function<int()>;

// One subcommand, to hang options on. Names as CLI11 has them: "-o,--output", or "scene" for a place in the line. A
// value that stands there already is the default, and --help shows it.
class Subcommand {
 public:
  explicit Subcommand(CLI::App& app) : app_(app) {}
  void option(const std::string& names, std::string& value, const std::string& help);
  // Outside least … most is an error; a default outside means "not given".
  void option(const std::string& names, int& value, const std::string& help, int least, int most);
  void option(const std::string& names, uint64_t& value, const std::string& help);
  void flag(const std::string& names, bool& value, const std::string& help);
  // May be given more than once; with a separator, one word may hold several.
  void list(const std::string& names, std::vector<std::string>& values, const std::string& help, char separator = 0);

 private:
  CLI::App& app_;
};

class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& summary);
  ~CommandLine();

  Subcommand add(const std::string& name, const std::string& summary, Command run);

  // What the words name. Help is printed here and named a command that does nothing; what is wrong is said in one line
  // on stderr and named a command that ends with status 2.
  Command parse(int argc, const char* const* argv);

  bool quiet() const { return quiet_; }

 private:
  std::unique_ptr<CLI::App> app_;
  Command chosen_;
  bool quiet_ = false;
};

}  // namespace lightgrid
