#include "base/resident.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/text.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t unlimited = std::numeric_limits<uint64_t>::max();

std::optional<uint64_t> number_in(const fs::path& file) {
  std::ifstream in(file);
  std::string word;
  return in >> word ? parse_number<uint64_t>(word) : std::nullopt;  // "max" is none
}

// The number after a word of a file with one pair a line, such as "MemAvailable: 123 kB".
std::optional<uint64_t> number_after(const fs::path& file, const std::string& name) {
  std::ifstream in(file);
  std::string word, rest;
  for (uint64_t number; in >> word; std::getline(in, rest))
    if (word == name && in >> number) return number;
  return {};
}

// Where a version of control groups keeps its numbers.
struct GroupFiles {
  const char *limit, *used, *droppable;
};
constexpr GroupFiles version_1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr GroupFiles version_2{"memory.max", "memory.current", "inactive_file"};

uint64_t left_in(const fs::path& group, const GroupFiles& files) {
  const auto limit = number_in(group / files.limit);
  if (!limit) return unlimited;
  const uint64_t used = number_in(group / files.used).value_or(0);
  const uint64_t kept =
      used - std::min(used, number_after(group / "memory.stat", files.droppable).value_or(0));
  return *limit - std::min(*limit, kept);
}

// The least of a group and those above it, up to the mount. A container may see its own group as the mount.
uint64_t left_in_groups(const fs::path& mount, const fs::path& group, const GroupFiles& files) {
  uint64_t left = left_in(mount, files);
  fs::path at = mount;
  for (const fs::path& part : group.relative_path()) left = std::min(left, left_in(at /= part, files));
  return left;
}

uint64_t left_in_groups(const fs::path& root) {
  uint64_t left = unlimited;
  std::ifstream groups(root / "proc/self/cgroup");  // number:controllers:path
  for (std::string line; std::getline(groups, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path group = line.substr(second + 1), mount = root / "sys/fs/cgroup";
    if (controllers == ",,") left = std::min(left, left_in_groups(mount, group, version_2));
    if (controllers.find(",memory,") != std::string::npos)
      left = std::min(left, left_in_groups(mount / "memory", group, version_1));
  }
  return left;
}

uint64_t left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const uint64_t used = number_in(root / "proc/self/statm").value_or(0) * uint64_t(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<uint64_t>(limit.rlim_cur, used);
}

}  // namespace

size_t resident_bytes() {
  std::ifstream pages("/proc/self/statm");  // Linux
  size_t all = 0, resident = 0;
  return pages >> all >> resident ? resident * size_t(sysconf(_SC_PAGESIZE)) : 0;
}

uint64_t usable_memory(const fs::path& root, uint64_t promised) {
  const auto free_kib = number_after(root / "proc/meminfo", "MemAvailable:");
  const uint64_t free = std::min(free_kib ? *free_kib << 10 : unlimited, left_in_groups(root));
  return std::min(free - std::min(free, promised), left_of_address_space(root));
}

std::string memory_text(uint64_t bytes) {
  constexpr double gib = double(1u << 30), mib = double(1u << 20);
  if (double(bytes) >= 0.1 * gib) return fmt::format("{:.1f} GiB", double(bytes) / gib);
  if (double(bytes) >= 0.1 * mib) return fmt::format("{:.1f} MiB", double(bytes) / mib);
  return fmt::format("{} bytes", bytes);
}

void require_memory(uint64_t bytes, const std::string& what, const std::string& help, uint64_t promised) {
  const uint64_t usable = usable_memory("/", promised);
  if (bytes <= usable) return;
  throw machine_error("{}: needs at least {} of memory, but this process may use {} more; {}", what,
                      memory_text(bytes), memory_text(usable), help);
}

}  // namespace lightgrid
