// GLSL programs from the embedded shader files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gl/objects.h"

namespace lightgrid {

class GlProgram {
 public:
  // Vertex and fragment shader by their embedded paths, each after "#define NAME" for every name in
  // `defines`. A compile error throws Error(machine) with the log: drivers differ in what they accept.
  GlProgram(const std::string& vertex, const std::string& fragment, const std::vector<std::string>& defines);
  // A compute shader, likewise.
  GlProgram(const std::string& compute, const std::vector<std::string>& defines);

  GLuint name() const { return object_.name(); }
  GLint uniform(const std::string& name) const;  // -1 if the program does not have it; cached

 private:
  void link(const std::string& files) const;

  GlObject<GlKind::program> object_;
  mutable std::map<std::string, GLint> uniforms_;
};

}  // namespace lightgrid
