#include "compare/edge_share.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/settings/samples.h"
#include "run/technique_run.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid {
namespace {

// The rasteriser's own figures, whose samples have other places.
TEST(EdgeShare, IsAboutWhatVisibilityFinds) {
  const SmallScene s = small_scene();
  const View view = small_view(64, 40);
  for (const int samples : {4, 8}) {
    TechniqueRun run(software_devices(), s.scene, view, {{setting::samples, samples}},
                     find_technique("visibility"));
    run.run_frame();
    const SampleResult found = *run.result().samples;
    const EdgeShare share = find_edge_share(s.scene, view, samples);
    EXPECT_EQ(share.pixels, 64u * 40);
    EXPECT_NEAR(double(share.edges), double(found.edge_pixels), 0.15 * double(found.edge_pixels)) << samples;
    EXPECT_NEAR(double(share.covered), double(found.covered), 0.01 * double(found.covered)) << samples;
    EXPECT_NEAR(double(share.shaded), double(found.shadings), 0.03 * double(found.shadings)) << samples;
  }
}

TEST(EdgeShare, SaysWhatIsSaved) {
  const EdgeShare share{.samples = 4, .pixels = 100, .edges = 10, .covered = 400, .shaded = 120};
  EXPECT_DOUBLE_EQ(share.saved(), 0.7);
  const std::string words = describe(share, small_view(20, 10));
  EXPECT_THAT(words, testing::HasSubstr("10.0 % of 100 sampled, about 20 of 200 with samples=4"));
  EXPECT_THAT(words, testing::HasSubstr("0.30 shadings a sample: it saves 70 %"));
  EXPECT_EQ(EdgeShare{}.saved(), 0);
}

}  // namespace
}  // namespace lightgrid
