// The values that the passes of one frame pass on to each other, created anew in each frame.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/bindings.h"
#include "renderer/pass_context.h"
#include "renderer/shared_grids.h"
#include "scene/host_shadows.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// Nearest opaque surfaces: reversed 32-bit float depth, 1 at the near plane, 0 for background.
struct DepthImage {
  GLuint framebuffer = 0;  // without colour
};

// The same in OpenCL's memory: row 0 at the bottom, 32-bit float.
struct DepthBuffer {
  cl::Buffer values;
};

// The nearest opaque triangle of each pixel by its number: those of these instances one after the
// other. Until the view's next look().
struct TriangleBuffer {
  cl::Buffer numbers;
  std::span<const int> instances;  // numbers in the scene
};

// A light grid, and where it lies.
struct ViewGrid : LightGrid {
  SharedGridStorage* storage = nullptr;
  size_t factor_bytes = 0;  // 0: lists are no samples

  size_t bytes() const { return cell_bytes + index_bytes + mask_bytes + z_bin_bytes + factor_bytes; }
};

// Reads the lights that a frame used at each pixel of opaque surfaces, for the oracle, from where its passes
// left them. Null: every light. depth: of the frame's surfaces, row 0 at the bottom.
using HostLists = std::function<ListedLights(const std::vector<float>& depth)>;

struct ShadedImage {
  GLuint framebuffer = 0;         // linear RGBA, 32-bit float
  SharedBuffer* in_cl = nullptr;  // set if the final image is only in this buffer, row 0 at the bottom; the
                                  // framebuffer is then stale
};

// The same as a display shows it: sRGB, 8 bits a channel, alpha 255.
struct DisplayedImage {
  GLuint framebuffer = 0;         // RGBA8
  SharedBuffer* in_cl = nullptr;  // set if it is in this buffer alone, row 0 at the bottom
};

// The work for the shadows of a frame, for results.json.
struct ShadowFigures {
  size_t lights = 0;       // whose shadows were found
  size_t rays = 0;         // traced
  size_t maps = 0;         // in use, of these
  size_t drawn = 0;        // drawn in this frame, and
  size_t kept = 0;         // kept from frames before
  bool unchanged = false;  // all are those of the frame before, and nothing was found
  size_t bytes = 0;        // bytes of bits and maps
  size_t undecided = 0;    // pairs that maps left to rays
  size_t bands = 0;        // bands of tiles, each shaded separately: their bits fit into memory
  int halvings = 0;        // halvings of all maps' sizes, to fit into their bound of memory
  size_t tiles_kept = 0;   // with shadow-reuse: tiles whose bits are all those of the frame before

  // Adds the figures of other lights of the same frame.
  ShadowFigures& operator+=(const ShadowFigures& more) {
    lights += more.lights;
    rays += more.rays;
    maps += more.maps;
    drawn += more.drawn;
    kept += more.kept;
    bytes += more.bytes;
    undecided += more.undecided;
    halvings += more.halvings;
    tiles_kept += more.tiles_kept;
    return *this;
  }
};

// The work for several samples per pixel, for results.json.
struct SampleFigures {
  size_t edge_pixels = 0;          // whose samples see more than one surface
  size_t shadings = 0;             // surfaces that were shaded, each once a pixel
  size_t covered = 0;              // samples that see a surface: what shading each of them would take
  size_t bytes = 0;                // bytes of images of samples and of edges
  std::vector<uint32_t> surfaces;  // number of surfaces per edge pixel, with the background; elsewhere 0
};

// A technique's result, for readers of the frame: the image, input of the oracle, memory figures.
struct Frame {
  ShadedImage image;
  std::optional<DisplayedImage> displayed;  // with picture=bytes
  std::optional<ViewGrid> grid;             // grid of opaque surfaces
  std::optional<ViewGrid> blend_grid;       // grid of blended surfaces
  HostLists listed;                         // lists of opaque surfaces
  std::function<HostShadows()> shadows;     // reads those that it shaded with, for the oracle; null: none
  std::function<std::vector<HostShadowLayer>()> blended_shadows;  // shadows of its blended surfaces, likewise
  bool lights_in_volume = false;  // which has no shadows: all count as seen, also those shaded apart
  size_t list_bytes = 0;          // bytes of lists of lights in no grid
  std::string built_by;           // the pass whose result serves many frames, if there is one, and
  std::map<std::string, double> built_with;  // values that it chose, by their keys in results.json
  std::optional<DepthBuffer> depth;  // for techniques that rasterise in OpenCL; else the depth image has it
  std::optional<TriangleBuffer> triangles;        // for the same techniques
  std::function<ShadowFigures()> shadow_figures;  // null where `shadows` is; waits
  std::function<SampleFigures()> sample_figures;  // null with one sample a pixel; waits

  // Bytes of all these, in use.
  size_t light_grid_bytes() const {
    size_t bytes = list_bytes;
    for (const auto* g : {&grid, &blend_grid}) bytes += *g ? (*g)->bytes() : 0;
    return bytes;
  }
};

}  // namespace lightgrid
