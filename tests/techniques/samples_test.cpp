// The setting samples: which techniques take it, and the pictures of those that do.
#include <gmock/gmock.h>

#include "base/error.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

TEST(Samples, AreTakenByTechniquesThatDeclareThemAndRefusedByOthersByName) {
  const SmallScene s = small_scene();
  GpuScene gpu(test_devices(), s.scene);
  for (const Technique* technique : techniques()) {
    const bool declared = reads_setting(*technique, "samples");
    Settings settings;
    apply_setting(settings, "samples=8");
    EXPECT_LE(most_samples(*technique, settings), declared ? 8 : 1) << technique->name;
    if (declared) continue;
    try {
      TechniqueRun run(test_devices(), gpu, small_view(17, 9), settings, *technique);
      ADD_FAILURE() << technique->name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), HasSubstr("samples=8")) << technique->name;
      EXPECT_THAT(error.what(), HasSubstr(technique->name));
    }
  }
}

// The image at N times the size has its pixels averaged: N * N samples a pixel in a grid.
Image averaged(const Image& large, int n) {
  Image small(large.width / n, large.height / n);
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      small.pixels[size_t(y / n) * size_t(small.width) + size_t(x / n)] +=
          large.pixels[size_t(y) * size_t(large.width) + size_t(x)] / float(n * n);
    }
  }
  return small;
}

// A highlight of less than a pixel is no edge, and would outweigh them all.
Image clamped(Image image) {
  for (glm::vec4& pixel : image.pixels) pixel = glm::min(pixel, glm::vec4(1));
  return image;
}

double rmse(const Image& a, const Image& b) { return compare_images(clamped(a), clamped(b)).rmse; }

class SamplesOfVisibility : public testing::Test {
 protected:
  SamplesOfVisibility() {
    for (const char* name : {"blend", "mask", "spot", "directional"}) effect(name).add(s_);
  }
  Image draw(const std::string& more, int width = 67, int height = 41) const {
    Settings settings;
    for (size_t begin = 0; begin < more.size();) {
      const size_t end = std::min(more.find(' ', begin), more.size());
      apply_setting(settings, more.substr(begin, end - begin));
      begin = end + 1;
    }
    return render(s_.scene, small_view(width, height), "visibility", settings);
  }
  SmallScene s_ = small_scene();
};

TEST_F(SamplesOfVisibility, HaveTheSameBytesInEveryShapeTileAndListOfLights) {
  const Image four = draw("samples=4");
  EXPECT_FALSE(same_bytes(four, draw("samples=1")));
  for (const char* more : {"kernel-shape=group", "lights=all", "tile=8", "slices=8 z-bins=16"})
    EXPECT_TRUE(identical(draw(std::string("samples=4 ") + more), four)) << more;
}

// Of a scene whose edges are all silhouettes: masks and blended surfaces cover pixels by their centres.
TEST_F(SamplesOfVisibility, ComeNearerToTheMeanOverThePixel) {
  s_ = small_scene();
  const Image truth = averaged(draw("samples=1", 16 * 67, 16 * 41), 16);
  const double one = rmse(draw("samples=1"), truth), four = rmse(draw("samples=4"), truth);
  EXPECT_LT(four, 0.6 * one);
}

TEST_F(SamplesOfVisibility, AreRefusedWhereALightCastsAShadow) {
  s_.scene.lights[0].casts_shadow = true;
  EXPECT_THROW(draw("samples=4"), Error);
  EXPECT_NO_THROW(draw("samples=4 shadows=none"));
}

}  // namespace
}  // namespace lightgrid
