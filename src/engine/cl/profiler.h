// Counts of launches and transfers on an OpenCL queue; times per label on request.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "cl/opencl.h"

namespace lightgrid {

class ClProfiler {
 public:
  // A label's launches and copies.
  struct Row {
    std::string label;  // as launch() has it
    int launches = 0;   // and copies on the device
    double ms = 0;      // on the device, start to end, summed over the launches
  };

  // Off by default: each event has a cost and is kept until collected.
  void time_launches(bool on) { timing_ = on; }
  void time_copies(bool on) { timing_copies_ = on; }  // from and to the host, besides

  // Counts one launch or transfer under `label`. Returns a place for its event, or null while timing is off.
  cl::Event* event(const std::string& label);
  // For a copy from or to the host, which is not counted; null while copies are not timed.
  cl::Event* copy_event(const std::string& label);

  // Waits for the timed launches, sums them by label in order of first use, and clears them.
  std::vector<Row> collect();
  // A single launch or copy.
  struct Timed {
    std::string label;  // as launch() has it
    bool copy = false;  // copy_event
    double ms = 0;      // on the device, start to end
  };
  // The same one by one, in the order of their enqueuing; `pending` of them are there.
  std::vector<Timed> collect_each();
  size_t pending() const { return pending_.size(); }  // timed, and not collected yet

  // Launches and transfers so far, timed or not.
  int count() const { return count_; }
  int count(const std::string& label) const;

 private:
  struct Pending {
    std::string label;
    bool copy;
    cl::Event event;
  };

  bool timing_ = false, timing_copies_ = false;
  int count_ = 0;
  std::vector<Row> counts_;      // by label; ms unused
  std::deque<Pending> pending_;  // a deque, so that addresses returned by event() stay valid
};

}  // namespace lightgrid
