#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang-tidy over every source of src/ and apps/, by the compile commands of the release preset.
#   tools/tidy.sh [-j JOBS]
set -euo pipefail
cd "$(dirname "$0")/.."

jobs="$(nproc)"
while getopts j: flag; do
  case "$flag" in
    j) jobs="$OPTARG" ;;
    *) exit 2 ;;
  esac
done

git ls-files -z 'src/*.cpp' 'apps/*.cpp' |
  xargs -0 -r -n 1 -P "$jobs" clang-tidy -p build/release --quiet
