// Time per pass. When off, it has no cost and adds no wait; when on, each pass ends with a wait for its
// device, so that times are separate (and the frame takes a little longer).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/timer.h"

namespace lightgrid {

struct KernelTime {
  std::string name;
  double ms = 0;  // on the device, of all its launches in the pass
};

struct PassRecord {
  std::string name, on;  // "gl" or "cl"
  std::vector<double> ms;
  std::vector<std::vector<KernelTime>> kernels;  // kernels of OpenCL passes, by run
  size_t bytes_read = 0, bytes_written = 0;      // counted from the pass's inputs and outputs
};

class PassTimer {
 public:
  // Called before and after a pass on "gl" or "cl".
  struct Clock {
    std::function<void(const std::string& on)> start;
    std::function<std::vector<KernelTime>(const std::string& on)> stop;  // waits for the device
  };
  // Told of each pass as it begins and ends, also when the timer is off.
  struct Watcher {
    virtual ~Watcher() = default;
    virtual void begin(const std::string& name, const std::string& on) = 0;
    virtual void end() = 0;  // ends the last pass that began
  };
  explicit PassTimer(Clock clock) : clock_(std::move(clock)) {}

  // Measures its own lifetime.
  class Scope {
   public:
    Scope(PassTimer* timer, size_t record, Watcher* watcher)
        : timer_(timer), record_(record), watcher_(watcher) {
      if (timer_) timer_->clock_.start(timer_->records_[record_].on);
      started_ = {};
    }
    Scope(const Scope&) = delete;
    // A pass whose clock fails is not recorded, since a destructor must not throw: the frame's next wait
    // fails as well.
    ~Scope() {
      if (watcher_) watcher_->end();
      if (!timer_) return;
      try {
        PassRecord& record = timer_->records_[record_];
        std::vector<KernelTime> kernels = timer_->clock_.stop(record.on);
        record.ms.push_back(started_.elapsed_ms());
        record.kernels.push_back(std::move(kernels));
      } catch (...) {
      }
    }
    // Bytes of the inputs read and the outputs written.
    void moves(size_t read, size_t written) {
      if (timer_) {
        timer_->records_[record_].bytes_read = read;
        timer_->records_[record_].bytes_written = written;
      }
    }

   private:
    PassTimer* timer_;
    size_t record_;
    Watcher* watcher_;
    Timer started_;
  };

  Scope pass(const std::string& name, const std::string& on) {
    if (watcher) watcher->begin(name, on);
    if (!enabled) return {nullptr, 0, watcher};
    for (size_t i = 0; i < records_.size(); ++i) {
      if (records_[i].name == name) return {this, i, watcher};
    }
    records_.push_back({name, on, {}, {}, 0, 0});
    return {this, records_.size() - 1, watcher};
  }

  const std::vector<PassRecord>& records() const { return records_; }  // in the order the passes first ran
  void clear() { records_.clear(); }

  bool enabled = false;
  Watcher* watcher = nullptr;  // outlives the passes that it is told of

 private:
  Clock clock_;
  std::vector<PassRecord> records_;
};

}  // namespace lightgrid
