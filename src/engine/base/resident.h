// Memory of this process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace lightgrid {

// Bytes that are in memory now, those that other processes share too; 0 where the system does not say.
size_t resident_bytes();

// Bytes that this process may still use: the least of what the machine has free, what the memory limits of
// its control groups (versions 1 and 2, each group up to the root) leave, and its limit of address space
// (RLIMIT_AS). Caches of files that the system can drop count as free. `promised`: bytes that this process
// has allocated and not written yet, which the system still counts as free. `root`: where /proc and
// /sys are.
uint64_t usable_memory(const std::filesystem::path& root = "/", uint64_t promised = 0);

// "4.5 GiB".
std::string memory_text(uint64_t bytes);

// Throws Error(machine) if this process may not use so many bytes more: "what: needs 9.0 GiB, but …; help".
void require_memory(uint64_t bytes, const std::string& what, const std::string& help, uint64_t promised = 0);

}  // namespace lightgrid
