// How many lights engines take, and which they drop past that. The table, with what is not verified, is
// docs/check.md's too.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lightgrid::lab {

// The container that holds a limited number of lights. pool: all entries of all cells of a view together.
// distance: nothing further than so many metres along the view's axis is lit.
enum class LimitScope { view, mesh, cell, pool, distance };

// Which lights count. local: points and spots together. each: points and spots, each kind with its own room.
// every: directional lights too.
enum class LimitKinds { local, points, each, every };

// The lights that count: all of the scene; those whose range and cone the view sees; those of them that
// earlier limits of the engine keep.
enum class LimitOf { scene, seen, kept };

// Which lights are kept. index: the scene's first. points_first: points before spots, each in the scene's
// order. nearest: to the eye. farthest: along the view's axis. unknown: the engine does not say; results take
// the scene's first.
enum class LimitOrder { index, points_first, nearest, farthest, unknown };

// Where the cells are, and when a light is in one.
enum class LimitCells {
  none,
  three,  // 32-pixel tiles, 24 exponential slices to the far plane; a sphere against a cell's box in view
          // space
  unreal  // 64-pixel tiles, 32 slices to the furthest light; a sphere and a cone against the same box
};

// When a light reaches a mesh: its range meets the mesh's box in the world, its box does, or always.
enum class LimitReach { range, box, always };

struct EngineLimit {
  const char* engine;    // as --engine has it
  const char* versions;  // that the source speaks of
  LimitScope scope;
  LimitKinds kinds;
  LimitOf of;
  LimitOrder order;
  int most;  // lights; entries of pool, a cell; metres of distance
  LimitCells cells;
  LimitReach reach;
  const char* source;        // URL
  const char* not_verified;  // assumptions of the check; empty: none
  const char* change;        // advice
};

// An engine's limits stand together, in the order in which it applies them.
const std::vector<EngineLimit>& engine_limits();

// Engines whose limits are known, and those without one: their lists have any length.
struct UnlimitedEngine {
  const char* engine;
  const char* source;
  const char* why;
};
const std::vector<UnlimitedEngine>& unlimited_engines();
std::vector<std::string> engine_names();

// The limits of one engine, or of all. Throws Error(input) for an unknown name.
std::vector<const EngineLimit*> limits_of(std::string_view engine);

const char* name_of(LimitScope scope);
const char* name_of(LimitOrder order);
std::string id_of(const EngineLimit& limit);  // "filament/view"

}  // namespace lightgrid::lab
