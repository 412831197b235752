#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs commands in a fresh clone on a fresh Debian 12, which has nothing but git and make: what a newcomer
# has. Needs root, debootstrap and a network to Debian's packages.
#   tools/fresh_debian.sh                            .ci/run: cold, with an empty compiler cache
#   tools/fresh_debian.sh 'make demo' 'make test'    these instead, one after the other
# FRESH_DEBIAN=FOLDER takes the system that lies there, and leaves it there afterwards.
set -euo pipefail
cd "$(dirname "$0")/.."
[[ $# -gt 0 ]] || set -- ".ci/run"

if ! command -v debootstrap >/dev/null; then
  apt-get update -qq && apt-get install -qq -y --no-install-recommends debootstrap >/dev/null
fi
keep="${FRESH_DEBIAN:-}"
root="${keep:-$(mktemp -d)}"
mounted=()
finish() {
  for folder in "${mounted[@]}"; do umount -l "$folder"; done
  # Only what this script has made, and only after everything is unmounted.
  if [[ -z "$keep" ]] && ! grep -qF " $root/" /proc/mounts; then rm -rf --one-file-system "$root"; fi
}
trap finish EXIT

started=$SECONDS
[[ -e "$root/etc/debian_version" ]] ||
  debootstrap --variant=minbase --include=ca-certificates,git,make bookworm "$root" >"$root.log" 2>&1 ||
  { tail -n 20 "$root.log" >&2; exit 1; }
rm -f "$root.log"
printf -- '--- Debian %s: %d s\n' "$(cat "$root/etc/debian_version")" $((SECONDS - started))
for folder in proc dev dev/shm; do
  mount --bind "/$folder" "$root/$folder"
  mounted=("$root/$folder" "${mounted[@]}")
done
cp /etc/resolv.conf "$root/etc/resolv.conf"

rm -rf "$root/root/nadir"
git clone -q --no-hardlinks . "$root/root/nadir"
for command in "$@"; do
  started=$SECONDS
  printf '=== %s\n' "$command"
  chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 CI=true \
    bash -c "cd /root/nadir && $command" </dev/null
  printf -- '--- %s: %d s\n' "$command" $((SECONDS - started))
done
