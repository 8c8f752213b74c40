// The oracle of shadows, in double: whether a light is seen from a pixel's surface, or which triangle hides
// it. docs/oracle.md#seen-and-hidden has the contract.
#pragma once

#include <span>
#include <vector>

#include "oracle/mask_cover.h"
#include "oracle/signed_volume.h"
#include "oracle/triangle_tree.h"
#include "scene/blended_casters.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid::lab {

// either: the answer turns on the rounding of positions to float.
enum class Sight { seen, hidden, either };

struct CastingTriangle {
  int instance = -1;      // number in the scene; -1: none
  uint32_t triangle = 0;  // number in its mesh
  auto operator<=>(const CastingTriangle&) const = default;
};

// The visible point of a pixel, in the plane of the triangle that it shows.
struct Receiver {
  CastingTriangle own;
  RoundedPoint place;     // world
  double gap_m = 0;       // the end of a segment that hides nothing
  RoundedPoint eye;       // world; of an orthographic view far away
  bool own_hides = true;  // lights behind its own triangle; a blended one lets them through
};

struct SightAnswer {
  Sight sight = Sight::seen;
  CastingTriangle by;     // a triangle that hides the light, if it is hidden
  double distance_m = 0;  // from the light to where it does; of a directional light from the receiver
};

// Bounds of the share of a light that blended triangles hide.
struct Veil {
  double least = 0, most = 0;
};

// Opaque and masked triangles hide lights, from both sides, but those of instances that cast no shadow.
// by_blended: what blended ones hide; with alpha a light of which more than half is hidden counts as hidden,
// by no triangle that an answer could name.
class Occlusion {
 public:
  // The scene outlives it, and does not move meanwhile.
  explicit Occlusion(const Scene& scene, BlendedCasters by_blended = BlendedCasters::none);

  // depth: the pixel's value in the depth buffer; own: the triangle that it shows. (x, y): row 0 at the
  // bottom.
  Receiver receiver(const View& view, int x, int y, double depth, const CastingTriangle& own) const;

  // last: number of the triangle that hid the last light, tested first, and set. May be called from several
  // threads.
  SightAnswer sight(const Light& light, const Receiver& receiver, int* last = nullptr) const;

  // The same answers for receivers beside each other. The triangles around all of their segments are looked
  // for once, if one is not hidden by `last`. light: not a directional one.
  void sights(const Light& light, std::span<const Receiver* const> receivers, std::span<SightAnswer> answers,
              int* last) const;

  // The share that blended triangles hide by their alpha: 1 minus the product of 1 - alpha of all but the
  // receiver's own. With BlendedCasters::alpha; else nothing.
  Veil veil(const Light& light, const Receiver& receiver) const;

  // A vertex or light at `place`, as far off as floats relative to the rays' origin may put it.
  RoundedPoint rounded(const glm::dvec3& place) const;

 private:
  enum class Meeting { none, crossed, unsure };
  // How a segment from a light meets a triangle. of_edge: the segment crosses the plane for sure, and all
  // edges but this one leave no doubt; -1: none such.
  struct Met {
    Meeting meeting = Meeting::none;
    int of_edge = -1;
    int light_side = 0;                      // the light's side of the plane
    double share = 0;                        // share of the segment from the light to the plane
    glm::dvec3 weights{1.0 / 3}, errors{1};  // weights of the corners where the segment meets it
  };
  Corners corners_of(const CastingTriangle& triangle) const;
  double beyond_all_m(const glm::dvec3& place) const;  // further from there than all triangles
  RoundedPoint end_of(const Light& light, const RoundedPoint& source, const Receiver& receiver) const;
  double reach_of(const RoundedPoint& source, const RoundedPoint& end) const;
  template <typename Near>
  SightAnswer sight_of(const Light& light, const Receiver& receiver, const Corners& own, int* last,
                       const Near& near) const;
  RoundedPoint source_of(const Light& light, const Receiver& receiver) const;
  Met meet(int number, const RoundedPoint& light, const RoundedPoint& end) const;
  bool share_an_edge(int a, const Met& met_a, int b, const Met& met_b) const;

  bool is_veil(const CastingTriangle& triangle) const;  // it hides by its alpha
  // answer: of all other triangles.
  SightAnswer through_veil(const Light& light, const Receiver& r, const SightAnswer& answer) const;

  const Scene& scene_;
  BlendedCasters by_blended_;
  MaskCover masks_;
  glm::dvec3 origin_;                           // origin of the rays
  glm::dvec3 middle_{0};                        // middle of the box around the scene
  double diagonal_m_ = 0, vertex_error_m_ = 0;  // diagonal of the box; largest error of a vertex
  std::vector<CastingTriangle> numbers_;
  std::vector<Corners> corners_;  // world, by number
  TriangleTree tree_;
};

}  // namespace lightgrid::lab
