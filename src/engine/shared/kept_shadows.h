// Numbers that kernels/shadows/kept_pairs.h and the host share.
#pragma once

#define NOT_KEPT 0xffffffffu  // in place of a light's number: its bits must be found

// The outcome for a tile's pairs.
#define TILE_HAS_NO_PAIR 0u
#define TILE_IS_FOUND 1u  // at least one pair's bits were found
#define TILE_IS_KEPT 2u   // all are those of the previous frame
