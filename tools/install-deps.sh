#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what tools/apt-packages.txt names and this machine lacks; quick where nothing is missing.
#   tools/install-deps.sh             what building and testing needs
#   tools/install-deps.sh --quality   and what .ci/run needs on top
#   tools/install-deps.sh --web       what changing the viewer's page needs
set -euo pipefail

usage() {
  echo "usage: tools/install-deps.sh [--quality | --web]" >&2
  exit 2
}

sections="build"
case "${1:-}" in
  "") ;;
  --quality) sections="build quality" ;;
  --web) sections="web" ;;
  *) usage ;;
esac
[[ $# -le 1 ]] || usage

list="$(dirname "$0")/apt-packages.txt"

packages_of() {
  awk -v wanted=" $sections " '
    { sub(/#.*/, "") }
    /^\[/ { gsub(/[][ \t]/, ""); inside = index(wanted, " " $0 " ") > 0; next }
    inside && NF { print $1 }' "$list"
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install-deps: this is not a Debian system; install the counterparts of $list by hand" >&2
  exit 1
fi

missing=()
for package in $(packages_of); do
  status="$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)"
  # Node and a browser may have come from elsewhere, and Debian's npm cannot be had beside another's Node.
  [[ "$status" == installed ]] || { [[ "$sections" == web ]] && command -v "$package" >/dev/null; } ||
    missing+=("$package")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ "$(id -u)" -ne 0 ]]; then
  if ! command -v sudo >/dev/null || { [[ ! -t 0 ]] && ! sudo -n true 2>/dev/null; }; then
    {
      echo "install-deps: ${#missing[@]} packages are missing, and installing them needs root. Run as root:"
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    } >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "install-deps: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -qq -y --no-install-recommends "${missing[@]}" >/dev/null
