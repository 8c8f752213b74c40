// Counts of launches and transfers on an OpenCL queue; times per label on request.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "cl/opencl.h"

namespace lightgrid {

class ClProfiler {
 public:
  struct Row {
    std::string label;
    int launches = 0;
    double ms = 0;  // on the device, start to end, summed over the launches
  };

  // Off by default: each event has a cost and is kept until collected.
  void time_launches(bool on) { timing_ = on; }

  // Counts one launch or transfer under `label`. Returns a place for its event, or null while timing is off.
  cl::Event* event(const std::string& label);

  // Waits for the timed launches, sums them by label in order of first use, and clears them.
  std::vector<Row> collect();

  // Launches and transfers so far, timed or not.
  int count() const { return count_; }
  int count(const std::string& label) const;

 private:
  struct Timed {
    std::string label;
    cl::Event event;
  };

  bool timing_ = false;
  int count_ = 0;
  std::vector<Row> counts_;    // by label; ms unused
  std::deque<Timed> pending_;  // a deque, so that addresses returned by event() stay valid
};

}  // namespace lightgrid
