// A scene with blended surfaces one behind the other, among surfaces that cast.
#pragma once

#include "accuracy/oracle.h"
#include "techniques/shadow_stage.h"

namespace lightgrid {

inline constexpr int glazed_width = 61, glazed_height = 43;

// Panes one behind the other, of which one's vertices have alpha and its matrix mirrors, and a bubble with
// both sides, between lamps, ball and fence.
inline Scene glazed_scene() {
  Scene scene = shadowed_scene();
  const auto glass = [&](const char* name, glm::vec3 color, float alpha) {
    const int added = add_material(scene, name, color, 0, 0.6f);
    Material& m = scene.materials[size_t(added)];
    m.base_color.a = alpha;
    m.alpha_mode = AlphaMode::blend;
    m.double_sided = true;
    return added;
  };
  const int blue = glass("blue", {0.4f, 0.5f, 0.9f}, 0.5f), lace = glass("lace", {0.9f, 0.9f, 0.8f}, 0.9f),
            soap = glass("soap", {0.9f, 0.7f, 0.8f}, 0.3f);
  scene.materials[size_t(blue)].double_sided = false;
  add_instance(scene, "blue", add_mesh(scene, wall_mesh({-0.2f, 0.1f, -3.85f}, 1.1f, blue, "blue")));
  Mesh woven = wall_mesh({0, 0, 0}, 0.7f, lace, "lace");
  for (const glm::vec3& p : woven.positions) woven.colors.emplace_back(1, 1, 1, 0.6f + 0.4f * p.x);
  const int sheet = add_mesh(scene, std::move(woven));
  add_instance(scene, "lace", sheet,
               placed({0.5, 0.3, -3.6}, 25) * glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1)));
  add_instance(scene, "lace", sheet, placed({-0.4, -0.2, -3.5}, -160));
  Mesh bubble;
  shapes::add_sphere(bubble, {0, 0, 0}, 0.4f, 4);
  add_instance(scene, "bubble", add_mesh(scene, shapes::finished(std::move(bubble), "bubble", soap)),
               placed({-0.9, -0.4, -3.2}));
  return scene;
}

// OpenCL alone, with a fault planted in its kernels' text. planted: in how many kernels.
inline std::unique_ptr<Renderer> faulty_renderer(std::string_view right, std::string_view wrong,
                                                 int& planted) {
  auto renderer = std::make_unique<Renderer>("", GlBackend::none);
  renderer->kernels->alter([right, wrong, &planted](std::string text) {
    const size_t at = text.find(right);
    if (at == text.npos) return text;
    ++planted;
    return text.replace(at, right.size(), wrong);
  });
  return renderer;
}

}  // namespace lightgrid
