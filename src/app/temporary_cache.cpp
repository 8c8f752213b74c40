#include "app/temporary_cache.h"

#include <cstdlib>

#include "base/log.h"
#include "cl/cache_folder.h"

namespace lightgrid {

TemporaryCache::TemporaryCache() {
  const char* named = std::getenv("POCL_CACHE_DIR");
  const std::filesystem::path usual = pocl_cache_folder();
  if ((named && *named) || why_not_writable(usual).empty()) return;
  std::error_code failure;
  std::string name = (std::filesystem::temp_directory_path(failure) / "lightgrid_XXXXXX").string();
  if (failure || !mkdtemp(name.data())) return;
  folder_ = name, unwritable_ = usual;
  setenv("POCL_CACHE_DIR", name.c_str(), 1);
}

TemporaryCache::~TemporaryCache() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

void TemporaryCache::tell() const {
  if (folder_.empty()) return;
  log_info(
      "{}: cannot be written; kernels are compiled in each run (set XDG_CACHE_HOME to a writable folder)",
      unwritable_.string());
}

}  // namespace lightgrid
