#include "passes/common/light_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "passes/common/prepass_settings.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "scene/light_ranges.h"

namespace lightgrid {

const NormalLayout& normal_layout(const Settings& settings) {
  return *std::ranges::find(normal_layouts, settings[setting::normals], &NormalLayout::format);
}

const LightBufferLayout& light_buffer_layout(const Settings& settings) {
  return *std::ranges::find(light_buffer_layouts, settings[setting::buffer_bits], &LightBufferLayout::bits);
}

const char* prepass_define(const Settings& settings) {
  if (settings[setting::brdf] == Brdf::lambert) return nullptr;
  switch (settings[setting::prepass_specular]) {
    case PrepassSpecular::plain:
      return nullptr;
    case PrepassSpecular::fifth_term:
      return "PREPASS_FIFTH_TERM";
    case PrepassSpecular::luminance:
      return "PREPASS_LUMINANCE";
    case PrepassSpecular::bent:
      return "PREPASS_BENT";
    case PrepassSpecular::stored:
      return "PREPASS_STORED";
  }
  return nullptr;
}

bool has_fifth_term(const Settings& settings) {
  return settings[setting::prepass_specular] == PrepassSpecular::fifth_term &&
         settings[setting::brdf] != Brdf::lambert;
}

bool stores_roughness(const Settings& settings) {
  const bool stored = settings[setting::prepass_specular] == PrepassSpecular::stored &&
                      settings[setting::brdf] != Brdf::lambert;
  const NormalFormat format = settings[setting::normals];
  if (stored && format != NormalFormat::floats && format != NormalFormat::xyz8)
    throw input_error(
        "light_prepass: prepass-specular=stored needs a channel next to the normal; choose normals=float or "
        "xyz8");
  return stored;
}

bool stores_luv(const Settings& settings) {
  return settings[setting::light_buffer_color] == LightBufferColor::luv;
}

size_t bytes_of_light_buffer(const Settings& settings) {
  const LightBufferLayout& layout = light_buffer_layout(settings);
  return layout.first.bytes + (has_fifth_term(settings) ? layout.second.bytes : 0);
}

double reference_light(const Scene& scene, const FramePlan& plan) {
  double brightest = 0;
  for (const int i : plan.lights.local) {
    const Light& light = scene.lights[size_t(i)];
    const double range = range_of(light, size_t(i), ranges_of(plan.settings));
    const double from = std::isfinite(range) && range > 0 ? range / 8 : 1;
    const double irradiance = brightest_intensity(light) / (from * from);
    if (std::isfinite(irradiance)) brightest = std::max(brightest, irradiance);
  }
  const double rounded = brightest > 0 ? std::exp2(std::ceil(std::log2(brightest))) : 1;
  return std::clamp(rounded, 0x1p-60, 0x1p60);
}

double stored_scale(const ViewState& seen) {
  return seen.plan.settings[setting::buffer_bits] == 32 ? 1 : reference_light(seen.scene, seen.plan);
}

std::vector<std::string> light_buffer_defines(const ViewState& seen) {
  const Settings& s = seen.plan.settings;
  std::vector<std::string> defines = {
      fmt::format("LIGHT_EXPONENT {:.1f}", double(s[setting::prepass_shininess])),
      fmt::format("LIGHT_SCALE {:.17e}", stored_scale(seen))};
  if (const char* define = prepass_define(s)) defines.emplace_back(define);
  if (stores_luv(s)) defines.emplace_back("LIGHT_LUV");
  return defines;
}

NormalImage normal_image_of(PassContext& work) {
  NormalImage n;
  n.layout = &normal_layout(work.plan.settings);
  n.texture = work.targets.texture(n.layout->image.name, n.layout->image.format, TargetUse::gbuffer);
  n.surface_numbers = surface_number_image(work);
  std::vector<GLuint> images = {n.texture};
  if (n.surface_numbers) images.push_back(n.surface_numbers);
  n.framebuffer = work.targets.framebuffer(images, work.targets.depth());
  n.depth = {work.depth_framebuffer()};
  return n;
}

NormalsInCl normals_in_cl_of(PassContext& work, TargetUse use) {
  const NormalLayout& layout = normal_layout(work.plan.settings);
  return {&layout, &work.shared_samples("normals", layout.image.bytes, use),
          surface_numbers_in_cl(work, use)};
}

LightBuffer light_buffer_of(PassContext& work, bool from_cl) {
  LightBuffer b;
  b.layout = &light_buffer_layout(work.plan.settings);
  b.in_a_row = from_cl && work.grid().samples > 1;
  const auto texture = [&](const PrepassImage& image) {
    return b.in_a_row ? work.targets.in_a_row(image.name, image.format, TargetUse::gbuffer)
                      : work.targets.texture(image.name, image.format, TargetUse::gbuffer);
  };
  b.first = texture(b.layout->first);
  if (has_fifth_term(work.plan.settings)) b.second = texture(b.layout->second);
  return b;
}

LightSource from_light_buffer(const ViewState& seen, const LightBuffer& buffer) {
  const auto in_gl = [&seen, buffer] {
    GlLightLoop loop = base_lighting(seen);
    loop.defines.emplace_back("LIGHTS");
    loop.defines.emplace_back("LIGHTS_BUFFER");
    if (seen.grid().samples > 1) loop.defines.emplace_back("PER_SAMPLE");
    if (buffer.in_a_row) loop.defines.emplace_back("SAMPLES_IN_A_ROW");
    for (std::string& define : light_buffer_defines(seen)) loop.defines.push_back(std::move(define));
    // Where nothing reads it, lights of another brightness need no other program.
    const bool read = seen.plan.settings[setting::prepass_specular] == PrepassSpecular::bent ||
                      seen.plan.surfaces.skin || seen.plan.surfaces.minnaert;
    loop.defines.push_back(
        fmt::format("LIGHT_REFERENCE {:.17e}", read ? reference_light(seen.scene, seen.plan) : 1.0));
    loop.textures = {{Sampler::light_buffer, buffer.first}};
    if (buffer.second) loop.textures.push_back({Sampler::light_buffer_second, buffer.second});
    return loop;
  };
  return LightSource(in_gl, {}, seen.grid().values() * buffer.bytes());
}

}  // namespace lightgrid
