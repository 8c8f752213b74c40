#!/usr/bin/env bash
# Makes the sample report of docs/results/comparison.md: one `lightgrid compare` over the built-in scenes and all
# techniques. Writes comparison.csv beside that page, its table into it, and the report to out/comparison.html.
#   tools/comparison.sh [MORE ARGUMENTS OF compare]
# Needs a built tree (build/, or LIGHTGRID_BUILD) and python3. LIGHTGRID_FRAMES: frames a measurement (default 3);
# LIGHTGRID_SIZE: of the images (default 1280x720). Nothing else should run on the machine.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=${LIGHTGRID_BUILD:-$root/build}
cd -- "$root"
[[ -e $build/build.ninja ]] || { echo "comparison: $build is not a build folder; run ./lightgrid first" >&2; exit 3; }
cmake --build "$build" --target lightgrid >/dev/null
exec python3 tools/comparison.py "$build" "$@"
