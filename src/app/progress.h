// What long work is at: a bar on a terminal, and elsewhere a line every ten seconds.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace lightgrid {

// Draws the bar on stderr, with an estimate of the time left, and clears it when `done` (0 to 1) reaches 1; where stderr is
// no terminal, tells the ProgressLines of the process.
std::function<void(double done, const std::string& step)> progress_bar();

// While it lives, and where stderr is no terminal, a thread says on stderr every ten seconds how long the command has run
// and what its last step is. main makes one; --quiet silences it. Other intervals: LIGHTGRID_PROGRESS_S, in seconds.
class ProgressLines {
 public:
  explicit ProgressLines(const std::string& command);
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

}  // namespace lightgrid
