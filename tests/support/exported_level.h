// A level as Blender exports it: a room, and lights in candela without a range; no camera.
#pragma once

#include "support/gltf_builder.h"

namespace lightgrid {

// The room: 20 x 4 x 12 m, its walls seen from inside, its floor at y = 0. A lamp of 100 W is 5435 cd there.
inline GltfBuilder exported_level(int lights, double candela = 5435) {
  GltfBuilder made = GltfBuilder::triangle();
  std::vector<float> corners;
  for (int i = 0; i < 8; ++i)
    corners.insert(corners.end(), {i & 1 ? 10.0f : -10.0f, i & 2 ? 4.0f : 0.0f, i & 4 ? 6.0f : -6.0f});
  made.attribute("POSITION", corners, "VEC3", f32, 8);
  made.indices(std::vector<uint16_t>{0, 1, 3, 0, 3, 2, 5, 4, 6, 5, 6, 7, 4, 0, 2, 4, 2, 6,
                                     1, 5, 7, 1, 7, 3, 4, 5, 1, 4, 1, 0, 2, 3, 7, 2, 7, 6},
               u16);
  made.primitive()["material"] = 0;
  made.root["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}}}};
  made.root["extensionsUsed"] = {"KHR_lights_punctual"};
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", candela}}};
  for (int i = 0; i < lights; ++i) {
    made.root["nodes"].push_back(
        {{"translation", {-9.5 + 19.0 * (i % 25) / 24, 3.2, -5.5 + 11.0 * (i / 25 % 12) / 11}},
         {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    made.root["scenes"][0]["nodes"].push_back(i + 1);
  }
  return made;
}

}  // namespace lightgrid
