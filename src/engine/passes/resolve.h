// From triangle numbers to radiance, in OpenCL: the resolve pass, and blended surfaces over its image.
#pragma once

#include "passes/common/gbuffer.h"
#include "passes/common/light_buffer.h"
#include "passes/rasterize.h"

namespace lightgrid {

// Attributes, textures and light of every pixel in one pass. The image stays in OpenCL's memory.
ShadedImage resolve(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                    const LightSource& lights);

// The surface of every pixel into a geometry buffer of the layout of buffer-bits, as fill_gbuffer does with
// OpenGL. With BaseLighting::in_image it writes the image too. With several samples a pixel each stores the
// surface that it sees, which is shaded once a pixel, as by resolve(); the image takes their mean.
GBufferInCl resolve_gbuffer(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                            BaseLighting base_lighting);

// The normal of every pixel, or of every sample's surface, in the format of the setting normals, as
// fill_normals does with OpenGL.
NormalsInCl resolve_normals(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible);

// Every pixel's material under its sums of light: the material pass of light_prepass. With several samples a
// pixel a surface shows the mean over the sums of its samples. The image stays in OpenCL's memory.
ShadedImage resolve_materials(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                              const LightBufferInCl& sums);

// For a view whose eye is at a light: the light that each pixel reflects. Float4 each, row 0 at the bottom:
// flux and area; normal and distance ahead (scene/virtual_lights.h: ReflectedPixel).
struct ReflectedLight {
  SharedBuffer *flux = nullptr, *places = nullptr;
};

// light: its place in LightPlan::local.
ReflectedLight resolve_reflected(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                                 uint32_t light);

// Lays blended surfaces over the image of resolve() or of a light pass in OpenCL, where they are in front of
// the opaque ones.
void blend_resolved(PassContext& work, Cached<Resolver>& cache, const BlendedTriangles& blended,
                    const DepthBuffer& depth, const LightSource& lights);

}  // namespace lightgrid
