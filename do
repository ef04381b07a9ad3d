#!/bin/sh
# springproof's one script: installs what is missing, configures, builds, and does what was asked.
#   ./do tables [ARGS]   regenerate the thesis's tables      ./do test [long|sanitize|release]   the tests of a tier
#   ./do build           build/springproof, without tests    ./do format  clang-format over the sources
#   ./do bench           timings (never part of a test)      ./do run ... build and run springproof with these arguments
#   ./do clients         install what the adapters in clients/ drive: engines (npm, Bullet) and numpy
#   ./do packages        install what is missing         ./do package build/springproof_*.deb, to be installed with apt-get
set -eu
cd "$(dirname "$0")"

# packages.txt is the one list of dependencies. Nothing is run as root when nothing is missing.
# install_missing [first|program|tests]: that part of it and those above; program unless said.
install_missing() {
  case ${1:-program} in
    first) last='/^# program/' ;;
    program) last='/^# tests/' ;;
    tests) last='$' ;;
  esac
  wanted=$(sed -e "1,${last}!d" -e 's/#.*//' packages.txt)
  # For the accessibility test. Where node is not Debian's own, Debian's npm would clash with it.
  [ "${1:-}" != tests ] || command -v npm >/dev/null || wanted="$wanted npm"
  install "$wanted"
}

# install "PACKAGE...": those of them that are missing.
install() {
  wanted=$1
  # shellcheck disable=SC2086
  installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null | sed -n 's/ installed$//p' || true)
  missing=
  for package in $wanted; do
    printf '%s\n' "$installed" | grep -qx "$package" || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0
  echo "installing:$missing" >&2
  as_root=
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  $as_root apt-get update -qq >&2
  # shellcheck disable=SC2086
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >&2
}

# build [TARGET...]: all but tests and benchmarks unless said. What an earlier configuration has left out for want of packages is looked for again.
part=program
build() {
  install_missing $part
  [ -f build/build.ninja ] && { [ $part = first ] || grep -qx 'SPRINGPROOF_IS_WHOLE:INTERNAL=1' build/CMakeCache.txt; } ||
    cmake --preset release >&2
  [ $# -gt 0 ] || set -- all
  cmake --build build --target "$@" >&2
}

command=${1:-help}
[ $# -eq 0 ] || shift
case $command in
  tables | run)
    case " $* " in *" --out"*) ;; *) part=first ;; esac # files need VTK and gnuplot, text does not
    build springproof
    exec build/springproof "$command" "$@" ;;
  build)  build ;;
  packages) install_missing ;;
  clients)
    wanted='python3-numpy g++ pkg-config nlohmann-json3-dev libbullet-dev' # for reference and bullet
    command -v npm >/dev/null || wanted="$wanted npm"
    install "$wanted"
    npm ci --prefix clients --no-audit --no-fund >&2
    # Without -Wall: Bullet's headers have warnings.
    g++ -std=c++17 -O2 clients/bullet/client.cc -o clients/bullet/client $(pkg-config --cflags --libs bullet-float64) ;;
  package)
    build
    cpack --config build/CPackConfig.cmake -B build >&2 ;;
  test)
    tier=default
    case ${1:-} in
      default | long | sanitize | release) tier=$1; shift ;;
      [!-]*) echo "./do test $1: no such tier; there are default (when none is named), long, sanitize and release" >&2; exit 2 ;;
    esac
    install_missing tests
    build all springproof_all_tests
    # MPI's launcher refuses root unless told twice; a container has no other user.
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    exec ctest --test-dir build --label-regex "^$tier\$" --output-on-failure --parallel "$(nproc)" "$@" ;;
  format)
    git ls-files '*.cpp' '*.hpp' | xargs clang-format -i ;;
  bench)
    build springproof springproof_bench
    build/springproof_bench "$@"
    exec python3 tests/bench/finite_elements.py ;;
  *) sed -n '2,7s/^# \{0,1\}//p' "$0"; [ "$command" = help ] || exit 2 ;;
esac
