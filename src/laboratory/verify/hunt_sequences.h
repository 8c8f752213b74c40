// Sequences of frames in which the scene moves, for the hunt of shadows: what a renderer keeps from the
// frames before must not show.
#pragma once

#include "verify/engine.h"
#include "verify/hunt_shadow_space.h"
#include "verify/shadow_pairs.h"

namespace lightgrid::lab::verify {

// A technique with settings that keep state between frames.
struct SequenceKind {
  const char *technique, *settings;  // "key=value key=value"
  bool exact = true;                 // its shadows are those of opaque and masked surfaces, by rays
};
std::span<const SequenceKind> sequence_kinds();

// A scene that moves from frame to frame by random numbers: camera, size, places of lights, their ranges,
// cones and brightness, lights off and on, two lights swapped, instances, meshes. Often what changed comes
// back.
class MovingScene {
 public:
  // A scene with a lamp that casts. Some get a sun or a blended surface. deforms: whether meshes change.
  MovingScene(HuntedScene made, bool deforms, Random& random);

  // Returns the changes apart from view(). Some frames have none.
  SceneChanges move();

  const Scene& scene() const { return scene_; }
  const View& view() const { return view_; }
  bool has_sun() const { return is_directional(rest_.lights.back()); }

 private:
  void move_light(SceneChanges& changes);
  void swap_lights(SceneChanges& changes);
  void move_instance(SceneChanges& changes);
  void deform_mesh(SceneChanges& changes);
  void move_camera();
  double step_m();
  size_t any_of(size_t count) { return size_t(random_.next() % count); }

  const std::vector<View> views_;
  const Scene rest_;
  Scene scene_;
  View view_;
  const bool deforms_;
  Random& random_;
};

struct SequenceReport {
  uint64_t frames = 0, stale = 0;  // stale: not those of a renderer that keeps nothing
  std::string why;                 // the first of these
  ShadowPairs pairs;               // pairs of the last frame, where the kind's shadows are exact
};

// Empty, or in which of surfaces, lists, bits, shares and pixels two frames differ.
std::string difference(const SequenceFrame& a, const SequenceFrame& b);

// Draws so many frames twice each: by one renderer for all, and by one that draws nothing else. Draws none
// where the engine draws no sequences.
SequenceReport compare_sequence(CullEngine& engine, HuntedScene made, const SequenceKind& kind,
                                const Settings& settings, int frames, Random& random);

}  // namespace lightgrid::lab::verify
