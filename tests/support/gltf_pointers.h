// KHR_animation_pointer in small files.
#pragma once

#include "support/gltf_builder.h"

namespace lightgrid {

// Keys at 0, 1 and 2 seconds.
template <typename T>
void animate(GltfBuilder& made, const std::string& pointer, const std::vector<T>& values, const char* type,
             ComponentType component, const char* interpolation = "STEP") {
  const int times = made.accessor(made.view(bytes_of(std::vector<float>{0, 1, 2})), "SCALAR", f32, 3);
  const int keys = made.accessor(made.view(bytes_of(values)), type, component,
                                 interpolation == std::string("CUBICSPLINE") ? 9 : 3);
  made.root["animations"].push_back(
      {{"samplers", {{{"input", times}, {"output", keys}, {"interpolation", interpolation}}}},
       {"channels",
        {{{"sampler", 0},
          {"target",
           {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}}}}});
}

inline std::string visible_of(int node) {
  return "/nodes/" + std::to_string(node) + "/extensions/KHR_node_visibility/visible";
}

}  // namespace lightgrid
