// Hard cases of effects as rows: lights of a lights file, a few surfaces, a camera. The pictures of OpenGL and of
// OpenCL must be those of the oracle, and no list may lose a light.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightgrid::lab::verify {

struct EffectRow {
  const char* name;
  std::vector<std::string> lights;  // fields of lights files, each besides or in place of those of `lamp`
  const char* camera = "eye:0,0,0,target:0,0,-4";
  const char* settings = "";
  std::function<void(Scene&)> change = {};
  const char* refused = nullptr;  // words of the error that the row must cause
  bool is_planned = true;
  double error = 0;  // if above 0, in place of the group's bounds: a method's own error in this case
};

// A wall that faces +z at z = -4, a metal ball before it, and a box that is mirrored and sheared.
enum EffectSurface { wall, ball, box };  // instances and materials

inline constexpr const char* lamp = R"({"type": "point", "name": "lamp", "position": [-0.2, 0.3, -3.1],
  "direction": [0, 0, -1], "color": [1, 0.9, 0.8], "intensity": 3, "radius": 5})";

struct EffectRows {
  const char* effect;    // whose plan, and the group of its cases
  const char* settings;  // of all rows
  // Largest errors of pictures, relative to the brightest value: any pixel of OpenGL's, and 99 % of the pixels
  // that OpenCL draws.
  double opengl, opencl;
  std::vector<EffectRow> rows;
};

const std::vector<EffectRows>& effect_rows();

}  // namespace lightgrid::lab::verify
