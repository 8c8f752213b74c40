// What ran on an OpenCL queue: launches counted always, timed per label when asked for.
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

  // Off at first: events cost a little each, and are kept until collected.
  void time_launches(bool on) { timing_ = on; }

  // Counts one launch or transfer under `label`. Returns where its event goes, or null while timing is off.
  cl::Event* event(const std::string& label);

  // Waits for the timed launches, adds them up by label in order of first use, and forgets them.
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
  std::deque<Timed> pending_;  // a deque, so that event() can hand out addresses
};

}  // namespace lightgrid
