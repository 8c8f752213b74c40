#!/usr/bin/env bash
# same_bytes.sh OLD NEW [SIZE [SCENE…]]: compares the images and light grids of two builds of the program. Renders every
# technique on every scene with both, and captures the grids of forward_plus and clustered. Status 1 if bytes differ.
set -euo pipefail
old=$1 new=$2 size=${3:-320x180}
shift $(($# < 3 ? $# : 3))
scenes=("$@")
((${#scenes[@]} > 0)) || scenes=(hall spheres terrain street)
techniques=(forward forward_multipass forward_zprepass forward_plus clustered forward_plus_compute deferred deferred_tiled lidr)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0 same=0

check() {  # what, old file, new file
  if cmp -s "$2" "$3"; then
    same=$((same + 1))
  else
    status=1
    echo "differs: $1"
  fi
}

for scene in "${scenes[@]}"; do
  for technique in "${techniques[@]}"; do
    extra=()
    [[ $technique != lidr ]] || extra=(--lights 12)
    for build in old new; do
      "${!build}" render "$scene" -t "$technique" --size "$size" "${extra[@]}" -o "$folder/$build.exr" 2>"$folder/$build.log" ||
        { cat "$folder/$build.log"; echo refused >"$folder/$build.exr"; }
    done
    check "$scene $technique" "$folder/old.exr" "$folder/new.exr"
  done
  for technique in forward_plus clustered; do
    for build in old new; do
      "${!build}" capture "$scene" -t "$technique" --size "$size" -o "$folder/$build.frame" >/dev/null 2>&1
      cat "$folder/$build.frame"/*.u32 "$folder/$build.frame"/*.f32 >"$folder/$build.grid"
    done
    check "$scene $technique: depth and grid" "$folder/old.grid" "$folder/new.grid"
  done
done
echo "$same outputs of both builds have the same bytes"
exit $status
