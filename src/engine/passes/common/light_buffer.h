// The images between the passes of light_prepass: normals, and the sums of all lights
// (shared/light_buffer.h).
#pragma once

#include "passes/common/light_source.h"
#include "passes/common/prepass_settings.h"
#include "passes/common/surface_numbers.h"

namespace lightgrid {

// One image in OpenGL, or a buffer of the same bytes in OpenCL's memory, row 0 at the bottom.
struct PrepassImage {
  const char* name;    // name of the target, counted as memory_bytes.gbuffer
  GLenum format;       // format of the texture
  GLenum pixel, type;  // as glReadPixels and glTextureSubImage2D take them
  size_t bytes;        // a pixel
};

// A value of the setting normals, stored as shared/stored_normal.h says.
struct NormalLayout {
  NormalFormat format;
  const char* define;  // define for shaders and kernels; null: floats, x, y and z and a spare
  PrepassImage image;
};

inline constexpr NormalLayout normal_layouts[] = {
    {NormalFormat::floats, nullptr, {"normals_float", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16}},
    {NormalFormat::octahedral, "NORMALS_OCTAHEDRAL", {"normals_16", GL_RG16, GL_RG, GL_UNSIGNED_SHORT, 4}},
    {NormalFormat::spheremap, "NORMALS_SPHEREMAP", {"normals_16", GL_RG16, GL_RG, GL_UNSIGNED_SHORT, 4}},
    {NormalFormat::xyz8, "NORMALS_XYZ8", {"normals_8", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4}},
};

// A value of buffer-bits. Channels: diffuse red, green, blue and the specular term; with
// prepass-specular=fifth-term the fifth term and Schlick's part of the specular one.
struct LightBufferLayout {
  int bits;
  PrepassImage first, second;
};

inline constexpr LightBufferLayout light_buffer_layouts[] = {
    {8,
     {"light_buffer_8", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
     {"light_buffer_second_8", GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2}},
    {16,
     {"light_buffer_16", GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8},
     {"light_buffer_second_16", GL_RG16F, GL_RG, GL_HALF_FLOAT, 4}},
    {32,
     {"light_buffer_32", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
     {"light_buffer_second_32", GL_RG32F, GL_RG, GL_FLOAT, 8}},
};

const NormalLayout& normal_layout(const Settings& settings);
const LightBufferLayout& light_buffer_layout(const Settings& settings);

// The define of prepass-specular (shared/light_buffer.h); null: plain, or no specular term.
const char* prepass_define(const Settings& settings);

// True if the light buffer has a second image.
bool has_fifth_term(const Settings& settings);
size_t bytes_of_light_buffer(const Settings& settings);  // a sample

// True if the fourth channel of normals is the perceptual roughness. Throws if their format has three channels.
bool stores_roughness(const Settings& settings);

// True if the first image has hue, luminance and the specular term (shared/light_luv.h).
bool stores_luv(const Settings& settings);

// The light that fixed point stores as 1 and that is 1 to equation 8.5.7: the irradiance of the brightest
// light at an eighth of its range (without a range, at 1 m), rounded up to a power of two. A light is
// brighter than that in 1/512 of its ball. Of the scene, not the view: a camera that moves keeps it.
double reference_light(const Scene& scene, const FramePlan& plan);

// Sums are stored divided by this: 1 in 32 bits, in 8 and 16 the reference light.
double stored_scale(const ViewState& seen);

// Defines of shaders that write the light buffer and of those that read it.
std::vector<std::string> light_buffer_defines(const ViewState& seen);

// In OpenGL.
struct NormalImage {
  const NormalLayout* layout = nullptr;
  GLuint texture = 0;
  GLuint surface_numbers = 0;  // 0: none (surface_numbers.h)
  GLuint framebuffer = 0;      // the image, then the numbers, over the frame's depth
  DepthImage depth;
};

struct LightBuffer {
  const LightBufferLayout* layout = nullptr;
  GLuint first = 0, second = 0;  // textures; second 0: no fifth term
  bool in_a_row = false;         // samples, in images of one (Targets::in_a_row)
  size_t bytes() const { return layout->first.bytes + (second ? layout->second.bytes : 0); }  // a sample
};

// The view's images, drawn or not.
NormalImage normal_image_of(PassContext& work);
// from_cl: OpenCL writes the buffer, whose copies are images of one sample.
LightBuffer light_buffer_of(PassContext& work, bool from_cl = false);

// Normals as plain bytes in OpenCL's memory, row 0 at the bottom.
struct NormalsInCl {
  const NormalLayout* layout = nullptr;
  SharedBuffer* image = nullptr;
  SharedBuffer* surface_numbers = nullptr;  // null: none
  cl::Buffer edges;                         // StoredSurfaces::edges (passes/sample_edges.h)
};

// The view's buffer, written or not. use: gbuffer where it is no copy.
NormalsInCl normals_in_cl_of(PassContext& work, TargetUse use);

// The sums in OpenCL's memory. second: null without a fifth term.
struct LightBufferInCl {
  const LightBufferLayout* layout = nullptr;
  SharedBuffer *first = nullptr, *second = nullptr;
  size_t bytes() const { return layout->first.bytes + (second ? layout->second.bytes : 0); }
};

// The light of the sums.
LightSource from_light_buffer(const ViewState& seen, const LightBuffer& buffer);

}  // namespace lightgrid
