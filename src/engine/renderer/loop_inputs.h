// An effect's inputs on the host (shared/inputs.h): LOOP_INPUTS(NameInputs, NAME_INPUTS) declares a struct
// with a member for each row of the list. The effect fills them.
#pragma once

#include <optional>
#include <vector>

#include "bridge/shared_buffer.h"
#include "cl/buffers.h"
#include "cl/launch.h"
#include "gl/bindings.h"
#include "gl/objects.h"

namespace lightgrid {

struct ArrayInput {
  ArrayInput(const char* name, const char*) : name(name), unit(unit_of_input(name)) {}

  void bind() const {
    if (texture) glBindTextureUnit(unit, texture.name());
  }
  ClArgument argument() { return {name, memory->cl_buffer()}; }
  size_t bytes() const { return (memory ? memory->size() : 0) + texture_bytes; }

  const char* name;
  GLuint unit;
  std::optional<SharedBuffer> memory;
  GlTexture texture;  // where OpenGL draws
  size_t texture_bytes = 0;
};

struct BlockInput {
  BlockInput(const char* name, const char* block) : name(name), point(point_of_input(block)) {}

  template <typename Block>
  void put(ClDevice& device, bool opengl, const char* what, const Block& value) {
    values.put(device, what, std::vector<Block>{value});
    if (!opengl) return;
    if (!uniform) uniform = make_buffer(sizeof value, nullptr, GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(uniform.name(), 0, sizeof value, &value);
  }
  void bind() const {
    if (uniform) glBindBufferBase(GL_UNIFORM_BUFFER, point, uniform.name());
  }
  ClArgument argument() { return {name, values.buffer()}; }
  size_t bytes() const { return values.bytes() * (uniform ? 2 : 1); }

  const char* name;
  GLuint point;
  UploadedBuffer values;
  GlBuffer uniform;  // where OpenGL draws
};

// Values of the lights, in the order of LightPlan::local and then of LightPlan::directional.
struct ColumnInput {
  ColumnInput(const char* name, const char*) : name(name), unit(unit_of_input(name)) {}

  template <typename Value>
  void put(ClDevice& device, bool opengl, const char* what, const std::vector<Value>& column) {
    values.put(device, what, column);
    if (!opengl) return;
    texels = make_buffer(column.size() * sizeof(Value), column.data());
    texture = make_buffer_texture(format_of(Value()), texels.name());
  }
  void bind() const {
    if (texture) glBindTextureUnit(unit, texture.name());
  }
  ClArgument argument() { return {name, values.buffer()}; }
  size_t bytes() const { return values.bytes() * (texture ? 2 : 1); }

  const char* name;
  GLuint unit;
  UploadedBuffer values;
  GlBuffer texels;  // where OpenGL draws
  GlTexture texture;

 private:
  static constexpr GLenum format_of(const glm::vec4&) { return GL_RGBA32F; }
  static constexpr GLenum format_of(float) { return GL_R32F; }
  static constexpr GLenum format_of(uint32_t) { return GL_R32UI; }
};

#define LOOP_INPUT_MEMBER(kind, type, name, resource) kind name{#name, #resource};
#define LOOP_INPUT_BIND(kind, type, name, resource) name.bind();
#define LOOP_INPUT_ARGUMENT(kind, type, name, resource) name.argument(),
#define LOOP_INPUT_BYTES(kind, type, name, resource) +name.bytes()
#define LOOP_INPUTS(NAME, LIST)                                         \
  struct NAME {                                                         \
    LIST(LOOP_INPUT_MEMBER)                                             \
    void bind() const {LIST(LOOP_INPUT_BIND)} ClArguments arguments() { \
      return {LIST(LOOP_INPUT_ARGUMENT)};                               \
    }                                                                   \
    size_t bytes() const { return size_t(0) LIST(LOOP_INPUT_BYTES); }   \
  }

}  // namespace lightgrid
