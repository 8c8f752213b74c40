#!/usr/bin/env bash
# Stands in for `lightgrid` in tests of scripts: `frontier … -o FOLDER --shard I/N` writes a line of each of seven points
# that the shard has, and `frontier merge FOLDER -o FOLDER` joins them as FOLDER/answer. Shard 1 is killed once, within a
# line; shard 2 ends with status 1, as a sweep does that finds a lost light. All calls are in FOLDER/calls.
set -euo pipefail
folder=${*: -1}
[[ $2 == merge ]] || folder=${*: -3:1}
(
  flock 9
  printf '[%s]' "$@" >&9
  echo >&9
) 9>>"$folder/calls"
if [[ $2 == merge ]]; then
  sort "$folder"/records-*.jsonl >"$folder/answer"
  exit
fi

shard=${*: -1}
index=${shard%/*} count=${shard#*/}
file=$folder/records-$index-of-$count.jsonl
touch "$file"
sed -i '/half$/d' "$file"
for ((point = index; point < 7; point += count)); do
  grep -qx "point $point" "$file" && continue
  if ((index == 1)) && [[ ! -e $folder/killed && -s $file ]]; then
    touch "$folder/killed"
    printf 'half' >>"$file"
    kill -9 $$
  fi
  echo "point $point" >>"$file"
done
((index != 2))
