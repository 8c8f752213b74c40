// The views of a scene on which a frontier measures, and the figures of points on one of them, all but their
// times: errors, FLIP, flicker, pairs, bytes.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "frontier/brute_force.h"
#include "frontier/measure.h"
#include "frontier/pictures.h"

namespace lightgrid::lab {

class ViewFigures {
 public:
  // All outlive it.
  // `first`: the first of the views, whose truth chooses the exposure of the scene's pictures.
  ViewFigures(Renderer& renderer, GpuScene& gpu, const Scene& scene, const View& first,
              const FrontierJob& job, const SceneChoice& choice);

  // Draws the truths of a view, the path's `index`-th. `own`: some point has surfaces of its own. `whole`:
  // HDR-FLIP and flicker too.
  void look(const View& view, int index, bool own, bool whole);

  // Draws the point on the view and fills in all but its times: why it is refused, or its figures. On the
  // first view its picture is written and its passes are profiled. Points that draw what brute force does
  // share its picture, its FLIPs and its flicker.
  void measure(PointRun& run, FrontierRecord& record);

  // Another renderer's picture of the view: its errors against the truth.
  void measure_picture(const ChosenPoint& point, const Image& image, FrontierRecord& record);

 private:
  // The picture that others are compared with.
  struct Reference {
    const Image* truth = nullptr;
    double brightest = 0;  // channel; one for both kinds of surfaces, since a highlight of one pixel makes it
    std::optional<ShownReference> shown;
    std::map<const Image*, ImageError> of_brute_force = {};  // errors of its pictures
    Reference(const Image& image, double brightest_channel, const Exposure& exposure);
    ImageError error_of(const Image& image, bool with_flip = true) const;
    const ImageError& error_of_brute_force(const Image& kept);
  };
  // The truths of the techniques that share surfaces: OpenGL's, or those of the rasteriser in OpenCL.
  struct Truths {
    Truths(Renderer& renderer, GpuScene& gpu, const FrontierJob& job, bool own_surfaces);
    BruteForce brute;
    std::vector<BruteForce> turned;  // for the later frames of a slow turn
    std::optional<HdrFlip> flip;
    std::optional<Reference> reference, authored;
    std::map<const Image*, double> flicker;  // flicker of brute force's pictures
    std::optional<ImageError> surfaces;      // as in PointErrors; of OpenGL's none
    void look(const View& view, const std::vector<View>& turn);
    void take_truths(Truths& of_areas, size_t frames);  // frames of a turn
  };
  Truths& truths_of(const ChosenPoint& point);
  void refer(Truths& truths);
  void fill(PointRun& run, FrontierRecord& record);
  void fill_external(PointRun& run, FrontierRecord& record);
  PairCounts pairs_of(TechniqueRun& run, const Settings& settings, const std::vector<float>& depth);
  void choose_exposure();
  void fill_flip(const Image& image, Truths& truths, FrontierRecord& record);
  void measure_seeds(PointRun& run, Truths& truths, FrontierRecord& record);
  double flicker_of(PointRun& run, Truths& truths, const Image& first);
  double flicker_of_brute_force(const ChosenPoint& point, Truths& truths);

  Renderer& renderer_;
  const Scene& scene_;
  const SceneChoice choice_;
  const FrontierTruth truth_;
  ShadowTruth shadows_;
  std::array<Truths, 2> truths_;  // OpenGL's, OpenCL's
  Precision precision_;
  PictureFiles pictures_, nowhere_;  // the latter measures FLIP alone
  const View first_;
  std::optional<Exposure> exposure_;
  View view_;
  std::vector<View> turn_;  // empty: no flicker is measured
  std::optional<FlipExposures> exposures_;
  bool has_authored_;     // the truth's lights have no ranges, and those of the settings have
  double brightest_ = 0;  // as in Reference, of the truth
  uint64_t seed_;
};

// `count` views along the camera path. Without one and without a chosen camera: of a built-in scene that has
// a file in frontier/views, those of it (at most 16, from four places), the same for everybody; of others,
// turned about the camera's place. In an order whose every prefix is spread over the path. One view: the
// scene's first camera's.
std::vector<View> frontier_views(const Scene& scene, const View& start, const SceneChoice& choice, int count);

// Frames of a camera that turns from `start` by a quarter of a degree a frame.
std::vector<View> slow_turn(const Scene& scene, const View& start, int frames);

// The passes of a profiled run: their times and bytes.
void take_passes(const FrameFigures& result, FrontierRecord& record);

// True if a point's surfaces are those of the rasteriser in OpenCL; of another renderer, if it says so.
bool has_own_surfaces(const ChosenPoint& point);

}  // namespace lightgrid::lab
