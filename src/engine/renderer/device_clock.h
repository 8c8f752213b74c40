// Frame times by the clocks of the devices that draw them, without a wait between passes: events of
// OpenCL's launches and copies, and OpenGL's timestamps around its passes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/timer.h"
#include "renderer/pass_timer.h"
#include "renderer/renderer.h"

namespace lightgrid {

struct DeviceTimes {
  double device_ms = 0;     // kernels and OpenGL's passes; passes on the host, by its clock
  double hand_over_ms = 0;  // handing memory from one API to the other
  double copy_ms = 0;       // other copies between OpenCL's memory and the host's
  double read_back_ms = 0;  // reading back the image
};

// The name of the pass, and what its copy in OpenCL is called.
inline constexpr const char *read_back_pass = "read_back", *read_back_copy = "reading the image back";

class DeviceClock : public PassTimer::Watcher {
 public:
  explicit DeviceClock(Renderer& renderer);
  ~DeviceClock() override;
  DeviceClock(const DeviceClock&) = delete;

  // Counts later commands and the passes that are reported to it.
  void start();
  // Waits for the devices. Empty if OpenGL drew and has no clock. Throws Error(machine).
  std::optional<DeviceTimes> stop();

  void begin(const std::string& name, const std::string& on) override;
  void end() override;

 private:
  // The time of OpenGL, from its first command to its last one, or of the host. Launches and copies within
  // one are part of it.
  struct Span {
    std::string name;
    bool in_gl = false;
    GLuint queries[2] = {};
    size_t events[2] = {};  // of the profiler: the first in it, the first after it
    double host_ms = 0;
  };
  void mark(Span& span, int end);

  Renderer& renderer_;
  bool gl_has_clock_ = false;
  std::vector<GLuint> queries_;  // all; the first used_ belong to spans
  size_t used_ = 0;
  std::vector<Span> spans_;
  std::vector<std::string> open_;     // where passes run that have begun and not ended
  std::optional<size_t> span_depth_;  // of open_: the pass whose span is open
  Timer host_;
};

}  // namespace lightgrid
