#!/usr/bin/env bash
# frontier.sh PARTS FOLDER [ARGUMENT of lightgrid frontier…]
#
# Measures a sweep in PARTS parts by GNU parallel, one at a time on each machine, and joins them: see README.md.
set -euo pipefail
(($# >= 2)) && [[ $1 =~ ^[1-9][0-9]*$ ]] || { sed -n '2,4s/^# \?//p' "$0" >&2; exit 2; }
parts=$1 folder=$2
shift 2
lightgrid=${LIGHTGRID:-lightgrid}

mkdir -p "$folder"
folder=$(cd -- "$folder" && pwd)
machines=()
[[ -z ${MACHINES-} ]] || machines=(--sshloginfile "$MACHINES" --workdir "$PWD")
# Status 1: measured, and a point loses lights. The join tells it too.
seq 0 $((parts - 1)) |
  parallel --jobs 1 "${machines[@]}" --retries 3 --line-buffer --tag --quote \
    bash -c '"$@" || (($? == 1))' part "$lightgrid" frontier "$@" -o "$folder" --shard "{}/$parts"
"$lightgrid" frontier merge "$folder" -o "$folder"
