#!/bin/sh
# quick_sweep.sh PROGRAM CASE FOLDER [LAUNCHER...]: a quick sweep ends in 0, prints its text once, and leaves its files,
# none of them temporary.
set -eu
program=$1 case=$2 folder=$3
shift 3
rm -rf "$folder"
"$@" "$program" sweep --quick "$case" --out "$folder" > "$folder.text"
for line in 'the sweep took' '^reference: ' '^displacement field, re-solve' 'springs hybrid: '; do
  n=$(grep -c "$line" "$folder.text" || true)
  case $line in
    springs*) wanted=2 ;; # errors of the field, and of the measures
    *) wanted=1 ;;
  esac
  [ "$n" -eq "$wanted" ] || { echo "'$line' appears $n times, not $wanted"; cat "$folder.text"; exit 1; }
done
for file in sweep.txt sweep.csv sweep.json field_first.svg field_first.png field_again.svg measures_first.svg measures_again.svg; do
  [ -s "$folder/$file" ] || { echo "there is no $file"; exit 1; }
done
python3 -m json.tool "$folder/sweep.json" > /dev/null
