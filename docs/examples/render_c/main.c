/* A picture of a scene made in memory, and the light lists of one from its depth, through lightgrid's C interface.
 *
 *   cc -std=c99 main.c -o render_c $(pkg-config --cflags --libs lightgrid) && ./render_c picture.png */
#include <lightgrid.h>
#include <stdio.h>
#include <stdlib.h>

enum { width = 320, height = 180, lights = 64 };

static void check(lightgrid_status status) {
  if (status == LIGHTGRID_OK) return;
  fprintf(stderr, "%s (%s)\n", lightgrid_error_message(), lightgrid_error_field());
  exit(status);
}

/* A floor of 20 m x 20 m, and lamps in a square half a metre above it. */
static lightgrid_scene* make_scene(lightgrid_light* lamps) {
  const float positions[] = {-10, 0, -10, -10, 0, 10, 10, 0, 10, 10, 0, -10};
  const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
  const char* const fields[] = {"size=320x180", "camera=eye:0,6,12,target:0,0,0", NULL};
  lightgrid_scene* scene;
  lightgrid_material material;
  lightgrid_mesh mesh = {0};
  int i;

  check(lightgrid_scene_create("floor", fields, &scene));
  lightgrid_default_material(&material);
  material.metallic = 0;
  check(lightgrid_scene_add_material(scene, &material, NULL));
  mesh.positions = positions, mesh.vertex_count = 4;
  mesh.indices = indices, mesh.index_count = 6;
  check(lightgrid_scene_add_mesh(scene, &mesh, NULL));
  check(lightgrid_scene_add_instance(scene, 0, NULL, 1, NULL));
  for (i = 0; i < lights; ++i) {
    lightgrid_default_light(&lamps[i]);
    lamps[i].position[0] = (i % 8 - 3.5) * 2.5;
    lamps[i].position[1] = 0.5;
    lamps[i].position[2] = (i / 8 - 3.5) * 2.5;
    lamps[i].color[i % 3] = 0.2f;
    lamps[i].intensity = 4;
    lamps[i].radius_m = 2.5f;
  }
  check(lightgrid_scene_set_lights(scene, lamps, lights));
  return scene;
}

int main(int argc, char** argv) {
  static float pixels[height][width][4], depth[height][width];
  static lightgrid_light lamps[lights];
  const lightgrid_image image = {pixels, width, height, LIGHTGRID_RGBA_F32, sizeof pixels[0]};
  const lightgrid_image depth_image = {depth, width, height, LIGHTGRID_R_F32, sizeof depth[0]};
  const char* const settings[] = {"tile=32", NULL};
  lightgrid_scene* scene = make_scene(lamps);
  lightgrid_device* device;
  lightgrid_view* view;
  lightgrid_camera camera;
  lightgrid_projection projection;
  lightgrid_lists* lists;
  lightgrid_grid grid;
  double stops;
  const uint32_t* cell;
  uint32_t i;

  check(lightgrid_device_open(NULL, "none", &device));
  check(lightgrid_view_open(device, scene, "visibility", settings, &view));
  check(lightgrid_view_render(view, &image));
  check(lightgrid_view_depth(view, &depth_image));
  check(lightgrid_exposure(&image, &stops));
  if (argc > 1) check(lightgrid_save(argv[1], &image, stops));

  check(lightgrid_scene_camera(scene, NULL, (double)width / height, &camera));
  check(lightgrid_project(&camera, width, height, &projection));
  check(lightgrid_cull(device, &projection, &depth_image, lamps, lights, "forward_plus", settings, &lists));
  check(lightgrid_lists_get(lists, &grid));
  printf("%d x %d tiles, %u entries in all lists\n", (int)grid.cells_x, (int)grid.cells_y, (unsigned)grid.index_count);
  cell = grid.cells + 2 * ((size_t)(height / 2 / grid.tile) * (size_t)grid.cells_x + (size_t)(width / 2 / grid.tile));
  printf("centre:");
  for (i = 0; i < cell[1]; ++i) printf(" %u", (unsigned)grid.indices[cell[0] + i]);
  printf("\n");

  lightgrid_lists_free(lists);
  lightgrid_view_close(view);
  lightgrid_scene_free(scene);
  lightgrid_device_close(device);
  return 0;
}
