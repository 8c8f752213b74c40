// A third-party scene, with lights to match: the techniques with a light grid give the bytes of `forward`.
#include "plan/settings/grid.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "support/shared_files.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

TEST(Sponza, HasTheBytesOfEveryLightAtEveryPixel) {
  const std::filesystem::path file = "scenes/large/Sponza/Sponza.gltf", lights = "bench/sponza_lights.json";
  LIGHTGRID_NEEDS_SHARED(file);
  LIGHTGRID_NEEDS_SHARED(lights);
  Scene scene = load_gltf(shared_folder() / file);
  scene.lights = load_lights_file(shared_folder() / lights);
  scene.lights.resize(255);
  const View view =
      make_view(choose_camera(scene, camera_of_lights_file(shared_folder() / lights)), 320, 180);
  const Image forward = render(scene, view, "forward");
  EXPECT_GT(brightest_channel(forward), 0.1f);
  for (const Settings& settings :
       {Settings{}, Settings{{setting::z_bins, 64}, {setting::grid_lists, GridLists::masks}}}) {
    SCOPED_TRACE(testing::PrintToString(to_strings(settings)));
    expect_exact(scene, view, settings, forward, "forward_plus");
    expect_exact(scene, view, settings, forward, "clustered");
  }
}

}  // namespace
}  // namespace lightgrid
