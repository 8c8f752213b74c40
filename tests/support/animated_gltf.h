// Animations for files made in code.
#pragma once

#include "scene/animation.h"
#include "support/gltf_builder.h"
#include "support/near.h"

namespace lightgrid {

inline int float_accessor(GltfBuilder& made, const char* type, int components,
                          const std::vector<float>& values) {
  return made.accessor(made.view(bytes_of(values)), type, f32, values.size() / size_t(components));
}

// Adds a sampler and a channel to the file's animation `animation`, which is made if it is the next one.
// `type` is that of the output: VEC3, VEC4 or SCALAR.
inline nlohmann::json& animate(GltfBuilder& made, int node, const char* path, const std::vector<float>& times,
                               const char* type, const std::vector<float>& values,
                               const char* interpolation = "LINEAR", size_t animation = 0) {
  nlohmann::json& animations = made.root["animations"];
  if (animations.size() <= animation)
    animations.push_back({{"samplers", nlohmann::json::array()}, {"channels", nlohmann::json::array()}});
  nlohmann::json& to = animations[animation];
  const int components = type == std::string("VEC3") ? 3 : type == std::string("VEC4") ? 4 : 1;
  const int input = float_accessor(made, "SCALAR", 1, times),
            output = float_accessor(made, type, components, values);
  to["channels"].push_back(
      {{"sampler", to["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  to["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
  return to["samplers"].back();
}

}  // namespace lightgrid
