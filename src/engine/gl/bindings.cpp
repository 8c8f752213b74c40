#include "gl/bindings.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

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

// The names of inputs, numbered from `first` on.
class InputNumbers {
 public:
  explicit InputNumbers(GLuint first) : first_(first) {}
  GLuint of(const std::string& name) {
    const std::lock_guard lock(mutex_);
    return numbers_.try_emplace(name, first_ + GLuint(numbers_.size())).first->second;
  }
  std::optional<GLuint> find(const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  const GLuint first_;
  std::mutex mutex_;
  std::map<std::string, GLuint> numbers_;
};
InputNumbers input_units(units()), input_points(GLuint(std::size(listed_blocks)));

GLuint number_of(std::span<const Binding> list, InputNumbers& inputs, const std::string& files,
                 const char* kind, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Binding& b) { return name == b.name; });
  if (found != list.end()) return found->number;
  if (const std::optional<GLuint> input = inputs.find(name)) return *input;
  throw machine_error("OpenGL: {} declares the {} \"{}\", which gl/bindings.h does not list", files, kind,
                      name);
}

// Neither a number, a vector or a matrix, nor an image.
bool is_sampler(GLenum type) {
  const auto within = [&](GLenum first, GLenum last) { return type >= first && type <= last; };
  return !within(0, GL_DOUBLE) && !within(GL_FLOAT_VEC2, GL_FLOAT_MAT4) &&
         !within(GL_FLOAT_MAT2x3, GL_FLOAT_MAT4x3) && !within(GL_UNSIGNED_INT_VEC2, GL_UNSIGNED_INT_VEC4) &&
         !within(GL_IMAGE_1D, GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY);
}

constexpr GLsizei longest_name = 128;

GLint parameter(GLuint program, GLenum name) {
  GLint value = 0;
  glGetProgramiv(program, name, &value);
  return value;
}

}  // namespace

GLuint unit_of_input(const std::string& sampler) { return input_units.of(sampler); }
GLuint point_of_input(const std::string& block) { return input_points.of(block); }

void unbind_sampler_objects() {
  for (GLuint unit = 0; unit < units(); ++unit) glBindSampler(unit, 0);
}

void assign_bindings(GLuint program, const std::string& files) {
  char text[longest_name];
  std::map<GLint, std::string> users;  // by unit
  for (GLuint i = 0; i < GLuint(parameter(program, GL_ACTIVE_UNIFORMS)); ++i) {
    GLint count = 0;
    GLenum type = 0;
    glGetActiveUniform(program, i, longest_name, nullptr, &count, &type, text);
    if (!is_sampler(type)) continue;
    const std::string name = std::string(text).substr(0, std::string_view(text).find('['));
    std::vector<GLint> taken(size_t(count),
                             GLint(number_of(listed_samplers, input_units, files, "sampler", name)));
    std::iota(taken.begin(), taken.end(), taken[0]);
    for (const GLint unit : taken) {
      const auto [user, added] = users.try_emplace(unit, name);
      if (!added)
        throw machine_error("OpenGL: {} reads \"{}\" and \"{}\", which share a texture unit in gl/bindings.h",
                            files, user->second, name);
    }
    glProgramUniform1iv(program, glGetUniformLocation(program, name.c_str()), count, taken.data());
  }
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &most);
  if (users.size() > size_t(most))
    throw machine_error("OpenGL: {} reads {} textures; a shader may read {} on this driver", files,
                        users.size(), most);
  for (GLuint i = 0; i < GLuint(parameter(program, GL_ACTIVE_UNIFORM_BLOCKS)); ++i) {
    glGetActiveUniformBlockName(program, i, longest_name, nullptr, text);
    glUniformBlockBinding(program, i, number_of(listed_blocks, input_points, files, "uniform block", text));
  }
}

void reset_gl_state() {
  for (const GLenum test : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST})
    glDisable(test);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ZERO);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glStencilFunc(GL_ALWAYS, 0, ~0u);
  glStencilMask(~0u);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindVertexArray(0);
  unbind_sampler_objects();
}

}  // namespace lightgrid
