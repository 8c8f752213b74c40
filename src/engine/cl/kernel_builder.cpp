#include "cl/kernel_builder.h"

#include <algorithm>

#include "cl/program_file.h"

namespace lightgrid {

KernelBuilder::~KernelBuilder() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
}

void KernelBuilder::add(const ProgramSource& source) {
  const std::lock_guard lock(mutex_);
  const auto [job, is_new] = jobs_.try_emplace(source.key);
  if (!is_new) return;
  job->second.source = source;
  job->second.first = std::make_unique<FirstCompilation>();
  waiting_.push_back(&job->second);
  ++left_;
  const size_t max_threads = device_.info().cpu ? 1 : 4;
  if (threads_.size() < std::min(max_threads, left_)) threads_.emplace_back([this] { run(); });
  changed_.notify_all();
}

std::vector<unsigned char> KernelBuilder::take(const std::string& key) {
  std::unique_lock lock(mutex_);
  const auto job = jobs_.find(key);
  if (job == jobs_.end()) return {};
  changed_.wait(lock, [&] { return job->second.done; });
  return std::move(jobs_.extract(job).mapped().binary);
}

void KernelBuilder::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return left_ == 0; });
}

void KernelBuilder::run() {
  cl::Context context;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
    if (ending_) return;
    Job& job = *waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    job.first->begin();
    std::vector<unsigned char> binary;
    try {
      if (!context()) context = device_.info().cpu ? cl::Context(device_.device()) : device_.context();
      binary = compile(context, job.source);
    } catch (const cl::Error&) {
      // The program is then built where it is needed, which reports the error.
    }
    job.first.reset();
    lock.lock();
    job.binary = std::move(binary);
    job.done = true;
    --left_;
    changed_.notify_all();
  }
}

std::vector<unsigned char> KernelBuilder::compile(const cl::Context& context,
                                                  const ProgramSource& source) const {
  cl::Program program(context, source.text);
  program.build(device_.device(), source.options.c_str());
  const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
  if (binaries.empty() || binaries[0].empty()) return {};
  write_program_file(source.path, source.key, binaries[0]);
  return binaries[0];
}

}  // namespace lightgrid
