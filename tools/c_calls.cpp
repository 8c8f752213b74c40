// Memory that calls of the C interface leave behind after a tenth of the rounds: blocks of the heap, and
// resident memory, which also grows by gaps between blocks.
//
//   build/tools/c_calls 1000000 300                            small calls, views
//   valgrind --leak-check=full build/tools/c_calls 20000 0     blocks that nobody can free any more: must be
//   0
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "c_api/lightgrid.h"

namespace {

void must(lightgrid_status status) {
  if (status == LIGHTGRID_OK) return;
  std::fprintf(stderr, "%s\n", lightgrid_error_message());
  std::exit(1);
}

void must_fail(lightgrid_status status) {
  if (status != LIGHTGRID_OK) return;
  std::fprintf(stderr, "no error\n");
  std::exit(1);
}

// Fourteen calls, four of them with errors.
void small_calls() {
  const char* const fields[] = {"size=16x16", "camera=eye:0,0,3,target:0,0,0", nullptr};
  const char* const wrong[] = {"sizes=16x16", nullptr};
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const uint32_t indices[] = {0, 1, 2};
  float pixels[4 * 4 * 4] = {1, 1, 1, 1};
  lightgrid_scene* scene;
  lightgrid_material material;
  lightgrid_light light;
  lightgrid_camera camera;
  const lightgrid_mesh mesh = {positions, nullptr, nullptr, nullptr, 3, indices, 3, 0};
  const lightgrid_image image = {pixels, 4, 4, LIGHTGRID_RGBA_F32, 64};
  double value;
  must_fail(lightgrid_scene_create("s", wrong, &scene));
  must(lightgrid_scene_create("s", fields, &scene));
  lightgrid_default_material(&material);
  must(lightgrid_scene_add_material(scene, &material, nullptr));
  must(lightgrid_scene_add_mesh(scene, &mesh, nullptr));
  must_fail(lightgrid_scene_add_instance(scene, 3, nullptr, 1, nullptr));
  must(lightgrid_scene_add_instance(scene, 0, nullptr, 1, nullptr));
  lightgrid_default_light(&light);
  must(lightgrid_scene_set_lights(scene, &light, 1));
  must(lightgrid_scene_camera(scene, nullptr, 1, &camera));
  must(lightgrid_measure(&image, &image, "rmse", &value));
  must_fail(lightgrid_measure(&image, &image, "", &value));
  must_fail(lightgrid_scene_load("nowhere", nullptr, &scene));
  lightgrid_scene_free(scene);
}

void small_view(lightgrid_device* device, lightgrid_scene* scene) {
  std::vector<float> pixels(64 * 36 * 4);
  std::vector<uint32_t> triangles(64 * 36);
  const lightgrid_image image = {pixels.data(), 64, 36, LIGHTGRID_RGBA_F32, 64 * 16};
  const lightgrid_image numbers = {triangles.data(), 64, 36, LIGHTGRID_R_U32, 64 * 4};
  lightgrid_view* view;
  lightgrid_camera camera;
  lightgrid_projection projection;
  lightgrid_lists* lists;
  lightgrid_light light;
  const char* const settings[] = {"depth-bounds=none", nullptr};
  lightgrid_default_light(&light);
  must(lightgrid_view_open(device, scene, "visibility", nullptr, &view));
  must(lightgrid_view_render(view, &image));
  lightgrid_image drawn;
  lightgrid_frame* frame;
  must(lightgrid_view_draw(view, &drawn, &frame));
  must(lightgrid_view_look(view, nullptr, 32, 18));
  must(lightgrid_view_draw(view, &drawn, nullptr));
  lightgrid_frame_free(frame);
  must(lightgrid_scene_camera(scene, nullptr, 64.0 / 36, &camera));
  must(lightgrid_project(&camera, 64, 36, &projection));
  must(lightgrid_rasterize(device, scene, &projection, &numbers, nullptr));
  must(lightgrid_cull(device, &projection, nullptr, &light, 1, nullptr, settings, &lists));
  lightgrid_lists_free(lists);
  lightgrid_view_close(view);
}

long resident_kb() {
  long pages = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

template <typename Round>
void repeat(const char* what, int rounds, const Round& round) {
  if (rounds == 0) return;
  for (int i = 0; i < rounds / 10 + 1; ++i) round();
  const long before = resident_kb(), heap = long(mallinfo2().uordblks);
  for (int i = 0; i < rounds; ++i) round();
  std::printf("%d rounds of %s: %.2f bytes a round more in use, %ld kB more resident\n", rounds, what,
              double(long(mallinfo2().uordblks) - heap) / rounds, resident_kb() - before);
}

}  // namespace

int main(int argc, char** argv) {
  const int small = argc > 1 ? std::atoi(argv[1]) / 14 : 1000, views = argc > 2 ? std::atoi(argv[2]) : 10;
  repeat("fourteen small calls", small, small_calls);
  if (views == 0) return 0;
  lightgrid_device* device;
  lightgrid_scene* scene;
  const char* const fields[] = {"size=64x36", "lights=8", nullptr};
  must(lightgrid_device_open(nullptr, "none", &device));
  must(lightgrid_scene_load("spheres", fields, &scene));
  repeat("a view, a rasterised image and lists", views, [&] { small_view(device, scene); });
  lightgrid_scene_free(scene);
  lightgrid_device_close(device);
}
