// The engine that hard cases run on: it makes depth bounds, light grids and visibility. The library on an
// OpenCL device, or, in the tests of the cases themselves, a culler with a planted fault.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cl/program_cache.h"
#include "culling/light_culler.h"
#include "oracle/occlusion.h"
#include "plan/settings.h"
#include "raster/raster_view.h"
#include "run/frames.h"
#include "scene/animation.h"
#include "scene/host_shadows.h"
#include "scene/listed_lights.h"

namespace lightgrid::lab::verify {

// Depth values as the culler reads them: z/w of clip_from_view, row 0 at the bottom. The viewport's lower
// left corner is (x, y); its size is the view's.
struct DepthImage {
  std::vector<float> values;
  int row_pixels = 0;  // 0: the view's width
  int x = 0, y = 0;
  int samples = 1;  // a pixel's samples are adjacent
  // For each value the surface's true distance along the view axis, before a depth format rounded it. Empty:
  // follows from the values. Never passed to culling.
  std::vector<double> distances{};

  size_t index(const CullView& view, int px, int py, int sample = 0) const {
    return (size_t(py + y) * (row_pixels ? row_pixels : view.width) + px + x) * samples + sample;
  }
};

// Triangles to rasterise, and the image of them.
struct RasterInputMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
};

struct RasterInput {
  RasterCamera camera;
  std::vector<RasterInputMesh> meshes;
  std::vector<RasterInstance> instances;
};

struct RasterImage {
  std::vector<uint32_t> triangles;  // a pixel, row 0 at the bottom
  std::vector<float> depths;
  std::vector<std::vector<glm::vec4>> clip;  // each instance's vertices in clip space
  uint64_t invalid_triangles = 0;
};

// The lists of a technique, read back.
struct ListImage {
  std::vector<float> depths;  // a pixel, row 0 at the bottom; 0 for background
  std::vector<float>
      of_samples;      // the same of each sample, where OpenCL draws several: a pixel's are adjacent
  ListedLights lists;  // lists of opaque surfaces
};

// The shadows that a frame's light loops read where lights cast, and the surfaces that they shade.
struct ShadowImage {
  std::vector<float> depths;               // a pixel, row 0 at the bottom; 0 for background
  std::vector<CastingTriangle> triangles;  // the nearest opaque one
  std::vector<int> lights;                 // lights of the scene, by their indices in lists
  HostShadows shadows;
};

// A technique's frame of a scene with light groups.
struct GroupImage {
  std::vector<float> depths;      // a pixel, row 0 at the bottom; 0 for background
  std::vector<uint32_t> groups;   // groups of the visible surface; 0 for background
  std::vector<int> lights;        // lights of the scene, by their indices in lists
  ListedLights lists;             // lists of opaque surfaces, one per pixel
  std::vector<glm::vec4> pixels;  // linear
  int tile = 0;                   // pixels a side
};

// A frame of a scene that moves.
struct SequenceFrame {
  ShadowImage shadows;            // without surfaces where OpenGL draws them
  std::vector<glm::vec4> pixels;  // linear
};

// The frames of a technique by one renderer, which keeps what it may from the frames before.
class FrameSequence {
 public:
  virtual ~FrameSequence() = default;
  // changes: of the scene, after the frame before.
  virtual SequenceFrame draw(const View& view, const SceneChanges& changes) = 0;
};

// A cull from depth with all of its inputs, for the float twin.
struct KernelRun {
  CullInputs inputs;
  HostGrid grid;
};

class CullEngine {
 public:
  virtual ~CullEngine() = default;
  virtual std::string name() const = 0;

  // The library has both kernel shapes, and every depth-bounds mode.
  virtual bool is_the_library() const = 0;
  // Returns whether cases require the same bytes from both kernel shapes.
  virtual bool has_both_shapes() const { return is_the_library(); }

  virtual HostGrid cull(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                        std::span<const DepthInterval> bounds) = 0;

  // One a tile, x fastest, y from the bottom. `blend`: those for blended surfaces (options.blend must be
  // set).
  virtual std::vector<DepthInterval> depth_bounds(const CullerOptions& options, const CullView& view,
                                                  const DepthImage& depth, bool blend = false) = 0;

  // From depth to lists, as in a frame, with the depth-bounds mode applied.
  virtual HostGrid cull_depth(const CullerOptions& options, const CullView& view,
                              std::span<const CullLight> lights, const DepthImage& depth,
                              bool blend = false) = 0;

  // The same with the kernels' inputs; only for the library.
  virtual std::optional<KernelRun> kernel_run(const CullerOptions&, const CullView&,
                                              std::span<const CullLight>, const DepthImage&, bool /*blend*/) {
    return {};
  }

  // Nothing from an engine that only culls.
  virtual std::optional<RasterImage> rasterize(const RasterOptions&, const RasterInput&) { return {}; }

  // Returns the technique's lists at each pixel, one view after the other in one run. Nothing from an engine
  // that only culls, or without OpenGL where the technique draws with it. No light of the scene may cast.
  virtual std::vector<ListImage> lists(const Scene&, const std::string& /*technique*/, std::span<const View>,
                                       const Settings&) {
    return {};
  }

  // A frame for each view in one run of a technique. Nothing from an engine that only culls, or without
  // OpenGL where the technique draws with it.
  virtual std::vector<GroupImage> group_images(const Scene&, const std::string& /*technique*/,
                                               std::span<const View>, const Settings&) {
    return {};
  }

  // A run of a technique, of a scene that outlives it. Null from an engine that only culls, or without OpenGL
  // where the technique draws with it.
  virtual std::shared_ptr<TechniqueRun> run_of(const Scene&, const std::string& /*technique*/, const View&,
                                               const Settings&) {
    return {};
  }

  // Frames of a scene that outlives them and may change from one to the next, the first from `view`. Null
  // from an engine that only culls, or without OpenGL where the technique draws with it.
  virtual std::unique_ptr<FrameSequence> sequence(const Scene&, const std::string& /*technique*/,
                                                  const View& /*view*/, const Settings&) {
    return {};
  }

  // An image for each view, by one renderer that moves from view to view. Nothing from an engine that only
  // culls. Some light of the scene has to cast.
  virtual std::vector<ShadowImage> shadows(const Scene&, std::span<const View>, const Settings&) {
    return {};
  }
};

// The library on the OpenCL device whose "platform name" contains `substring`. Keeps its cullers: cases of
// all kinds reuse the same ones, as frames do. alter: changes the kernels that shadows() runs
// (cl/program_cache.h). both_shapes: whether cases run the shape for GPUs too.
std::unique_ptr<CullEngine> device_engine(const std::string& substring, ProgramCache::Alter alter = {},
                                          bool both_shapes = true);

}  // namespace lightgrid::lab::verify
