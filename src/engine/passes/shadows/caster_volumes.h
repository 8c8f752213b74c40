// Shadow volumes of point and spot lights: Crow, "Shadow Algorithms for Computer Graphics", SIGGRAPH 1977.
//
// A volume is the sum of one prism a triangle: the triangle, what it becomes infinitely far from the light,
// and three sides. Sides that two triangles share cancel, which leaves the silhouettes; an edge of three
// triangles, or of two that both end there, has a side each (Bergeron, "A General Version of Crow's Shadow
// Volumes", 1986). So meshes need not be closed, and a point is in as many prisms as triangles hide it.
#pragma once

#include <span>
#include <vector>

#include "rays/ray_scene.h"
#include "scene/scene.h"

namespace lightgrid {

// Triangles of shaders/shadow_volume.vert, counter-clockwise from outside: 2 (3 triangle + corner) of the
// rays' scene, 1 more at infinity.
struct CasterVolumes {
  std::vector<uint32_t> indices;
  struct Range {
    size_t first = 0, count = 0;
  };
  std::vector<Range> of_light;
};

struct CastingLight {
  glm::dvec3 position{0};  // world space
  double range_m = 0;      // 0: it has no volume
};

// The volumes of all opaque and masked triangles in each light's range; a mask lets no light through, and
// blended surfaces cast nothing. On all cores.
CasterVolumes caster_volumes(const Scene& scene, const RayScene& rays, std::span<const CastingLight> lights);

}  // namespace lightgrid
