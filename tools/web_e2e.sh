#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a small run and looks at it in a headless Chromium (web/e2e/viewer.mjs).
#   tools/web_e2e.sh [SHOTS]   with screenshots into the folder SHOTS
set -euo pipefail
cd "$(dirname "$0")/.."
program="$PWD/build/release/bin/nadir"
shots="${1:-}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
if [[ -n "$shots" ]]; then
  mkdir -p "$shots"
  shots="$(cd "$shots" && pwd)"
fi
"$program" demo --quick -o "$work/demo" -q >/dev/null
CHROMIUM="$(command -v chromium)" node web/e2e/viewer.mjs "$program" "$work/demo/drive" "$work/demo/run" \
  ${shots:+"$shots"}
