// The geometry buffer: the surface of each pixel for deferred light passes. A pixel's position is not stored:
// it follows from depth (shaders/common/position.glsl).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "passes/common/frame.h"
#include "passes/common/surface_numbers.h"

namespace lightgrid {

// Four channels, stored in OpenGL as glReadPixels(GL_RGBA, type) returns them, so that reading is a plain
// copy.
struct GBufferImage {
  const char* name;  // name of the target (Targets), counted as memory_bytes.gbuffer
  GLenum format, type;
  size_t bytes;  // a pixel
};

// Channels, in both orders of bits (shared/gbuffer.h):
//   8 and 16 bits
//   [0]  octahedral normal u, v in view space; perceptual roughness; metallic
//   [1]  base color red, green, blue, as their square roots in 8 bits; 1 where lights reach, else 0. Where
//        the material's model has a number above 0 (scene/material_model.h), that number, 1 to 254, is the
//        stored integer
//   32 bits
//   [0]  normal x, y, z in view space; perceptual roughness
//   [1]  base color red, green, blue; 1 + metallic + 2 * the model's number, -1 - metallic for unlit
//        surfaces, 0 where nothing is
// With SurfacePlan::clearcoat a third image:
//   [2]  of the coat: octahedral normal u, v in view space; perceptual roughness; factor, 0 where there is
//        none. In 32 bits a negative factor: the normal is that of [0], stored without loss
// With SurfacePlan::specular another one:
//   [3]  of the dielectric part: reflectance at normal incidence red, green, blue, as their square roots in 8
//        and 16 bits; at grazing incidence
// If effects have masks, a separate image has the surfaces' numbers (surface_numbers.h).
// Only a model's number is stored: its parameters are exact at any number of bits.
// In fixed point, u = (n - (s + 1)) / s with s = 127 or 32767 and n the stored
// integer; all other channels are n / 255 or n / 65535.
inline constexpr size_t gbuffer_coat = 2, gbuffer_specular = 3, gbuffer_most_images = 4;

struct GBufferLayout {
  int bits;
  const char* define;  // define for shaders; null for 32 bits
  std::array<GBufferImage, gbuffer_most_images> images;
  // A pixel.
  size_t bytes(const std::vector<size_t>& which) const {
    size_t sum = 0;
    for (const size_t i : which) sum += images[i].bytes;
    return sum;
  }
};

inline constexpr GBufferLayout gbuffer_layouts[] = {
    {8,
     "GBUFFER_8",
     {{{"gbuffer_normal_8", GL_RGBA8, GL_UNSIGNED_BYTE, 4},
       {"gbuffer_color_8", GL_RGBA8, GL_UNSIGNED_BYTE, 4},
       {"gbuffer_coat_8", GL_RGBA8, GL_UNSIGNED_BYTE, 4},
       {"gbuffer_specular_8", GL_RGBA8, GL_UNSIGNED_BYTE, 4}}}},
    {16,
     "GBUFFER_16",
     {{{"gbuffer_normal_16", GL_RGBA16, GL_UNSIGNED_SHORT, 8},
       {"gbuffer_color_16", GL_RGBA16, GL_UNSIGNED_SHORT, 8},
       {"gbuffer_coat_16", GL_RGBA16, GL_UNSIGNED_SHORT, 8},
       {"gbuffer_specular_16", GL_RGBA16, GL_UNSIGNED_SHORT, 8}}}},
    {32,
     nullptr,
     {{{"gbuffer_normal_32", GL_RGBA32F, GL_FLOAT, 16},
       {"gbuffer_color_32", GL_RGBA32F, GL_FLOAT, 16},
       {"gbuffer_coat_32", GL_RGBA32F, GL_FLOAT, 16},
       {"gbuffer_specular_32", GL_RGBA32F, GL_FLOAT, 16}}}},
};

// Where base lighting (ambient, emissive, directional, unlit color) is added. in_image: by the geometry pass;
// light passes add to the image. in_light_pass: by the light pass, possible only for plain ambient light
// (SurfacePlan::base_lighting); the geometry pass then writes no image.
enum class BaseLighting { in_image, in_light_pass };

// The same surfaces as plain bytes in OpenCL's memory, row 0 at the bottom: copied from OpenGL, or written
// there (passes/resolve.h).
struct GBufferInCl {
  BaseLighting base_lighting = BaseLighting::in_image;
  const GBufferLayout* layout = nullptr;
  std::vector<size_t> images;                                 // numbers of those that there are
  std::array<SharedBuffer*, gbuffer_most_images> surfaces{};  // by number; null without
  SharedBuffer* image = nullptr;                              // for light passes to add to, or to write
  SharedBuffer* surface_numbers = nullptr;                    // null without
  size_t number_bytes = 0;
  cl::Buffer edges;  // StoredSurfaces::edges (passes/sample_edges.h)
  size_t bytes() const { return layout->bytes(images) + number_bytes; }  // a sample, without `image`
  cl::Buffer in_cl(size_t i) const { return surfaces[i] ? surfaces[i]->cl_buffer() : cl::Buffer(); }
};

// The layout that the setting buffer-bits selects.
const GBufferLayout& gbuffer_layout(const Settings& settings);

// The defines of light passes that read a geometry buffer: SKIN, MINNAERT.
std::vector<const char*> model_defines(const FramePlan& plan);

// The view's buffers, written or not. Both throw Error(input) where the scene has more models than a channel
// of 8 bits can number. use: gbuffer where they are no copies.
GBufferInCl gbuffer_in_cl_of(PassContext& work, BaseLighting base_lighting, TargetUse use);

struct GBuffer {
  BaseLighting base_lighting = BaseLighting::in_image;
  const GBufferLayout* layout = nullptr;
  std::vector<size_t> images;       // numbers of those that there are
  std::vector<const char*> models;  // defines; empty: Lambert's alone
  GLuint model_records = 0;         // MaterialModelRecord each; 0 without
  // The first two images, for base lighting the image, then the others, then the surfaces' numbers; over
  // depth.
  GLuint framebuffer = 0;
  std::array<GLuint, gbuffer_most_images> textures{};  // by number; 0 without
  GLuint surface_numbers = 0;                          // texture; 0 without
  size_t number_bytes = 0;
  GLuint depth = 0;
  DepthImage depth_image;
  ShadedImage image;                 // contains base lighting, for light passes to add to
  std::optional<GBufferInCl> in_cl;  // where OpenCL wrote it: all else is then empty
  size_t bytes() const { return layout->bytes(images) + number_bytes; }  // a pixel
  int number_attachment() const {
    return int(images.size()) + (base_lighting == BaseLighting::in_image ? 1 : 0);
  }
  // The place of an image by its number.
  int attachment(size_t i) const {
    const int place = int(std::find(images.begin(), images.end(), i) - images.begin());
    return place < 2 || base_lighting != BaseLighting::in_image ? place : place + 1;
  }
};

// The view's geometry buffer in the layout of buffer-bits, drawn or not.
GBuffer gbuffer_of(PassContext& work, BaseLighting base_lighting = BaseLighting::in_image);

// The defines of shaders that read the geometry buffer (shaders/common/read_gbuffer.glsl), whose textures
// bind_gbuffer binds.
std::vector<std::string> gbuffer_defines(const GBuffer& gbuffer);
void bind_gbuffer(const GBuffer& gbuffer);

}  // namespace lightgrid
