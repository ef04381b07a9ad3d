#!/bin/sh
# quick_sweep.sh PROGRAM CASE FOLDER [LAUNCHER...]: a quick sweep prints its text once and leaves its files. One cell by the
# nonlinear method or by Baudet's springs is a mechanism: these are the two failed rows, and with them the status is 1.
set -eu
program=$1 case=$2 folder=$3
shift 3
rm -rf "$folder"
status=0
"$@" "$program" sweep --quick "$case" --out "$folder" > "$folder.text" || status=$?
[ "$status" -eq 1 ] || { echo "the status is $status, not 1"; exit 1; }
for design in nonlinear_method baudet; do
  grep -q "springs $design  *1x1x1 .*failed: .*no stiffness" "$folder.text" || { echo "no row tells of $design's mechanism"; exit 1; }
done
for line in 'failed: ' 'the sweep took' '^reference: ' '^displacement field, re-solve' 'springs hybrid: '; do
  n=$(grep -c "$line" "$folder.text" || true)
  case $line in
    springs*) wanted=2 ;; # errors of the field, and of the measures
    failed*) wanted=2 ;;
    *) wanted=1 ;;
  esac
  [ "$n" -eq "$wanted" ] || { echo "'$line' appears $n times, not $wanted"; cat "$folder.text"; exit 1; }
done
for file in sweep.txt sweep.csv sweep.json field_first.svg field_first.png field_again.svg measures_first.svg measures_again.svg; do
  [ -s "$folder/$file" ] || { echo "there is no $file"; exit 1; }
done
python3 -m json.tool "$folder/sweep.json" > /dev/null
