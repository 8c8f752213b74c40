// With picture=bytes a frame ends with the bytes of the display, and nothing else changes.
#include "plan/settings/picture.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

std::vector<uint8_t> rows_from_top(const std::vector<glm::u8vec4>& picture, int width, int height) {
  std::vector<uint8_t> bytes;
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      const glm::u8vec4& p = picture[size_t(y) * size_t(width) + size_t(x)];
      bytes.insert(bytes.end(), {p.x, p.y, p.z});
    }
  }
  return bytes;
}

class PictureBytes : public testing::TestWithParam<const char*> {};

TEST_P(PictureBytes, AreThoseOfTheImage) {
  const std::string label = GetParam(), name = label.substr(0, label.find(' '));
  Settings settings = assigned(label.substr(name.size()));
  SmallScene small = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(small);
  const View view = small_view(71, 37);
  const Image image = render(small.scene, view, name, settings);
  settings.set(setting::picture, PictureFormat::bytes);
  settings.set(setting::display_ev, -1.5);
  TechniqueRun run(test_devices(), small.scene, view, settings, find_technique(name));
  for (const bool both : {true, false, true}) {
    const double ms = both ? run.run_frame() : run.run_picture();
    EXPECT_EQ(run.frame_ms().back(), ms);
    const std::vector<uint8_t> expected = srgb_bytes(image, {-1.5}),
                               shown = rows_from_top(run.picture(), view.width, view.height);
    EXPECT_TRUE(identical(run.image(), image));
    ASSERT_EQ(shown.size(), expected.size());
    int apart = 0;
    for (size_t i = 0; i < shown.size(); ++i)
      apart = std::max(apart, std::abs(int(shown[i]) - int(expected[i])));
    EXPECT_LE(apart, test_devices().gl->software || run.frame().image.in_cl ? 0 : 1);
  }
  // A pass of its own, and four bytes a pixel to the host.
  run.run_profiled_frames();
  size_t read_back = 0, toned = 0;
  for (const PassRecord& pass : run.view().timer.records()) {
    if (pass.name == "tone_map") toned = pass.bytes_written;
    if (pass.name == "read_back") read_back = pass.bytes_written;
  }
  const size_t pixels = view.grid().pixels();
  EXPECT_EQ(toned, pixels * 4);
  EXPECT_LE(read_back, pixels * 4);  // none where the host reads OpenCL's memory
}

INSTANTIATE_TEST_SUITE_P(Of, PictureBytes,
                         testing::Values("visibility", "visibility samples=4", "forward_plus",
                                         "forward samples=4", "deferred", "deferred_tiled raster=opencl",
                                         "light_prepass", "voxel_lights", "lidr"));

// Another camera or size: no program is built again, and the picture follows.
TEST(PictureBytes, FollowTheView) {
  const SmallScene small = small_scene();
  Settings settings;
  settings.set(setting::picture, PictureFormat::bytes);
  for (const char* name : {"visibility", "forward_plus"}) {
    TechniqueRun run(test_devices(), small.scene, small_view(33, 19), settings, find_technique(name));
    run.prepare();
    const RendererCounts before = test_devices().counts();
    run.look(small_view(64, 36));
    run.run_frame();
    EXPECT_EQ(rows_from_top(run.picture(), 64, 36), srgb_bytes(run.image())) << name;
    EXPECT_EQ(test_devices().counts().gl_programs, before.gl_programs) << name;
    EXPECT_EQ(test_devices().counts().cl_programs, before.cl_programs) << name;
  }
}

}  // namespace
}  // namespace lightgrid
