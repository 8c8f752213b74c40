// Runs the lightgrid program, and records its output and exit status.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "support/paths.h"
#include "support/temp_folder.h"

namespace lightgrid {

struct ProgramRun {
  int status = -1;  // the exit status; -1: ended by a signal, or still running at the time limit
  int signal = 0;
  bool timed_out = false;
  std::string out, err;
};

// The first word is a program, found in PATH. `environment`: NAME=VALUE each, in addition to the test's own.
// Lines of progress, which depend on the machine's speed, are off unless it enables them. `out_file`: for
// stdout, which is then not recorded.
inline ProgramRun run_words(std::vector<std::string> words, std::vector<std::string> environment = {},
                            std::chrono::seconds limit = std::chrono::seconds(120),
                            const std::string& out_file = {}) {
  environment.emplace_back("LIGHTGRID_PROGRESS_S=86400");
  const TempFolder folder;
  const std::string out = out_file.empty() ? std::string(folder.path / "stdout") : out_file,
                    err = folder.path / "stderr";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);

  std::vector<char*> argv, envp;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // The first of two entries with one name is used: ours come first.
  for (std::string& variable : environment) envp.push_back(variable.data());
  for (char** variable = environ; *variable; ++variable) envp.push_back(*variable);
  envp.push_back(nullptr);

  ProgramRun run;
  pid_t pid = 0;
  const int failure = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return run;

  const auto end = std::chrono::steady_clock::now() + limit;
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end && !run.timed_out) {
      run.timed_out = true;
      kill(pid, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (WIFEXITED(status)) run.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
  const auto text_of = [](const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  if (out_file.empty()) run.out = text_of(out);
  run.err = text_of(err);
  return run;
}

inline ProgramRun run_program(std::vector<std::string> arguments,
                              const std::vector<std::string>& environment = {},
                              std::chrono::seconds limit = std::chrono::seconds(120),
                              const std::string& out_file = {}) {
  arguments.insert(arguments.begin(), lightgrid_program);
  return run_words(arguments, environment, limit, out_file);
}

}  // namespace lightgrid
