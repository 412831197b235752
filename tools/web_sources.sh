#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Which sources the committed page, web/dist, was built from, so that a page that was forgotten is seen without Node.
#   tools/web_sources.sh --write   after a build of the page: notes the sources and the page
#   tools/web_sources.sh --check   fails where either has changed since
set -euo pipefail
cd "$(dirname "$0")/.."
note=web/built-from.sha256

sums() {
  git ls-files -z --cached --others --exclude-standard -- web ":!$note" ':!web/e2e' ':!web/test' |
    LC_ALL=C sort -z | xargs -0 sha256sum
}

case "${1:-}" in
  --write) sums > "$note" ;;
  --check)
    if ! sums | diff "$note" - >&2; then
      echo "web/dist is not what its sources give: run \`make web\` and commit web/dist and $note" >&2
      exit 1
    fi
    ;;
  *)
    echo "usage: tools/web_sources.sh --write | --check" >&2
    exit 2
    ;;
esac
