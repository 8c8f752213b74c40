#!/usr/bin/env bash
# Makes the measurements of docs/results/first_light.md: writes the CSV beside it, puts the table into it and prints it.
#   tools/first_light.sh
# Needs a built tree (build/, or LIGHTGRID_BUILD) and python3. Optional input, omitted if absent:
#   LIGHTGRID_SPONZA         a glTF file of Sponza     (default ../shared/scenes/large/Sponza/…)
#   LIGHTGRID_SPONZA_LIGHTS  1024 lights and a camera  (default ../shared/bench/sponza_lights.json)
# LIGHTGRID_FRAMES: frames a measurement (default 5). Nothing else should run on the machine.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=${LIGHTGRID_BUILD:-$root/build}
cd -- "$root"
[[ -e $build/build.ninja ]] || { echo "first_light: $build is not a build folder; run ./lightgrid first" >&2; exit 3; }
grep -qx LIGHTGRID_TESTS:BOOL=ON "$build/CMakeCache.txt" || cmake -DLIGHTGRID_TESTS=ON "$build" >/dev/null
cmake --build "$build" --target lightgrid depth_read >/dev/null
exec python3 tools/first_light.py "$build"
