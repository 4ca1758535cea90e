# shellcheck shell=bash
# Clean Debian systems, made by mmdebstrap for one check and removed after it.

# in_clean SUITE [FOLDER] <STEPS: makes a Debian with the committed files in /gatelight and the Open Image Denoise that this
# machine has fetched, and runs the steps, a script of sh. They find the files of FOLDER in /shared, and those that they leave
# there are in FOLDER afterwards. `root` is that of script.sh, `oidn_lib` that of fetch_oidn.sh.
# shellcheck disable=SC2016,SC2154  # hooks have $1, the folder of the system
in_clean() (
  command -v mmdebstrap >/dev/null || fail "there is no mmdebstrap: 'apt-get install mmdebstrap'"
  ((EUID == 0)) || fail "needs root"
  work=$(mktemp -d)
  trap 'rm -r "$work"' EXIT
  shared=${2:-$work/shared}
  mkdir -p "$shared"
  cat >"$work/steps"
  git -C "$root" archive --format=tar --prefix=gatelight/ HEAD >"$work/sources"
  denoiser=()
  [[ -d $oidn_lib ]] && denoiser=("--customize-hook=mkdir -p \"\$1$oidn_lib\"" "--customize-hook=sync-in '$oidn_lib' '$oidn_lib'")
  mmdebstrap --variant=buildd --include=ca-certificates,python3 --customize-hook="tar-in '$work/sources' /" "${denoiser[@]}" \
    --customize-hook='mkdir "$1/shared"' --customize-hook="sync-in '$shared' /shared" \
    --customize-hook="copy-in '$work/steps' /" --customize-hook='chroot "$1" sh -eux /steps' \
    --customize-hook="sync-out /shared '$shared'" "$1" /dev/null || fail "a step in the clean $1 failed (its output is above)"
)
