#include "renderer/gl_scene.h"

#include <algorithm>
#include <cstring>

#include "gl/bindings.h"
#include "plan/frame_plan.h"
#include "renderer/drawing/draw_list.h"
#include "renderer/upload/scene_surfaces.h"
#include "renderer/upload/texel_chain.h"
#include "scene/rig.h"
#include "scene/triangle_numbers.h"

namespace lightgrid {
namespace {

// By slot.
struct MaterialMap {
  uint32_t feature, flag;
  TextureSlot Material::*slot;
  Sampler sampler;
};

constexpr MaterialMap material_maps[MATERIAL_MAPS] = {
    {feature_base_color_map, MATERIAL_BASE_COLOR_MAP, &Material::base_color_map, Sampler::base_color_map},
    {feature_metallic_roughness_map, MATERIAL_METALLIC_ROUGHNESS_MAP, &Material::metallic_roughness_map,
     Sampler::metallic_roughness_map},
    {feature_normal_map, MATERIAL_NORMAL_MAP, &Material::normal_map, Sampler::normal_map},
    {feature_occlusion_map, MATERIAL_OCCLUSION_MAP, &Material::occlusion_map, Sampler::occlusion_map},
    {feature_emissive_map, MATERIAL_EMISSIVE_MAP, &Material::emissive_map, Sampler::emissive_map},
    {feature_clearcoat_map, MATERIAL_CLEARCOAT_MAP, &Material::clearcoat_map, Sampler::clearcoat_map},
    {feature_clearcoat_roughness_map, MATERIAL_CLEARCOAT_ROUGHNESS_MAP, &Material::clearcoat_roughness_map,
     Sampler::clearcoat_roughness_map},
    {feature_clearcoat_normal_map, MATERIAL_CLEARCOAT_NORMAL_MAP, &Material::clearcoat_normal_map,
     Sampler::clearcoat_normal_map},
    {feature_specular_map, MATERIAL_SPECULAR_MAP, &Material::specular_map, Sampler::specular_map},
    {feature_specular_color_map, MATERIAL_SPECULAR_COLOR_MAP, &Material::specular_color_map,
     Sampler::specular_color_map},
};

MaterialParams material_params(const Material& m, int model) {
  MaterialParams p{};
  std::memcpy(p.base_color, &m.base_color, sizeof p.base_color);
  std::memcpy(p.emissive, &m.emissive, sizeof m.emissive);
  p.metallic = m.metallic;
  p.roughness = m.roughness;
  p.normal_scale = m.normal_scale;
  p.occlusion_strength = m.occlusion_strength;
  p.alpha_cutoff = m.alpha_cutoff;
  p.clearcoat = m.clearcoat;
  p.clearcoat_roughness = m.clearcoat_roughness;
  p.clearcoat_normal_scale = m.clearcoat_normal_scale;
  std::memcpy(p.subsurface, &m.model.subsurface_color, sizeof m.model.subsurface_color);
  p.subsurface[3] = m.model.roll_off;
  p.minnaert_k = m.model.minnaert_k;
  p.model = float(model);
  const glm::vec4 specular(dielectric_f0(m), m.specular);
  std::memcpy(p.specular, &specular, sizeof p.specular);
  if (m.clearcoat > 0) p.flags |= MATERIAL_CLEARCOAT;
  if (m.alpha_mode == AlphaMode::mask) p.flags |= MATERIAL_MASK;
  if (m.unlit) p.flags |= MATERIAL_UNLIT;
  for (int i = 0; i < MATERIAL_MAPS; ++i) {
    const TextureSlot& slot = m.*material_maps[i].slot;
    if (slot.texture < 0) continue;
    p.flags |= material_maps[i].flag;
    if (slot.uv_set == 1) p.uv_flags |= MATERIAL_UV1_FIRST << i;
    if (slot.transformed()) p.uv_flags |= MATERIAL_UV_TRANSFORM_FIRST << i;
    const glm::mat3x2& uv = slot.uv_from_vertex;
    const float linear[4] = {uv[0].x, uv[0].y, uv[1].x, uv[1].y}, offset[4] = {uv[2].x, uv[2].y, 0, 0};
    std::memcpy(p.uv_linear[i], linear, sizeof linear);
    std::memcpy(p.uv_offset[i], offset, sizeof offset);
  }
  return p;
}

GLint wrap_of(Wrap wrap) {
  return wrap == Wrap::clamp ? GL_CLAMP_TO_EDGE : wrap == Wrap::mirror ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

// By Filter.
constexpr GLint min_filters[] = {GL_NEAREST,
                                 GL_LINEAR,
                                 GL_NEAREST_MIPMAP_NEAREST,
                                 GL_LINEAR_MIPMAP_NEAREST,
                                 GL_NEAREST_MIPMAP_LINEAR,
                                 GL_LINEAR_MIPMAP_LINEAR};

// llvmpipe takes half of a piecewise linear logarithm as level of detail: 0 to 0.043 too small, in the mean
// over all levels (1.5 - 1 / ln 2) / 2. Samplers add the mean, at no cost (docs/conventions.md#textures).
constexpr float llvmpipe_level_bias = 0.028652f;

// The corners of a triangle keep their order: in another order its depths would round differently.
void append_reversed_triangles(std::vector<uint32_t>& indices) {
  const size_t count = indices.size();
  indices.resize(2 * count);
  for (size_t i = 0; i < count; i += 3) {
    std::copy_n(indices.begin() + i, 3, indices.end() - i - 3);
  }
}

}  // namespace

GlScene::GlScene(const Renderer& renderer, const Scene& scene) : renderer_(renderer), scene_(scene) {
  const std::vector<bool> used = shown_meshes(scene);
  upload_meshes(used);
  upload_materials(used);
  renderer.note_scene_bytes(geometry_bytes_ + texture_bytes_);
}

void GlScene::upload_meshes(const std::vector<bool>& used) {
  size_t vertices = 0;
  std::vector<uint32_t> indices;
  meshes_.resize(scene_.meshes.size());
  if (scene_.rig) {
    for (const DeformingMesh& deforming : scene_.rig->meshes) deforming_[deforming.mesh];
  }
  for (size_t i = 0; i < scene_.meshes.size(); ++i) {
    if (!used[i]) continue;
    const bool blended = scene_.materials[scene_.meshes[i].material].alpha_mode == AlphaMode::blend;
    meshes_[i].base_vertex = int(vertices);
    const size_t first = indices.size();
    meshes_[i].clusters = append_clusters(scene_.meshes[i], blended, indices);
    if (const auto found = deforming_.find(int(i)); found != deforming_.end()) {
      found->second.assign(indices.begin() + std::ptrdiff_t(first), indices.end());
    }
    vertices += scene_.meshes[i].positions.size();
  }
  positions_only_ = make_vertex_array();
  all_streams_ = make_vertex_array();

  uint32_t features = 0;
  for (size_t i = 0; i < scene_.meshes.size(); ++i) {
    if (used[i]) features |= material_features(scene_, scene_.meshes[i]);
  }

  // One buffer a stream. If only some meshes have a stream, `absent` fills it for the others; if no material
  // reads the stream, one value serves every vertex.
  const auto stream = [&](GLuint location, auto Mesh::*member, auto absent, bool any) {
    using Value = decltype(absent);
    std::vector<Value> all;
    if (any) all.reserve(vertices);
    for (size_t i = 0; any && i < scene_.meshes.size(); ++i) {
      if (!used[i]) continue;
      const std::vector<Value>& values = scene_.meshes[i].*member;
      all.insert(all.end(), values.begin(), values.end());
      if (values.empty()) all.insert(all.end(), scene_.meshes[i].positions.size(), absent);
    }
    if (any) {
      streams_.push_back(make_buffer(all.size() * sizeof(Value), all.data()));
      geometry_bytes_ += all.size() * sizeof(Value);
      stream_of_[location] = streams_.back().name();
    } else if (!absent_) {
      const glm::vec4 values[2] = {glm::vec4(0), glm::vec4(-1)};
      absent_ = make_buffer(sizeof values, values);
    }
    const GLuint buffer = any ? streams_.back().name() : absent_.name();
    const GLintptr offset = any || absent[0] == 0 ? 0 : sizeof(glm::vec4);
    for (const GlVertexArray* array : {&all_streams_, &positions_only_}) {
      if (array == &positions_only_ && location != 0) continue;
      glVertexArrayVertexBuffer(array->name(), location, buffer, offset, any ? sizeof(Value) : 0);
      glVertexArrayAttribFormat(array->name(), location, Value::length(), GL_FLOAT, GL_FALSE, 0);
      glVertexArrayAttribBinding(array->name(), location, location);
      glEnableVertexArrayAttrib(array->name(), location);
    }
  };
  stream(0, &Mesh::positions, glm::vec3(0), true);
  stream(1, &Mesh::normals, glm::vec3(0, 0, 1), true);
  stream(2, &Mesh::tangents, glm::vec4(0), features & (feature_normal_map | feature_clearcoat_normal_map));
  stream(3, &Mesh::uv0, glm::vec2(0), features & feature_textured);
  stream(4, &Mesh::uv1, glm::vec2(0), features & feature_uv1);
  stream(5, &Mesh::colors, glm::vec4(-1), features & feature_vertex_color);
  upload_indices(indices);
  index_count_ = uint32_t(indices.size());
  geometry_bytes_ += indices.size() * sizeof(uint32_t);
}

void GlScene::update(const SceneChanges& changes) {
  for (const int mesh : changes.meshes) update_mesh(mesh);
}

void GlScene::update_mesh(int index) {
  const auto found = deforming_.find(index);
  if (found == deforming_.end() || found->second.empty()) return;  // no instance shows it
  const Mesh& mesh = scene_.meshes[index];
  refresh_clusters(mesh, found->second, meshes_[index].clusters);
  const auto put = [&](GLuint location, const auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    if (stream_of_[location] == 0 || values.empty()) return;
    glNamedBufferSubData(stream_of_[location], GLintptr(meshes_[index].base_vertex) * GLintptr(sizeof(Value)),
                         GLsizeiptr(values.size() * sizeof(Value)), values.data());
    renderer_.note_scene_bytes(values.size() * sizeof(Value));
  };
  put(0, mesh.positions);
  put(1, mesh.normals);
  put(2, mesh.tangents);
  put(3, mesh.uv0);
  put(4, mesh.uv1);
  put(5, mesh.colors);
}

void GlScene::upload_indices(const std::vector<uint32_t>& indices) {
  indices_ = make_buffer(indices.size() * sizeof(uint32_t), indices.data());
  glVertexArrayElementBuffer(positions_only_.name(), indices_.name());
  glVertexArrayElementBuffer(all_streams_.name(), indices_.name());
}

std::vector<uint32_t> GlScene::read_indices() const {
  std::vector<uint32_t> indices(index_count_);
  if (index_count_ == 0) return indices;
  glGetNamedBufferSubData(indices_.name(), 0, GLsizeiptr(indices.size() * sizeof(uint32_t)), indices.data());
  return indices;
}

void GlScene::add_reversed_triangles() {
  if (reversed_triangle_bytes_ > 0 || index_count_ == 0) return;
  std::vector<uint32_t> indices = read_indices();
  append_reversed_triangles(indices);
  upload_indices(indices);
  reversed_triangle_bytes_ = size_t(index_count_) * sizeof(uint32_t);
  renderer_.note_scene_bytes(reversed_triangle_bytes_);
}

void GlScene::upload_materials(const std::vector<bool>& used_meshes) {
  GLint alignment = 256;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  material_stride_ = (sizeof(MaterialParams) + alignment - 1) / alignment * alignment;
  std::vector<char> bytes(material_stride_ * scene_.materials.size());
  slots_.resize(scene_.materials.size());
  const std::vector<MaterialModel> models = material_models(scene_);
  for (size_t i = 0; i < scene_.materials.size(); ++i) {
    const Material& m = scene_.materials[i];
    const MaterialParams params = material_params(m, m.unlit ? 0 : model_number(models, m.model));
    std::memcpy(bytes.data() + i * material_stride_, &params, sizeof params);
    for (int s = 0; s < MATERIAL_MAPS; ++s)
      slots_[i].texture[s] = (scene_.materials[i].*material_maps[s].slot).texture;
  }
  materials_ = make_buffer(bytes.size(), bytes.data());
  textures_.resize(scene_.textures.size());
  samplers_.resize(scene_.textures.size());
  for (size_t i = 0; i < scene_.meshes.size(); ++i) {
    if (!used_meshes[i]) continue;
    for (const int texture : slots_[scene_.meshes[i].material].texture) {
      if (texture >= 0 && !textures_[texture]) upload_texture(texture);
    }
  }
}

GLuint GlScene::model_records() {
  if (!model_records_) {
    const std::vector<MaterialModelRecord> records = lightgrid::model_records(scene_);
    model_records_ = make_buffer(records.size() * sizeof records[0], records.data());
  }
  return model_records_.name();
}

GLuint GlScene::triangle_numbers() {
  if (triangle_numbers_texture_) return triangle_numbers_texture_.name();
  const std::vector<uint32_t> indices = read_indices();
  std::vector<uint32_t> numbers(indices.size() / 3);
  for (size_t i = 0; i < meshes_.size(); ++i) {
    const auto& clusters = meshes_[i].clusters;
    if (clusters.empty()) continue;
    const TriangleNumbers of_mesh(scene_.meshes[i]);
    const size_t end = clusters.back().first_index + clusters.back().index_count;
    for (size_t at = clusters.front().first_index; at < end; at += 3)
      numbers[at / 3] = of_mesh.find(triangle_vertices(&indices[at])).value();
  }
  triangle_numbers_ = make_buffer(numbers.size() * sizeof numbers[0], numbers.data());
  triangle_numbers_texture_ = make_buffer_texture(GL_R32UI, triangle_numbers_.name());
  renderer_.note_scene_bytes(numbers.size() * sizeof numbers[0]);
  return triangle_numbers_texture_.name();
}

void GlScene::upload_texture(int index) {
  const Texture& texture = scene_.textures[index];
  const Bitmap& bitmap = scene_.bitmaps[texture.bitmap];
  const bool mips = texture.min_filter != Filter::nearest && texture.min_filter != Filter::linear;
  int levels = 1;
  while (mips && (std::max(bitmap.width, bitmap.height) >> levels) > 0) ++levels;
  // A software rasteriser filters 8 bits in fixed point, whose steps a normal map's scale multiplies, and 16
  // bits in float (docs/conventions.md#textures).
  const bool wide = renderer_.gl->software;
  const GLenum format = wide ? GL_RGBA16 : texture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
  textures_[index] = make_texture_2d(format, bitmap.width, bitmap.height, levels);
  const GLuint name = textures_[index].name();
  if (wide) {
    TexelImage image = linear_texels(bitmap, texture.srgb);
    for (int level = 0; level < levels; ++level) {
      if (level > 0) image = next_level(image);
      glTextureSubImage2D(name, level, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_SHORT,
                          image.values.data());
    }
  } else {
    glTextureSubImage2D(name, 0, 0, 0, bitmap.width, bitmap.height, GL_RGBA, GL_UNSIGNED_BYTE,
                        bitmap.rgba.data());
    if (levels > 1) glGenerateTextureMipmap(name);
  }
  texture_bytes_ += size_t(bitmap.width) * bitmap.height * (wide ? 8 : 4) * (levels > 1 ? 4 : 3) / 3;
  samplers_[index] = make_sampler();
  if (renderer_.gl->renderer.find("llvmpipe") != std::string::npos)
    glSamplerParameterf(samplers_[index].name(), GL_TEXTURE_LOD_BIAS, llvmpipe_level_bias);
  glSamplerParameteri(samplers_[index].name(), GL_TEXTURE_WRAP_S, wrap_of(texture.wrap_u));
  glSamplerParameteri(samplers_[index].name(), GL_TEXTURE_WRAP_T, wrap_of(texture.wrap_v));
  glSamplerParameteri(samplers_[index].name(), GL_TEXTURE_MIN_FILTER,
                      min_filters[size_t(texture.min_filter)]);
  glSamplerParameteri(samplers_[index].name(), GL_TEXTURE_MAG_FILTER,
                      texture.mag_linear ? GL_LINEAR : GL_NEAREST);
}

void GlScene::bind_material(int material, uint32_t features) const {
  glBindBufferRange(GL_UNIFORM_BUFFER, GLuint(UniformBlock::MaterialParamsBlock), materials_.name(),
                    GLintptr(material * material_stride_), sizeof(MaterialParams));
  for (int s = 0; s < MATERIAL_MAPS; ++s) {
    const int texture = slots_[material].texture[s];
    if (!(features & material_maps[s].feature) || texture < 0 || !textures_[texture]) continue;
    bind_texture(material_maps[s].sampler, textures_[texture].name());
    bind_sampler_object(material_maps[s].sampler, samplers_[texture].name());
  }
}

}  // namespace lightgrid
