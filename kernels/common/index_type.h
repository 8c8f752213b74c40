// The type of a light's index in lists: -DINDEX_32: 32 bits, else 16.
#pragma once

#ifdef INDEX_32
typedef uint index_t;
#else
typedef ushort index_t;
#endif
