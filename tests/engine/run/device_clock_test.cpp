// A frame's time by the clocks of the devices, beside the wall's.
#include "renderer/device_clock.h"

#include <gmock/gmock.h>

#include "cl/transfer.h"
#include "run/technique_run.h"
#include "scenes/builtin.h"

namespace lightgrid {
namespace {

struct TimedFrame {
  double wall_ms = 0;
  DeviceTimes times;
};

// The last of some frames: the first ones compile and upload.
TimedFrame timed_frame(Renderer& renderer, const char* technique) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = make_view(choose_camera(scene, "", 160.0 / 90), 160, 90);
  TechniqueRun run(renderer, scene, view, Settings{}, find_technique(technique));
  DeviceClock clock(renderer);
  TimedFrame frame;
  for (int i = 0; i < 3; ++i) {
    run.view().timer.watcher = &clock;
    clock.start();
    frame.wall_ms = run.run_frame(true);
    run.view().timer.watcher = nullptr;
    const std::optional<DeviceTimes> times = clock.stop();
    if (!times) throw std::runtime_error("OpenGL has no clock here");
    frame.times = *times;
  }
  EXPECT_EQ(renderer.cl->profiler().event("a launch of another frame"), nullptr) << "still on";
  EXPECT_EQ(renderer.cl->profiler().copy_event("a copy of another frame"), nullptr) << "still on";
  return frame;
}

double sum_of(const DeviceTimes& t) { return t.device_ms + t.hand_over_ms + t.copy_ms + t.read_back_ms; }

TEST(DeviceClock, TimesFramesOfKernels) {
  Renderer renderer("", GlBackend::none);
  const TimedFrame frame = timed_frame(renderer, "visibility");
  EXPECT_GT(frame.times.device_ms, 0.1 * frame.wall_ms);
  EXPECT_EQ(frame.times.hand_over_ms, 0);
  EXPECT_GT(frame.times.copy_ms, 0);
  EXPECT_LT(sum_of(frame.times), frame.wall_ms);
}

// OpenGL's drawing is most of the frame.
TEST(DeviceClock, TimesFramesOfBothApis) {
  Renderer renderer("", GlBackend::automatic);
  if (!renderer.gl) GTEST_SKIP() << renderer.why_no_gl;
  const TimedFrame frame = timed_frame(renderer, "forward_plus");
  EXPECT_GT(frame.times.device_ms, 0.1 * frame.wall_ms);
  EXPECT_GT(frame.times.hand_over_ms, 0);
  EXPECT_GT(frame.times.read_back_ms, 0);
  EXPECT_LT(frame.times.device_ms, frame.wall_ms);
}

// A copy within a pass of OpenGL is part of its span; one within a pass of OpenCL counts by itself.
TEST(DeviceClock, CountsACopyInAPassOfOpenGlOnce) {
  Renderer renderer("", GlBackend::automatic);
  if (!renderer.gl) GTEST_SKIP() << renderer.why_no_gl;
  DeviceClock clock(renderer);
  const std::vector<float> values(1 << 20);
  const size_t bytes = values.size() * sizeof(float);
  const cl::Buffer buffer(renderer.cl->context(), CL_MEM_READ_WRITE, bytes);
  const auto copied_in = [&](const char* name, const char* on) {
    clock.start();
    clock.begin(name, on);
    write_buffer(*renderer.cl, "a test", buffer, values.data(), bytes);
    clock.end();
    return clock.stop().value();
  };
  const DeviceTimes in_cl = copied_in("cull_lights", "cl"), in_gl = copied_in("depth_to_cl", "gl"),
                    on_host = copied_in("find_object_lights", "cpu");
  EXPECT_GT(in_cl.copy_ms, 0);
  EXPECT_EQ(in_cl.device_ms + in_cl.hand_over_ms + in_cl.read_back_ms, 0);
  EXPECT_GT(in_gl.hand_over_ms, 0);
  EXPECT_EQ(in_gl.device_ms + in_gl.copy_ms + in_gl.read_back_ms, 0);
  EXPECT_GT(on_host.device_ms, 0);
  EXPECT_EQ(on_host.copy_ms, 0);
}

}  // namespace
}  // namespace lightgrid
