// Compiles programs on threads of its own, while OpenGL compiles its shaders.
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/compiling.h"
#include "cl/device.h"

namespace lightgrid {

// A program as it is compiled, and the file that later starts load it from.
struct ProgramSource {
  std::string options, text, key;  // key: program_file.h
  std::filesystem::path path;
};

// Threads that compile and store programs: one on CPUs, since PoCL 3.1 compiles no faster with two (`render hall -t
// visibility` on two cores), else up to four. On CPUs the thread has a context of its own, so that the device's
// stays free; the context loads PoCL's library of functions (0.5 s and 200 MB).
class KernelBuilder {
 public:
  explicit KernelBuilder(ClDevice& device) : device_(device) {}
  ~KernelBuilder();  // waits for programs that are being compiled; drops the others

  void add(const ProgramSource& source);  // does nothing if it was added before
  // Waits until the program is compiled and its file is written. Returns its binary; empty if it was not
  // added or does not compile.
  std::vector<unsigned char> take(const std::string& key);
  void finish();  // waits for all

 private:
  struct Job {
    ProgramSource source;
    std::unique_ptr<FirstCompilation> first;
    bool done = false;
    std::vector<unsigned char> binary;
  };
  void run();
  std::vector<unsigned char> compile(const cl::Context& context, const ProgramSource& source) const;

  ClDevice& device_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Job> jobs_;  // by key
  std::deque<Job*> waiting_;
  size_t left_ = 0;  // jobs that are not done
  bool ending_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace lightgrid
