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
#include "renderer/effect_state.h"

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
  void put(ClDevice& device, bool opengl, const char* what, const std::vector<Value>& given) {
    static const std::vector<Value> zero(1, Value(0));
    const std::vector<Value>& column =
        given.empty() ? zero : given;  // an argument without memory is an error
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

// The state of an effect that has one list of inputs, for the hooks of lights: filled once after each change of the
// camera, the lights or the plan.
template <typename Inputs>
class LightInputs : public EffectState {
 public:
  bool follow(PassContext&) final {
    filled_ = false;
    return true;
  }
  void before_lights(PassContext& work) final {
    if (!filled_) fill(work);
    filled_ = true;
  }
  void bind() const final { inputs_.bind(); }
  ClArguments reach_arguments() final { return inputs_.arguments(); }
  size_t memory_bytes() const final { return inputs_.bytes(); }

 protected:
  virtual void fill(PassContext& work) = 0;
  Inputs inputs_;

 private:
  bool filled_ = false;
};

}  // namespace lightgrid
