// A hash of 32 bits: lowbias32 of C. Wellons, "Prospecting for hash functions" (2018).
#pragma once

static inline uint mixed(uint h) {
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return h ^ h >> 16;
}
