// The oracle of shadows for the surfaces that runs show.
#pragma once

#include <memory>
#include <vector>

#include "accuracy/scene_occlusion.h"
#include "oracle/seen_pairs.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"
#include "run/frames.h"

namespace lightgrid::lab {

// The same triangles by their numbers in their meshes, the first of several that connect the same vertices.
std::vector<CastingTriangle> casting_triangles(const Scene& scene, const std::vector<SceneTriangle>& shown);

// The lights at `places` of the scene in the view, and those of them that cast.
CastingLights casting_lights(const Scene& scene, const View& view, const LightRanges& ranges,
                             const std::vector<int>& places);

// Decides pairs once for all runs that show the same surfaces of a view. A scene whose lights cast nothing
// costs nothing.
class ShadowTruth {
 public:
  // max_pairs: in each view; of more, an even sample of the pixels is taken. The scene outlives it.
  ShadowTruth(const Scene& scene, uint64_t max_pairs)
      : scene_(scene), max_pairs_(max_pairs), occlusion_(std::make_unique<SceneOcclusion>(scene)) {}

  bool casts() const;  // some light of the scene
  SceneOcclusion& occlusion() { return *occlusion_; }

  // The pairs of point and spot lights, in the order of lists, then of directional ones. Null if no light
  // casts; valid until the next call but one. triangles: the nearest opaque one of each pixel.
  const SeenPairs* pairs(const ViewState& v, const std::vector<float>& depth,
                         const std::vector<SceneTriangle>& triangles);

  // The pairs of all lights of the scene, in its order, at `pixels`; in_range: without those that are out of
  // range. Null if no light casts.
  std::unique_ptr<SeenPairs> at_pixels(const ViewState& v, const std::vector<float>& depth,
                                       const std::vector<CastingTriangle>& triangles,
                                       const std::vector<uint32_t>& pixels, bool in_range = true);

  // The pairs of point and spot lights at the fragments of a layer of blended surfaces. Null if no light
  // casts; valid until the next call.
  const SeenPairs* of_layer(const ViewState& v, const HostShadowLayer& layer);

  // Another view, and `geometry`: whether instances moved or meshes deformed.
  void moved(bool geometry);

 private:
  // Settings that decide which pairs there are, and which of them are hidden.
  struct Model {
    LightRanges ranges;
    BlendedCasters by_blended = BlendedCasters::none;
    bool operator==(const Model&) const = default;
  };
  static Model model_of(const ViewState& v) {
    return {ranges_of(v.plan.settings), v.plan.settings[setting::shadow_blended]};
  }
  struct Decided {
    Model model;
    std::vector<float> depth;
    std::vector<SceneTriangle> triangles;
    std::unique_ptr<SeenPairs> pairs;
  };
  struct DecidedLayer {
    Model model;
    std::vector<float> depth;
    std::vector<glm::ivec2> triangles;
    std::unique_ptr<SeenPairs> pairs;
  };
  static constexpr size_t max_layers = 64;

  const Scene& scene_;
  uint64_t max_pairs_;
  std::unique_ptr<SceneOcclusion> occlusion_;  // it does not move
  Decided decided_[2];                         // OpenGL's surfaces, and those drawn in OpenCL
  std::vector<DecidedLayer> layers_;
  int next_ = 0;
};

}  // namespace lightgrid::lab
