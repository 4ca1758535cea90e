# shellcheck shell=bash
# Fetches the library Open Image Denoise, which Debian lacks, from a Python package that contains it. No Python code of
# the package is kept or run.
oidn_version=2.5.1
oidn_package=pyoidn==2.5.1.0
oidn_sha256=32ad13368f8de1ef63001942ad05b02a00cd732d1206d97f352d3a3f606d823e
# The library, its filter with the weights, and its device. The other devices need a GPU; oneTBB is Debian's.
oidn_files=(
  libOpenImageDenoise.so.2 libOpenImageDenoise_core.so.2.5.1 libOpenImageDenoise_device_cpu.so.2.5.1
)
oidn_cache=${XDG_CACHE_HOME:-${HOME:-}/.cache}/gatelight
oidn_folder=$oidn_cache/oidn-$oidn_version
# The libraries look for each other in $ORIGIN/../lib, so their folder has this name.
oidn_lib=$oidn_folder/lib

oidn_is_there() {
  local file
  for file in "${oidn_files[@]}"; do
    [[ -s $oidn_lib/$file ]] || return 1
  done
}

# The package is only for this system.
oidn_can_be_fetched() {
  [[ $(uname -s) == Linux && $(uname -m) == x86_64 ]]
}

# Prints the first python3 that has pip. The first of PATH may be one without.
python_with_pip() {
  local python
  while read -r python; do
    if "$python" -m pip --version >/dev/null 2>&1; then
      echo "$python"
      return
    fi
  done < <(type -aP python3)
  return 1
}

# print_no_oidn REASON: prints the one-line message. Returns 1.
print_no_oidn() {
  echo "setup: Open Image Denoise could not be fetched ($1): pictures keep their noise without it; scripts/setup tries" \
    "again" >&2
  return 1
}

# unpack_oidn PYTHON WHEEL FOLDER: unpacks only the files that are needed.
unpack_oidn() {
  "$1" - "$2" "$3" "${oidn_files[@]}" <<'PYTHON'
import shutil, sys, zipfile
wheel, folder, *names = sys.argv[1:]
with zipfile.ZipFile(wheel) as archive:
    for name in names:
        with archive.open(f"pyoidn/oidn/lib/{name}") as packed, open(f"{folder}/{name}", "wb") as file:
            shutil.copyfileobj(packed, file)
PYTHON
}

# download_oidn PYTHON FOLDER: downloads into FOLDER/wheel. pip refuses a file with another hash, and leaves nothing in its cache
# or in /tmp.
download_oidn() {
  mkdir "$2/tmp" && echo "$oidn_package --hash=sha256:$oidn_sha256" >"$2/requirements" &&
    TMPDIR=$2/tmp PIP_REQUIRE_VIRTUALENV=false "$1" -m pip download --quiet --no-input --disable-pip-version-check \
      --no-cache-dir --retries 1 --timeout 15 --no-deps --only-binary :all: --require-hashes \
      --dest "$2/wheel" --requirement "$2/requirements"
}

# Moves the new folder into place and an incomplete one away. Another setup may have been faster.
place_oidn() {
  if oidn_is_there; then return; fi
  if [[ -e $oidn_folder ]]; then mv -T "$oidn_folder" "$1/old" || return; fi
  mv -T "$1/folder" "$oidn_folder"
}

# Fetches the library if it is missing. If that fails, prints one line and returns 1. It is a subshell, so that its
# temporary files are always removed.
fetch_oidn() (
  if oidn_is_there; then return; fi
  if ! oidn_can_be_fetched; then
    echo "setup: Open Image Denoise is not fetched on this system ($(uname -sm)): install it by hand; pictures keep their" \
      "noise without it" >&2
    return 1
  fi
  python=$(python_with_pip) || print_no_oidn "no python3 here has pip: install python3-pip" || return
  [[ -n ${XDG_CACHE_HOME:-}${HOME:-} ]] || print_no_oidn "neither XDG_CACHE_HOME nor HOME is set" || return

  # The temporary folder lies beside its destination, so that a rename puts all files there at once. Its name begins
  # differently from the folders in which the program looks.
  mkdir -p "$oidn_cache" 2>/dev/null && new=$(mktemp -d "$oidn_cache/.new-oidn.XXXXXX" 2>/dev/null) ||
    print_no_oidn "cannot write to $oidn_cache" || return
  trap 'rm -rf "$new"' EXIT
  trap 'trap - INT; kill -INT "$BASHPID"' INT  # otherwise it would continue, because pip ends with its own error
  # Removes the folders of runs that were killed long ago.
  find "$oidn_cache" -maxdepth 1 -name '.new-oidn.*' -mmin +1440 -exec rm -rf {} + 2>/dev/null || true

  echo "setup: fetching Open Image Denoise $oidn_version (by Intel, Apache-2.0) into $oidn_lib: downloads 88 MB, of which" \
    "51 MB are kept"
  if ! download_oidn "$python" "$new" >"$new/log" 2>&1; then
    case $(<"$new/log") in
      *"DO NOT MATCH THE HASHES"*) print_no_oidn "the download is not the expected file" ;;
      *"No space left"*) print_no_oidn "no space in $oidn_cache" ;;
      *) print_no_oidn "pip cannot download it; is the network there?" ;;
    esac
    return
  fi
  wheel=("$new"/wheel/*)
  echo "$oidn_sha256  ${wheel[0]}" | sha256sum --check --status 2>/dev/null ||
    print_no_oidn "the download is not the expected file" || return
  mkdir -p "$new/folder/lib" && unpack_oidn "$python" "${wheel[0]}" "$new/folder/lib" 2>/dev/null ||
    print_no_oidn "cannot unpack it in $oidn_cache" || return
  place_oidn "$new" || print_no_oidn "cannot write to $oidn_cache"
)
