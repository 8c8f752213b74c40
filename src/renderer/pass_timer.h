// Time per pass. When off, it has no cost and adds no wait; when on, each pass ends with a wait for its
// device, so that times are separate (and the frame takes a little longer).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/timer.h"

namespace lightgrid {

struct PassRecord {
  std::string name, on;  // "gl" or "cl"
  std::vector<double> ms;
  size_t bytes_read = 0, bytes_written = 0;  // counted from the pass's inputs and outputs
};

class PassTimer {
 public:
  // Waits for the device "gl" or "cl".
  using Wait = std::function<void(const std::string& on)>;
  explicit PassTimer(Wait wait) : wait_(std::move(wait)) {}

  // Measures its own lifetime.
  class Scope {
   public:
    Scope(PassTimer* timer, size_t record) : timer_(timer), record_(record) {}
    Scope(const Scope&) = delete;
    ~Scope() {
      if (!timer_) return;
      PassRecord& record = timer_->records_[record_];
      timer_->wait_(record.on);
      record.ms.push_back(started_.elapsed_ms());
    }
    // Bytes of the inputs read and the outputs written.
    void moves(size_t read, size_t written) {
      if (timer_) timer_->records_[record_].bytes_read = read, timer_->records_[record_].bytes_written = written;
    }

   private:
    PassTimer* timer_;
    size_t record_;
    Timer started_;
  };

  Scope pass(const std::string& name, const std::string& on) {
    if (!enabled) return {nullptr, 0};
    for (size_t i = 0; i < records_.size(); ++i) {
      if (records_[i].name == name) return {this, i};
    }
    records_.push_back({name, on, {}, 0, 0});
    return {this, records_.size() - 1};
  }

  const std::vector<PassRecord>& records() const { return records_; }  // in the order the passes first ran
  void clear() { records_.clear(); }

  bool enabled = false;

 private:
  Wait wait_;
  std::vector<PassRecord> records_;
};

}  // namespace lightgrid
