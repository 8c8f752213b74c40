// The pose of a scene at a time.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// What set_time or a light motion changed, as indices into the arrays of Scene, ascending. Nothing else
// differs from before: the number of instances, meshes, lights and cameras, and of each mesh's vertices and
// indices, never changes.
struct SceneChanges {
  std::vector<int> instances;  // world_from_object
  std::vector<int> meshes;     // all arrays but indices, and bounds
  std::vector<int> lights;     // position, direction
  std::vector<int> cameras;    // world_from_view
  bool empty() const { return instances.empty() && meshes.empty() && lights.empty() && cameras.empty(); }
};

// Poses the scene at `seconds` of one animation of its file, or of all of them at once (-1; where two animate
// the same property the later one holds), and says what changed. Times outside an animation take its first or
// last key (glTF 2.0, 3.11).
//
// Time 0 with animation -1 is the file at rest, as load_gltf gives it: nodes, joints and morph weights as the
// file has them without its animations. That may differ from the first keys; to see those at 0, name the
// animation.
//
// The result depends on the rig, `seconds` and `animation` alone, not on earlier poses. Instances on a node
// that is scaled to no volume shrink to a point and cover no pixel; a light or camera on such a node keeps
// the direction it has at rest. Lights and cameras that the caller has added or replaced (Light::node -1)
// stay. Without a rig nothing happens.
//
// Throws Error(input): a time that is not finite, an animation out of range, a pose that is not finite. After
// the last of these meshes may be half done: the next call that succeeds makes and lists all that deform.
SceneChanges set_time(Scene& scene, double seconds, int animation = -1);

// The time of the last key, in seconds, of one animation or (-1) of all; 0 where nothing is animated. Throws
// Error(input): an animation out of range.
double duration_of(const Scene& scene, int animation = -1);

// `seconds` for an animation that repeats: as it is up to the duration, then by whole durations less. Never 0
// after the start, which would be the rest pose.
double looped_time(const Scene& scene, double seconds, int animation = -1);

// The number of animations of the file, named or not.
int animation_count(const Scene& scene);

}  // namespace lightgrid
