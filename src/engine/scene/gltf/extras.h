// The object `extras.lightgrid` of scenes, nodes, lights and materials.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/reporter.h"
#include "scene/property_rows.h"

namespace lightgrid::gltf {

struct SceneExtras {
  std::optional<int> samples;  // 1, 2, 4 or 8
  std::optional<glm::vec3> ambient, background;
};

// The extras of a node or a light.
struct PlacedExtras {
  std::optional<bool> casts_shadow;
  std::optional<float> source_radius_m;
  GivenFields properties;
};

struct MaterialExtras {
  std::string model;
  std::optional<glm::dvec3> subsurface_color;
  std::optional<double> roll_off, k;
};

// By the owner's index. Owners without any of these fields have no entry.
struct Extras {
  std::map<int, SceneExtras> scenes;
  std::map<int, PlacedExtras> nodes, lights;
  std::map<int, MaterialExtras> materials;
};

// Reads `extras.lightgrid` of the file's JSON, whose collections are arrays of objects. Errors: a key that
// the object does not have, a value of another type or outside its domain.
//
// Earlier versions read the fields of scenes, nodes and lights from `extras` itself. Values there are used,
// with a warning, if they have the type and domain required, and ignored otherwise: other programs keep their
// own properties in `extras`.
Extras read_extras(Reporter& report, const nlohmann::json& root);

}  // namespace lightgrid::gltf
