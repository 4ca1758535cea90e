# shellcheck shell=bash
# Code that the shell scripts share. Each script has a function usage().
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)

fail() {
  echo "${0##*/}: $1" >&2
  exit 1
}

# Prints the help and exits if the first argument is --help or -h.
answer_help() {
  if [[ ${1:-} == --help || ${1:-} == -h ]]; then
    usage
    exit 0
  fi
}

# build PRESET TARGETS CMAKE_OPTIONS...: changes to the root, configures and builds. TARGETS is one word with blanks.
# JOBS=2 sets the number of compilers at once, CMAKE_OPTIONS="..." adds options such as another compiler or launcher.
jobs=${JOBS:-$(nproc)}
read -r -a more_options <<<"${CMAKE_OPTIONS:-}"
build() {
  cd -- "$root"
  cmake --preset "$1" "${@:3}" "${more_options[@]}" || fail "cmake could not configure the build (its output is above)"
  # shellcheck disable=SC2086
  cmake --build --preset "$1" --parallel "$jobs" --target $2 || fail "the build failed (the compiler's messages are above)"
}
