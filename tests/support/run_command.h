// A shell command, for tests that run another program.
#pragma once

#include <cstdio>
#include <string>

namespace lightgrid {

struct CommandOutcome {
  int status = -1;  // as waitpid gives it; 0 is success
  std::string output;
};

inline CommandOutcome run_command(const std::string& command) {
  CommandOutcome outcome;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  char buffer[4096];
  while (const size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) outcome.output.append(buffer, size);
  outcome.status = pclose(pipe);
  return outcome;
}

}  // namespace lightgrid
