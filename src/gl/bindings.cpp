#include "gl/bindings.h"

#include <algorithm>

#include "base/error.h"

namespace lightgrid {
namespace {

struct Binding {
  const char* name;
  GLuint number;
};

#define LIGHTGRID_UNIT(name) {#name, GLuint(Sampler::name)},
#define LIGHTGRID_SHARED(name, first) LIGHTGRID_UNIT(name)
#define LIGHTGRID_COLUMN(condition, type, member, array, texels) LIGHTGRID_UNIT(array)
constexpr Binding listed_samplers[] = {LIGHTGRID_SURFACE_SAMPLERS(LIGHTGRID_UNIT) LIGHT_TABLE(
    LIGHTGRID_COLUMN) LIGHTGRID_LIGHT_SAMPLERS(LIGHTGRID_UNIT, LIGHTGRID_SHARED)};
#define LIGHTGRID_BLOCK(name) {#name, GLuint(UniformBlock::name)},
constexpr Binding listed_blocks[] = {LIGHTGRID_UNIFORM_BLOCKS(LIGHTGRID_BLOCK)};

constexpr GLuint units() {
  GLuint end = 0;
  for (const Binding& sampler : listed_samplers) end = std::max(end, sampler.number + 1);
  return end;
}
static_assert(units() <= 80, "OpenGL 4.5 guarantees 80 texture units");
static_assert(std::size(listed_blocks) <= 84, "OpenGL 4.5 guarantees 84 uniform blocks");

GLuint number_of(std::span<const Binding> list, const std::string& files, const char* kind,
                 const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Binding& b) { return name == b.name; });
  if (found == list.end())
    throw machine_error("OpenGL: {} declares the {} \"{}\", which gl/bindings.h does not list", files, kind,
                        name);
  return found->number;
}

bool is_sampler(GLenum type) {
  constexpr GLenum types[] = {GL_SAMPLER_2D,
                              GL_SAMPLER_2D_SHADOW,
                              GL_SAMPLER_2D_ARRAY,
                              GL_SAMPLER_2D_ARRAY_SHADOW,
                              GL_SAMPLER_2D_MULTISAMPLE,
                              GL_SAMPLER_3D,
                              GL_SAMPLER_CUBE,
                              GL_SAMPLER_CUBE_SHADOW,
                              GL_SAMPLER_BUFFER,
                              GL_INT_SAMPLER_2D,
                              GL_INT_SAMPLER_3D,
                              GL_INT_SAMPLER_BUFFER,
                              GL_UNSIGNED_INT_SAMPLER_2D,
                              GL_UNSIGNED_INT_SAMPLER_2D_ARRAY,
                              GL_UNSIGNED_INT_SAMPLER_3D,
                              GL_UNSIGNED_INT_SAMPLER_BUFFER};
  return std::find(std::begin(types), std::end(types), type) != std::end(types);
}

constexpr GLsizei longest_name = 128;

std::vector<ActiveSampler> active_samplers(GLuint program) {
  std::vector<ActiveSampler> samplers;
  GLint count = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < GLuint(count); ++i) {
    char name[longest_name];
    GLint elements = 0;
    GLenum type = 0;
    glGetActiveUniform(program, i, longest_name, nullptr, &elements, &type, name);
    const std::string text(name);
    if (is_sampler(type)) samplers.push_back({text.substr(0, text.find('[')), GLuint(elements)});
  }
  return samplers;
}

}  // namespace

void unbind_sampler_objects() {
  for (GLuint unit = 0; unit < units(); ++unit) glBindSampler(unit, 0);
}

std::vector<GLuint> units_of(const std::string& files, std::span<const ActiveSampler> samplers, GLuint most) {
  std::vector<GLuint> first;
  std::vector<std::string> users;  // by unit
  GLuint used = 0;
  for (const ActiveSampler& sampler : samplers) {
    first.push_back(number_of(listed_samplers, files, "sampler", sampler.name));
    users.resize(std::max<size_t>(users.size(), first.back() + sampler.count));
    for (GLuint i = 0; i < sampler.count; ++i) {
      std::string& user = users[first.back() + i];
      if (!user.empty())
        throw machine_error("OpenGL: {} reads \"{}\" and \"{}\", which share a texture unit in gl/bindings.h",
                            files, user, sampler.name);
      user = sampler.name;
    }
    used += sampler.count;
  }
  if (used > most)
    throw machine_error("OpenGL: {} reads {} textures; a shader may read {} on this driver", files, used,
                        most);
  return first;
}

void assign_bindings(GLuint program, const std::string& files) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &most);
  const std::vector<ActiveSampler> samplers = active_samplers(program);
  const std::vector<GLuint> first = units_of(files, samplers, GLuint(most));
  for (size_t i = 0; i < samplers.size(); ++i) {
    std::vector<GLint> units;
    for (GLuint k = 0; k < samplers[i].count; ++k) units.push_back(GLint(first[i] + k));
    glProgramUniform1iv(program, glGetUniformLocation(program, samplers[i].name.c_str()),
                        GLsizei(units.size()), units.data());
  }
  GLint blocks = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORM_BLOCKS, &blocks);
  for (GLuint i = 0; i < GLuint(blocks); ++i) {
    char name[longest_name];
    glGetActiveUniformBlockName(program, i, longest_name, nullptr, name);
    glUniformBlockBinding(program, i, number_of(listed_blocks, files, "uniform block", name));
  }
}

}  // namespace lightgrid
