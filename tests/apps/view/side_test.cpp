// One side of the window: which frames count as figures.
#include "view/side.h"

#include <gmock/gmock.h>

#include "base/compiling.h"
#include "scenes/builtin.h"

namespace lightgrid::app {
namespace {

// A frame that compiles is drawn again, and so is the first one of a run; both are no figures.
TEST(Side, LeavesCompilingOutOfEveryFigure) {
  Scene scene = find_builtin_scene("spheres")->make();
  Renderer renderer("", GlBackend::automatic);
  if (!renderer.gl) GTEST_SKIP() << renderer.why_no_gl;
  GpuScene gpu(renderer, scene);
  int compiled = 0;
  before_compiling = [&](const std::string&) { ++compiled; };
  Side side(renderer, gpu);
  const View view = make_view(choose_camera(scene, "", 2), 64, 32);
  for (const char* technique : {"forward_plus", "forward"}) {
    EXPECT_TRUE(side.choose({.technique = technique}, view));
    EXPECT_EQ(side.frame_ms(), 0);
    const int figures = side.figures();
    const int before = compiled;
    int draws = 0, last_that_compiled = 0;
    for (int now = compiled; side.draw(false, true); now = compiled) {
      ++draws;
      if (compiled > now) last_that_compiled = draws;
      ASSERT_LT(draws, 10);
    }
    EXPECT_GT(compiled, before);
    EXPECT_GT(draws, last_that_compiled);
    EXPECT_EQ(side.figures(), figures + 1) << draws;
    EXPECT_EQ(side.timings().frames().size(), 1u) << "of this technique";
    EXPECT_GT(side.frame_ms(), 0);
  }
  before_compiling = nullptr;
}

}  // namespace
}  // namespace lightgrid::app
