# SPDX-License-Identifier: BSD-3-Clause
# Sourced by scripts that need a Debian root which has nothing; they name themselves in `me`.
# shellcheck shell=bash disable=SC2154

# cannot WHY: no such root can be made here. The scripts end with 77.
cannot() {
  echo "$me: $1" >&2
  exit 77
}

# One "deb" line for each Debian repository this machine uses.
# shellcheck disable=SC2016  # the dollars are apt's
apt_sources() {
  apt-get indextargets --format '$(ORIGIN) deb $(REPO_URI) $(RELEASE) $(COMPONENT)' \
    'Created-By: Packages' | sed -n 's/^Debian //p' | sort -u
}

apt_options() {
  local key value
  for key in Acquire::http::Proxy Acquire::https::Proxy Acquire::Check-Valid-Until \
    Acquire::Check-Date; do
    eval "$(apt-config shell value $key)"
    [ -z "${value:-}" ] || echo "--aptopt=$key \"$value\""
    value=
  done
}

# minimal_root_of RELEASE SOURCES FOLDER [PACKAGE...]: a minimal root of the release, from these
# repositories, and these packages.
minimal_root_of() {
  local suite=$1 sources=$2 folder=$3 packages options
  shift 3
  [ "$(id -u)" = 0 ] || cannot "it takes root: sudo .ci/$me"
  command -v mmdebstrap >/dev/null || cannot "apt-get install mmdebstrap"
  packages=$(IFS=,; echo "$*")
  mapfile -t options < <(apt_options)
  echo "$sources" | mmdebstrap --quiet --mode=root --variant=minbase --format=directory \
    ${packages:+--include="$packages"} --dpkgopt=force-unsafe-io "${options[@]}" "$suite" \
    "$folder" - ||
    cannot "mmdebstrap fails: can the mirrors of apt be reached, and may this root mount?"
  cp /etc/resolv.conf /etc/hosts "$folder/etc/"
}

# minimal_root FOLDER [PACKAGE...]: a minimal Debian of this release, and these packages.
minimal_root() {
  local suite
  suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  [ -n "$suite" ] || cannot "this is not Debian"
  minimal_root_of "$suite" "$(apt_sources)" "$@"
}
