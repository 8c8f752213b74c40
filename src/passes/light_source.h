// Where a light loop in OpenGL finds a pixel's lights: its shader text and what it reads.
#pragma once

#include "passes/frame.h"
#include "scene/listed_lights.h"

namespace lightgrid {

class ObjectLights;

struct LightSource {
  std::vector<std::string> defines;  // of shaders/forward.frag: which loop, over what
  struct Binding {
    GLuint unit, texture;
  };
  std::vector<Binding> textures;
  size_t bytes = 0;  // of the lists, for a pass that counts what it reads

  void bind(const RenderView& v) const;  // these, the lights and the view
};

// Every light of the scene at every pixel.
LightSource every_light(const RenderView& v);
// Those of the pixel's cell.
LightSource from_grid(const RenderView& v, const GridTextures& grid);
// Those that the pixel's light indices name.
LightSource from_light_index(const RenderView& v, const LightIndexImages& index);
// Those of the object that is drawn (uniform lights_of_draw).
LightSource from_objects(const RenderView& v, const ObjectLights& objects);
// No point or spot light: ambient, emissive and directional light alone.
LightSource base_lighting(const RenderView& v);

}  // namespace lightgrid
