#include "renderer/renderer.h"

namespace lightgrid {

Renderer::Renderer(const std::string& cl_substring, GlBackend backend)
    : Renderer(cl_substring, GlContext::create(backend)) {}

Renderer::Renderer(const std::string& cl_substring, std::unique_ptr<GlContext> context)
    : gl(std::move(context)),
      cl(std::make_unique<ClDevice>(cl_substring)),
      kernels(std::make_unique<ProgramCache>(*cl)),
      bridge(choose_bridge(*cl, *gl)),
      tuned(read_tuned_sizes(cl->info())) {}

Renderer::~Renderer() {
  if (gl && !programs_.empty()) gl->make_current();
}

const GlProgram& Renderer::program(const std::string& vertex, const std::string& fragment,
                                   const std::vector<std::string>& defines) {
  std::string key = vertex + " " + fragment;
  for (const std::string& name : defines) key += " " + name;
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  return programs_.try_emplace(key, vertex, fragment, defines).first->second;
}

RendererCounts Renderer::counts() const {
  const ProgramCache::Counts& built = kernels->counts();
  return {int(programs_.size()), built.built + built.from_disk, scene_bytes_};
}

}  // namespace lightgrid
