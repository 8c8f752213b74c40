// Progress of long work: a bar on a terminal, and elsewhere a line every ten seconds.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace lightgrid::app {

// Draws the bar on stderr, with an estimate of the time left, and clears it when `done` (0 to 1) reaches 1.
// If stderr is no terminal, updates the process's ProgressLines instead.
std::function<void(double done, const std::string& step)> progress_bar();

// While it exists, stderr shows how many kernels have been compiled for their first time on this machine. If
// stderr is no terminal, it also shows every ten seconds how long the command has run, and its last step. A
// command that opens a window prints neither. main creates one. LIGHTGRID_PROGRESS_S sets another interval,
// in seconds.
class ProgressLines {
 public:
  ProgressLines(const std::string& command, bool quiet);
  ~ProgressLines();
  ProgressLines(const ProgressLines&) = delete;
  ProgressLines& operator=(const ProgressLines&) = delete;

 private:
  void run(std::chrono::duration<double> interval);

  std::mutex ending_;
  std::condition_variable end_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace lightgrid::app
