#include "verify/shadow_check.h"

#include "plan/settings/kernels.h"

#include <algorithm>

namespace lightgrid::lab::verify {

std::vector<ShadowImage> shadows(Check& c, const Scene& scene, const std::vector<View>& views,
                                 const Shows& shows) {
  Settings settings;
  settings.set(setting::kernel_shape, KernelShape::lanes);
  std::vector<ShadowImage> images = c.engine.shadows(scene, views, settings);
  if (images.empty()) {
    c.skip("the engine finds no shadows");
    return images;
  }
  settings.set(setting::everything_on, true);
  const std::vector<ShadowImage> of_all_lights = c.engine.shadows(scene, views, settings);
  settings = {};
  settings.set(setting::kernel_shape, KernelShape::group);
  const std::vector<ShadowImage> by_groups = c.engine.shadows(scene, views, settings);
  const Occlusion occlusion(scene);
  ShadowPairs all;
  for (size_t i = 0; i < views.size(); ++i) {
    const std::string differ = difference(images[i], by_groups[i]);
    c.that(differ.empty(), "view {}: the kernel shapes' {} differ", i, differ);
    if (!c.that(same_surfaces_and_lights(images[i], of_all_lights[i]),
                "view {}: with everything on it shows other surfaces", i))
      continue;
    const std::vector<ShadowPairs> counted =
        count_shadow_pairs(scene, occlusion, views[i], {&images[i], &of_all_lights[i]});
    for (const ShadowPairs& pairs : counted) {
      c.trials(pairs.decided());
      if (pairs.wrong())
        c.lost_pairs(pairs.wrong(), "view {}: {} leaked, {} acned of {}: {}", i, pairs.leaked, pairs.acned,
                     pairs.decided(), pairs.why);
    }
    all += counted.front();
  }
  c.contacts(all.decided());
  const double count = std::max(1.0, double(all.decided() + all.either));
  c.that(double(all.seen) >= shows.seen * count && double(all.hidden) >= shows.hidden * count &&
             double(all.either) <= shows.either * count,
         "{} seen, {} hidden, {} undecided: too few are decided", all.seen, all.hidden, all.either);
  return images;
}

Scene furnished_floor(int cells) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, cells, cells));
  add_triangles(scene, box_of({-1, 0, -1}, {-0.5f, 2, -0.5f}));
  add_triangles(scene, quad_of({0, 0.75f, 1}, {1.5f, 0, 0}, {0, 0, -1}, 3, 2));
  return scene;
}

View of_the_floor(int width, int height) { return shadow_view({3, 2.5, 3.5}, {0, 0.3, 0}, width, height); }

Scene soup_scene(const ShadowTriangles& triangles, Random& random, int lamps, int lamps_on_it) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, triangles);
  add_triangles(scene, quad_of({-4, -2.2f, 4}, {8, 0, 0}, {0, 0, -8}, 2, 2));
  for (int i = 0; i < lamps; ++i) add_lamp(scene, in_cube(random, 2.1));
  for (int i = 0; i < lamps_on_it; ++i)
    add_lamp(scene, on_triangle(random, triangles[size_t(random.next() % triangles.size())]));
  return scene;
}

std::vector<View> of_the_soup() {
  return {shadow_view({3, 2, 4}, {0, 0, 0}), shadow_view({0.1, 0.2, 0.3}, {-2, -1, 0.5}),
          shadow_view({-3, 3, -2}, {0, -1, 0})};
}

void turn(Scene& scene, std::vector<View>& views, const glm::dmat4& turn) {
  for (Instance& instance : scene.instances) instance.world_from_object = turn * instance.world_from_object;
  for (Light& light : scene.lights) light.position = glm::dmat3(turn) * light.position;
  for (View& view : views) {
    view.view_from_world = view.view_from_world * glm::transpose(turn);
    view.eye = glm::dmat3(turn) * view.eye;
  }
}

}  // namespace lightgrid::lab::verify
