#include "cl/cache_folder.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace lightgrid {
namespace {

// Empty if the variable is not set.
std::filesystem::path path_in(const char* variable) {
  const char* value = std::getenv(variable);
  return value ? std::filesystem::path(value) : std::filesystem::path();
}

}  // namespace

std::filesystem::path pocl_cache_folder() {
  const std::filesystem::path named = path_in("POCL_CACHE_DIR"), cache = path_in("XDG_CACHE_HOME"),
                              home = path_in("HOME");
  if (!named.empty()) return named;
  if (!cache.empty()) return cache / "pocl" / "kcache";
  if (!home.empty()) return home / ".cache" / "pocl" / "kcache";
  return "/tmp/pocl/kcache";
}

std::string why_not_writable(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) return failure.message();
  return access(folder.c_str(), W_OK | X_OK) == 0 ? "" : std::strerror(errno);
}

}  // namespace lightgrid
