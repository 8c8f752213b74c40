// A frame that an exception ends before any of its passes leaves nothing behind: the next frame has the bytes
// that it has without it, of this technique and of another.
#include "gl/gl.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// All that passes set in OpenGL, set as the next pass does not need it.
void leave_state() {
  for (const GLenum test : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST})
    glEnable(test);
  glScissor(0, 0, 1, 1);
  glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
  glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
  glCullFace(GL_FRONT_AND_BACK);
  glDepthFunc(GL_NEVER);
  glDepthMask(GL_FALSE);
  glStencilFunc(GL_NEVER, 1, ~0u);
  glStencilMask(0);
}

// Pass number `last` of the frame, from 0 on, throws.
void interrupt(TechniqueRun& run, int last) {
  PassTimer& timer = run.view().timer;
  const PassTimer usual = timer;
  int passes = 0;
  const auto start = [&](const std::string&) {
    if (passes++ < last) return;
    leave_state();
    throw machine_error("interrupted");
  };
  timer = PassTimer({.start = start, .stop = [](const std::string&) { return std::vector<KernelTime>(); }});
  timer.enabled = true;
  EXPECT_THROW(run.run_frame(), Error);
  timer = usual;
}

int passes_of(TechniqueRun& run) {
  run.run_profiled_frames(0);
  return int(run.view().timer.records().size());
}

struct Interrupted : testing::TestWithParam<const Technique*> {};

TEST_P(Interrupted, LeavesNothingBehind) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  effect("mask").add(s);
  const View view = small_view(33, 19);
  Renderer& devices = test_devices();
  GpuScene gpu(devices, s.scene);
  TechniqueRun run(devices, gpu, view, {}, *GetParam()),
      other(devices, gpu, view, {}, find_technique("deferred"));
  run.run_frame();
  other.run_frame();
  const Image expected = run.image(), expected_other = other.image();
  const int passes = passes_of(run);
  ASSERT_GE(passes, 2);
  for (int last = 0; last < passes; ++last) {
    SCOPED_TRACE(last);
    interrupt(run, last);
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), expected));
    interrupt(run, last);
    other.run_frame();
    EXPECT_TRUE(identical(other.image(), expected_other));
    TechniqueRun first(devices, gpu, view, {},
                       *GetParam());  // its buffers are made by the frame that ends early
    interrupt(first, last);
    first.run_frame();
    EXPECT_TRUE(identical(first.image(), expected));
  }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Interrupted, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

}  // namespace
}  // namespace lightgrid
