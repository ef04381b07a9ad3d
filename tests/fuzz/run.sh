#!/bin/sh
# run.sh SOURCE BUILD build          builds the readers with clang, libFuzzer and the sanitizers in BUILD
# run.sh SOURCE BUILD READER SECONDS feeds a reader its corpus (tests/fuzz/corpus/READER; the project's own files for cases), then
#                                    damaged and new files for so long
# Fails at the first crash, leak, undefined behaviour, broken promise, or input that takes above 5 s or 1 GB; the input is left in
# BUILD. What has been learnt stays in BUILD/corpus/READER for the next run.
set -eu
source=$1
build=$2
reader=$3
command -v clang++ >/dev/null || { echo "clang++ is not installed: nothing was compared"; exit 0; }
if [ "$reader" = build ]; then
  cmake -S "$source/tests/fuzz" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=None >&2
  cmake --build "$build" >&2
  exec "$build/seeds" "$build/corpus"
fi

mkdir -p "$build/corpus/$reader"
given=$source/tests/fuzz/corpus/$reader
if [ "$reader" = case ]; then
  given=$build/corpus/cases
  mkdir -p "$given"
  find "$source/cases" -name '*.toml' -print | while read -r file; do
    cp "$file" "$given/$(printf '%s' "$file" | tr '/' '_')"
  done
fi
cd "$build"
[ ! -d "$given" ] || set -- "$@" "$given"
[ ! -f "$source/tests/fuzz/$reader.dict" ] || set -- "$@" -dict="$source/tests/fuzz/$reader.dict"
seconds=$4
shift 4
exec ./fuzz_"$reader" -max_total_time="$seconds" -timeout=5 -rss_limit_mb=1000 -max_len=8192 -print_final_stats=1 -seed=20261122 \
  -artifact_prefix="$reader-" "corpus/$reader" "$@"
