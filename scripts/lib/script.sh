# shellcheck shell=bash
# What the shell scripts share. Each has a function usage(), and calls answer_help "$@" first.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)

fail() {
  echo "${0##*/}: $1" >&2
  exit 1
}

# Ends with the help where the first word asks for it.
answer_help() {
  if [[ ${1:-} == --help || ${1:-} == -h ]]; then
    usage
    exit 0
  fi
}

# build PRESET TARGETS CMAKE_OPTIONS...: in the root, which is where we are from then on. Several targets are one word.
# JOBS=2 builds with so many at once, CMAKE_OPTIONS="..." names another compiler or launcher.
jobs=${JOBS:-$(nproc)}
read -r -a more_options <<<"${CMAKE_OPTIONS:-}"
build() {
  cd -- "$root"
  cmake --preset "$1" "${@:3}" "${more_options[@]}" || fail "cmake could not configure the build (its output is above)"
  # shellcheck disable=SC2086
  cmake --build --preset "$1" --parallel "$jobs" --target $2 || fail "the build failed (the compiler's messages are above)"
}
