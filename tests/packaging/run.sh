#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs examples/consumer_project against nadir, as its users would.
#   run.sh find-package BUILD    against an installation of BUILD that was moved afterwards
#   run.sh add-subdirectory      against the source tree
set -euo pipefail

source_dir="$(cd "$(dirname "$0")/../.." && pwd)"
work="$(mktemp -d)"
consumer="$work/consumer"
trap 'rm -rf "$work"' EXIT

# consume CMAKE_ARGUMENT...: every program of the consumer must build, run and say something.
consume() {
  cmake -S "$source_dir/examples/consumer_project" -B "$consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_RUNTIME_OUTPUT_DIRECTORY="$work/bin" "$@"
  cmake --build "$consumer"
  "$work/bin/frames" | grep -F "11.5 m east, 32.5 m north"
  "$work/bin/localize" | grep -E "^off by 0?\.[0-9]+ m after 5 frames$"
}

case "${1:-}" in
  find-package)
    cmake --install "$2" --prefix "$work/installed" >/dev/null
    mv "$work/installed" "$work/moved"
    if grep -rnF -e "$source_dir" -e "$work/installed" "$work/moved"/lib*/cmake \
      "$work/moved"/lib*/*/cmake 2>/dev/null; then
      echo "the installed package names the tree that it was built in" >&2
      exit 1
    fi
    if [[ -x "$work/moved/bin/nadir" ]]; then
      "$work/moved/bin/nadir" version
    fi
    consume -DCMAKE_PREFIX_PATH="$work/moved"
    ;;
  add-subdirectory)
    # Where the compiler cache finds it again, and grouped as the presets are.
    consumer="$source_dir/build/consumer"
    rm -rf "$consumer"
    consume -DCONSUMER_NADIR_SOURCE="$source_dir" -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12
    ;;
  *)
    echo "usage: run.sh find-package BUILD | add-subdirectory" >&2
    exit 2
    ;;
esac
