// Asks for the cache line at a global address, where the compiler is clang. A CPU reads on while it waits for
// memory, but not past a block of pixels; a GPU has other work-items to run.
#pragma once

#ifdef __has_builtin
#if __has_builtin(__builtin_prefetch)
#define FETCH(at) __builtin_prefetch((const void*)(size_t)(at))
#endif
#endif
#ifndef FETCH
#define FETCH(at) (void)(at)
#endif
