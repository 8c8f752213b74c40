#include "passes/light_index/index_shadows.h"

#include <fmt/format.h>
#include <algorithm>
#include <bit>

#include "base/error.h"
#include "passes/shadows/triangle_numbers.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"
#include "plan/settings/surfaces.h"

namespace lightgrid {
namespace {

constexpr size_t min_table_bytes = 64;  // least size of a buffer
constexpr size_t corner_bytes = 16;

bool reads_maps(const ViewState& seen) {
  return seen.plan.settings[setting::lidr_shadows] != LidrShadows::volumes;
}

// A hard shadow is decided by one texel.
int taps_of(const Settings& settings) {
  return settings[setting::lidr_shadows] == LidrShadows::prepass ? 1 : settings[setting::shadow_taps];
}

GLenum texel_format(const Settings& settings) {
  return settings[setting::shadow_bits] == 32   ? GL_R32F
         : settings[setting::shadow_bits] == 24 ? GL_R32UI
                                                : GL_R16UI;
}

size_t max_texel_bytes(const Settings& settings) {
  return max_texture_bytes(settings[setting::shadow_bits] == 16 ? GL_R16UI : GL_R32UI);
}

void add(std::vector<uint32_t>& words, const float (&v)[3]) {
  for (const float each : v) words.push_back(std::bit_cast<uint32_t>(each));
}

// As ShadowPlan::shadowed has them.
std::vector<uint8_t> shadowed_of(const FramePlan& plan) {
  std::vector<uint8_t> shadowed = plan.shadows.own_shadowed;
  shadowed.resize(plan.lights.local.size() + plan.lights.directional.size());
  return shadowed;
}

std::vector<uint32_t> light_words(const ViewState& seen, const glm::dvec3& origin, const ShadowAtlas* atlas) {
  const FramePlan& plan = seen.plan;
  std::vector<uint32_t> words;
  for (size_t i = 0; i < plan.lights.local.size(); ++i) {
    const size_t number = size_t(plan.lights.local[i]);
    const Light& light = seen.scene.lights[number];
    const glm::vec3 at(light.position - origin);
    const float range = std::min(float(range_of(light, number, ranges_of(plan.settings))), 1e18f);
    add(words, {at.x, at.y, at.z});
    words.push_back(std::bit_cast<uint32_t>(range));
    words.push_back(has_own_shadow(plan, i));
    words.push_back(atlas ? atlas->lights[i][0] : 0);
    words.push_back(atlas ? atlas->lights[i][1] : 0);
    words.push_back(0);
  }
  return words;
}

std::vector<uint32_t> face_words(const ShadowAtlas& atlas) {
  std::vector<uint32_t> words;
  for (const ShadowFace& face : atlas.faces) {
    add(words, face.from);
    words.push_back(std::bit_cast<uint32_t>(face.extent));
    add(words, face.right);
    words.push_back(std::bit_cast<uint32_t>(face.range_m));
    add(words, face.up);
    words.push_back(face.size);
    add(words, face.ahead);
    words.push_back(face.first);
  }
  return words;
}

}  // namespace

void IndexShadows::Table::put(const std::vector<uint32_t>& words) {
  const size_t needed = std::max(words.size() * sizeof words[0], min_table_bytes);
  if (bytes < needed) {
    texture = GlTexture();
    buffer = make_buffer(needed, nullptr);
    bytes = needed;
    texture = make_buffer_texture(GL_RGBA32UI, buffer.name());
  }
  if (!words.empty())
    glNamedBufferSubData(buffer.name(), 0, GLsizeiptr(words.size() * sizeof words[0]), words.data());
}

IndexShadows::IndexShadows(PassContext& work) {
  if (reads_maps(work)) {
    const Settings& settings = work.plan.settings;
    maps_.emplace(work, taps_of(settings), max_texel_bytes(settings));
  } else {
    casters_.emplace(work);
  }
}

bool IndexShadows::follow(PassContext&) {
  view_uploaded_ = false;
  return true;
}

size_t IndexShadows::memory_bytes() const {
  size_t bytes = corners_.bytes() + texels_.bytes() + lights_.bytes + faces_.bytes + min_table_bytes;
  if (scene_) bytes += scene_->memory_bytes();
  if (maps_) bytes += maps_->memory_bytes();
  if (casters_) bytes += casters_->memory_bytes();
  return bytes;
}

void IndexShadows::find(PassContext& work, bool numbered) {
  // A map has no share of a light for alpha to hide.
  const bool opaque = work.plan.settings[setting::shadow_blended] == BlendedCasters::opaque;
  scene_ = work.gpu.in_rays(work.plan.settings[setting::texels],
                            opaque ? BlendedCasters::opaque : BlendedCasters::none);
  upload_corners(work);
  if (!view_uploaded_) upload_view(work);
  view_uploaded_ = true;
  if (maps_) draw_maps(work);
  if (casters_) casters_->begin_frame(work, *scene_);
  triangles_ = work.targets.texture("triangle numbers", GL_R32UI);
  glTextureParameteri(triangles_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(triangles_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  if (numbered) return;
  auto pass = work.timer.pass("triangle_numbers", "gl");
  draw_triangle_numbers(work, *scene_);
  pass.moves(work.gpu.in_gl().geometry_bytes(), work.grid().values() * 4);
}

void IndexShadows::upload_corners(PassContext& work) {
  const int shape = work.gpu.shape_version(), instances = work.gpu.instances_version();
  if (shape == shape_ && instances == instances_) return;
  shape_ = shape;
  instances_ = instances;
  auto pass = work.timer.pass("triangle_corners", "cl");
  const size_t triangles = scene_->triangles(),
               bytes = std::max(triangles * 3 * corner_bytes, min_table_bytes);
  if (const size_t most = max_texture_bytes(GL_R32UI) * 4; bytes > most) {
    throw machine_error(
        "shadows: {} bytes of triangles are more than the {} that a buffer texture may have in this "
        "OpenGL; use lidr-shadows=pass",
        bytes, most);
  }
  const cl::Buffer& corners = corners_.at_least(work.renderer, bytes, GL_RGBA32F, true);
  corners_kernel_ = NamedKernel(*work.renderer.kernels, "shadows/ray_corners", scene_->defines());
  if (triangles > 0)
    corners_kernel_.launch(*work.renderer.cl, "ray_corners", cl::NDRange(triangles), cl::NullRange,
                           scene_->arguments() + ClArguments{{"corners", corners}});
  corners_.buffer->hand_to_gl(bytes);
  pass.moves(scene_->memory_bytes(), bytes);
}

void IndexShadows::upload_view(PassContext& work) {
  const glm::dvec3 origin = scene_->origin(), eye = work.view.eye - origin;
  const glm::dmat3 view_from_world(work.view.view_from_world);
  glm::vec4 block[4];
  for (int row = 0; row < 3; ++row)
    block[row] =
        glm::vec4(glm::vec3(view_from_world * glm::dvec3(row == 0, row == 1, row == 2)), float(eye[row]));
  const glm::dvec3 ahead = glm::transpose(view_from_world)[2];
  block[3] = work.view.orthographic ? glm::vec4(glm::vec3(ahead), 0) : glm::vec4(glm::vec3(eye), 1);
  if (!view_block_) view_block_ = make_buffer(sizeof block, nullptr);
  glNamedBufferSubData(view_block_.name(), 0, sizeof block, block);
  if (maps_) maps_->look(work, *scene_, shadowed_of(work.plan));
  lights_.put(light_words(work, origin, maps_ ? &maps_->atlas() : nullptr));
  if (maps_) faces_.put(face_words(maps_->atlas()));
}

void IndexShadows::draw_maps(PassContext& work) {
  auto pass = work.timer.pass("shadow_maps", "cl");
  const size_t bytes = std::max(maps_->atlas().bytes, min_table_bytes),
               most = max_texel_bytes(work.plan.settings);
  if (bytes > most) {
    throw machine_error(
        "shadows: {} bytes of shadow maps are more than the {} that a buffer texture may have in this "
        "OpenGL; let fewer lights cast, or use shadow-bits=16",
        bytes, most);
  }
  const cl::Buffer& texels = texels_.at_least(work.renderer, bytes, texel_format(work.plan.settings), true);
  maps_->draw(*scene_, texels);
  texels_.buffer->hand_to_gl(bytes);
  pass.moves(scene_->memory_bytes(), bytes);
}

GlLightLoop IndexShadows::input(PassContext& work) const {
  GlLightLoop loop;
  loop.textures = {{Sampler::receiver_triangles, triangles_},
                   {Sampler::triangle_corners, corners_.texture.name()},
                   {Sampler::shadow_lights, lights_.texture.name()},
                   {Sampler::depth_image, work.targets.depth()}};
  loop.blocks = {{UniformBlock::ReceiverBlock, view_block_.name()}};
  loop.defines = {"INDEX_SHADOWS"};
  if (casters_) {
    loop.textures.push_back({Sampler::shadow_stencil, casters_->stencil()});
    loop.defines.emplace_back("SHADOW_VOLUMES");
    return loop;
  }
  loop.textures.push_back({Sampler::shadow_faces, faces_.texture.name()});
  loop.textures.push_back({Sampler::shadow_texels, texels_.texture.name()});
  loop.defines.push_back(fmt::format("SHADOW_BITS {}", work.plan.settings[setting::shadow_bits]));
  loop.defines.push_back(fmt::format("SHADOW_TAPS {}", taps_of(work.plan.settings)));
  return loop;
}

ShadowFigures IndexShadows::figures(const PassContext& work) const {
  ShadowFigures f;
  f.lights = size_t(std::ranges::count(work.plan.shadows.own_shadowed, 1));
  constexpr size_t depth_stencil = 8;
  f.bytes = corners_.bytes() + work.grid().values() * 4;
  if (casters_) f.bytes += casters_->memory_bytes() + work.grid().values() * depth_stencil;
  if (maps_) {
    f.maps = f.drawn = f.lights;
    f.halvings = maps_->atlas().halvings;
    f.bytes += maps_->atlas().bytes;
  }
  return f;
}

}  // namespace lightgrid
