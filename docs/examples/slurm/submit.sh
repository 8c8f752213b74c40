#!/usr/bin/env bash
# submit.sh PARTS FOLDER [ARGUMENT of lightgrid frontier…]
#
# Submits a sweep as a Slurm job array of PARTS tasks, and a job after them that joins what they measured: see README.md.
set -euo pipefail
(($# >= 2)) && [[ $1 =~ ^[1-9][0-9]*$ ]] || { sed -n '2,4s/^# \?//p' "$0" >&2; exit 2; }
parts=$1 folder=$2
shift 2
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)

mkdir -p "$folder"
folder=$(cd -- "$folder" && pwd)
array=$(sbatch --parsable --array="0-$((parts - 1))" --output="$folder/part-%a.log" "$here/part.sbatch" \
  "$parts" "$folder" "$@")
sbatch --parsable --dependency="afterok:$array" --kill-on-invalid-dep=yes --output="$folder/merge.log" \
  "$here/merge.sbatch" "$folder" >/dev/null
echo "job $array: $parts parts; the answer will be in $folder"
