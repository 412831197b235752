#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the failed tests of a build once more where every one of them failed because LeakSanitizer
# itself broke down ("has encountered a fatal error"): now and then its tracer crashes on a thread
# that ends while it looks, after all tests of the program have passed, and says nothing about
# leaks. Any other failure stays one.
#
#   tools/rerun_leak_checks.sh TEST_PRESET
set -euo pipefail
cd "$(dirname "$0")/.."
preset="$1"
results="build/$preset/Testing/Temporary"
failed=$(wc -l < "$results/LastTestsFailed.log")
broken=$(grep -c "LeakSanitizer has encountered a fatal error" "$results/LastTest.log" || true)
if [[ $failed -eq 0 || $broken -ne $failed ]]; then
  exit 1
fi
echo "LeakSanitizer broke down in $broken of the tests: they run once more"
ctest --preset "$preset" --rerun-failed
