// The pose of a scene at a time.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// Indices into the arrays of Scene, ascending, of what set_time or a light motion changed. Everything else is
// unchanged: the number of instances, meshes, lights and cameras, and of each mesh's vertices and indices,
// never changes.
struct SceneChanges {
  std::vector<int> instances;  // world_from_object
  std::vector<int> meshes;     // all arrays but indices, and bounds
  std::vector<int> lights;     // position, direction, colour, intensity, radius, cones
  std::vector<int> cameras;    // world_from_view
  bool empty() const { return instances.empty() && meshes.empty() && lights.empty() && cameras.empty(); }
};

// Poses the scene at `seconds` of one animation of its file, or of all of them at once (-1; of two that
// animate the same property the later one applies), and returns what changed. Times outside an animation use
// its first or last key (glTF 2.0, 3.11).
//
// Without a time the scene is at rest, as load_gltf returns it: nodes, joints and morph weights as in the
// file without its animations. That may differ from the first keys, which time 0 poses.
//
// The result depends on the rig, `seconds` and `animation` alone, not on earlier poses. Instances on a node
// that is hidden, or scaled to a line or a point, shrink to a point and cover no pixel; a light or camera on
// such a node keeps its direction at rest. A light on a hidden node has no intensity and a radius of 0.
// Lights and cameras that the caller has added or replaced (Light::node -1) stay. Without a rig nothing
// changes.
//
// Throws Error(input) for a time that is not finite, an animation out of range or a pose that is not finite.
// In the last case meshes may be partly updated; the next successful call updates and lists all that deform.
SceneChanges set_time(Scene& scene, std::optional<double> seconds, int animation = -1);

// The time of the last key, in seconds, of one animation or (-1) of all; 0 if nothing is animated. Throws
// Error(input) for an animation out of range.
double duration_of(const Scene& scene, int animation = -1);

// `seconds` for an animation that repeats: unchanged up to the duration, then reduced by whole durations. A
// whole number of durations is the last key, not the first.
double looped_time(const Scene& scene, double seconds, int animation = -1);

// The number of animations of the file, named or not.
int animation_count(const Scene& scene);

}  // namespace lightgrid
