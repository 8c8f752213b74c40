// Another renderer as a process that answers requests, a line of text each
// (docs/put_your_renderer_on_the_plane.md#a-command).
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lightgrid::lab {

class ExternalProcess {
 public:
  // Started at the first request, in `folder`, with its standard error this program's.
  ExternalProcess(std::vector<std::string> command, std::filesystem::path folder, double timeout_s);
  ~ExternalProcess();  // closes its input; kills its process group if it has not ended 2 s later
  ExternalProcess(const ExternalProcess&) = delete;
  ExternalProcess& operator=(const ExternalProcess&) = delete;

  // Writes the line and returns the first line of the answer that begins with "{"; others are passed over. A
  // process that has ended after an earlier answer is started again. Throws Error(machine): it cannot be
  // started, ends without an answer, says more than 1 MiB, or takes longer than the timeout, after which it
  // is killed.
  std::string ask(const std::string& line);

 private:
  void start();
  void stop(double patience_s);
  bool send(const std::string& line, double until_s);
  bool receive(std::string& answer, double until_s);

  std::vector<std::string> command_;
  std::filesystem::path folder_;
  double timeout_s_;
  pid_t process_ = 0;  // 0: none
  int in_ = -1, out_ = -1;
  std::string heard_;      // output after the last complete line
  bool answered_ = false;  // since its start
  int status_ = 0;         // status of the last ended process
};

}  // namespace lightgrid::lab
