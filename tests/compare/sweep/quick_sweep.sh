#!/bin/sh
# quick_sweep.sh PROGRAM CASE FOLDER [LAUNCHER...]: a quick sweep prints its answers once, on one screen, and leaves its files. One cell
# by the nonlinear method or by Baudet's springs is a mechanism: these are two failed rows, and the status is that of the others, 0.
set -eu
program=$1 case=$2 folder=$3
shift 3
rm -rf "$folder"
status=0
"$@" "$program" sweep --quick "$case" --out "$folder" > "$folder.text" || status=$?
[ "$status" -eq 0 ] || { echo "the status is $status, not 0"; exit 1; }
for design in nonlinear_method baudet; do
  grep -q "springs $design 1x1x1 .*failed: " "$folder.text" || { echo "no line tells of $design's mechanism"; exit 1; }
  grep -q "springs $design  *1x1x1 .*failed: .*no stiffness" "$folder/sweep.txt" || { echo "no row tells of $design's mechanism"; exit 1; }
done
# has FILE COUNT TEXT: the text is in so many lines of the file.
has() {
  n=$(grep -c "$3" "$1" || true)
  [ "$n" -eq "$2" ] || { echo "'$3' appears $n times in $1, not $2"; cat "$1"; exit 1; }
}
for line in 'the sweep took' '^reference: ' '^displacement field, re-solve'; do
  has "$folder.text" 1 "$line"
  has "$folder/sweep.txt" 1 "$line"
done
has "$folder.text" 2 'failed: '
has "$folder.text" 2 'no stiffness'
has "$folder/sweep.txt" 2 'failed: '
has "$folder/sweep.txt" 2 'springs hybrid: ' # errors of the field, and of the measures
n=$(wc -l < "$folder.text")
[ "$n" -le 45 ] || { echo "the text has $n lines"; exit 1; }
for file in sweep.txt sweep.csv sweep.json field_first.svg field_first.png field_again.svg measures_first.svg measures_again.svg; do
  [ -s "$folder/$file" ] || { echo "there is no $file"; exit 1; }
done
python3 -m json.tool "$folder/sweep.json" > /dev/null
