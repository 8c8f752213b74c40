#include "app/temporary_cache.h"

#include <cstdint>
#include <cstdlib>

#include "base/log.h"
#include "cl/cache_folder.h"

namespace lightgrid {

namespace {

constexpr uintmax_t room_bytes = 32 << 20;  // all kernels of a comparison of every technique take 8 MB

bool has_room(const std::filesystem::path& folder) {
  std::error_code unknown;
  const std::filesystem::space_info disk = std::filesystem::space(folder, unknown);
  return unknown || disk.available >= room_bytes;
}

}  // namespace

TemporaryCache::TemporaryCache() {
  const char* named = std::getenv("POCL_CACHE_DIR");
  const std::filesystem::path usual = pocl_cache_folder();
  if (named && *named) return;
  const bool writable = why_not_writable(usual).empty();
  if (writable && has_room(usual)) return;
  std::error_code failure;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(failure);
  if (failure || (writable && !has_room(temporary))) return;
  std::string name = (temporary / "lightgrid_XXXXXX").string();
  if (!mkdtemp(name.data())) return;
  folder_ = name;
  why_ = fmt::format("{}: {}", usual.string(), writable ? "its disk is full" : "cannot be written");
  setenv("POCL_CACHE_DIR", name.c_str(), 1);
}

TemporaryCache::~TemporaryCache() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

void TemporaryCache::tell() const {
  if (folder_.empty()) return;
  log_info("{}; kernels are compiled in each run (set XDG_CACHE_HOME to a writable folder with room)", why_);
}

}  // namespace lightgrid
