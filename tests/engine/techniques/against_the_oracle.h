// A small scene in both APIs against the oracle in double.
#pragma once

#include "accuracy/oracle_sample.h"
#include "accuracy/surfaces_in_double.h"
#include "techniques/rendering.h"

namespace lightgrid {

// Diffuse surfaces: their bounds are those of LambertShading (oracle_test) and, for surfaces that OpenCL
// rasterises, of passes/resolve_test. Lists lose nothing.
inline void expect_the_oracles(const Scene& scene, const View& view) {
  const Settings settings = {{setting::brdf, Brdf::lambert}};
  TechniqueRun forward(test_devices(), scene, view, settings, find_technique("forward"));
  forward.run_frame();
  const auto depth = read_depth(forward);
  const SurfaceOracle oracle(forward.view(), depth);
  const auto pixels = oracle.decided(oracle.pixels());
  ASSERT_GT(pixels.size(), 1000u);
  const auto radiance = oracle.shade(pixels, true);
  const double brightest = brightest_channel(forward.image());
  for (const char* technique : {"forward", "deferred_tiled", "visibility"}) {
    SCOPED_TRACE(technique);
    TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
    run.run_frame();
    EXPECT_EQ(count_nan_pixels(run.image()), 0u);
    const LitPairs pairs = count_listed_pairs(run, read_depth(run));
    EXPECT_EQ(pairs.lost, 0u);
    EXPECT_EQ(pairs.wrong, 0u);
    if (own_surfaces(run.technique(), settings)) {
      const auto in_double = surfaces_in_double(run.view(), shown_triangles(run), pixels);
      const SurfacesError error = surfaces_error(run.image(), in_double, brightest);
      testing::Test::RecordProperty("visibility_p99_rel", fmt::format("{}", error.p99_rel));
      EXPECT_LT(error.p99_rel, 2e-5);
    } else {
      const OracleError error = oracle_error(run.image(), forward.image(), pixels, radiance);
      testing::Test::RecordProperty(std::string(technique) + "_max_rel", fmt::format("{}", error.max_rel));
      EXPECT_LT(error.max_rel, 5e-5);
    }
  }
}

}  // namespace lightgrid
