# shellcheck shell=bash
# Clean Debian systems, made by mmdebstrap for one check and removed after it.

# in_clean SUITE MMDEBSTRAP_OPTIONS...: makes a Debian with the committed files in /gatelight and the Open Image Denoise that
# this machine has fetched, and runs the hooks of the options. `root` is that of script.sh, `oidn_lib` that of fetch_oidn.sh.
# shellcheck disable=SC2154
in_clean() (
  command -v mmdebstrap >/dev/null || fail "there is no mmdebstrap: 'apt-get install mmdebstrap'"
  ((EUID == 0)) || fail "needs root"
  sources=$(mktemp)
  trap 'rm "$sources"' EXIT
  git -C "$root" archive --format=tar --prefix=gatelight/ HEAD >"$sources"
  denoiser=()
  [[ -d $oidn_lib ]] && denoiser=("--customize-hook=mkdir -p \"\$1$oidn_lib\"" "--customize-hook=sync-in '$oidn_lib' '$oidn_lib'")
  mmdebstrap --variant=buildd --include=ca-certificates,python3 --customize-hook="tar-in '$sources' /" \
    "${denoiser[@]}" "${@:2}" "$1" /dev/null || fail "a step in the clean $1 failed (its output is above)"
)
