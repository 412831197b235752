#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What .ci/run leaves out: long checks, in parts that can be run one by one and taken up again.

    tools/nightly.py                          every part that has not passed at this state of the tree
    tools/nightly.py --parts tidy,web         these, whatever they did before
    tools/nightly.py --budget 60              for at most 60 minutes; what is left is said
    tools/nightly.py --list                   the parts and how they last ended

The newest benchmarks/reports/*-nightly.md is the record: one row a part, with how it ended, when and at which
commit. A run writes it anew, under today's date, after each part; rows of parts that did not run stay.
What a part prints goes to build/nightly/PART.log. Standard library only.
"""

import argparse
import dataclasses
import datetime
import os
import pathlib
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
REPORTS = ROOT / "benchmarks" / "reports"
LOGS = ROOT / "build" / "nightly"
FUZZ_PARTS = 6

# Part -> shell command, run in the root of the tree. In the order in which they pay.
PARTS = {
    "release": "make --no-print-directory test",
    "tidy": "make --no-print-directory tidy TIDY=--all",
    "web": "make --no-print-directory web && git diff --exit-code --stat -- web/dist && make --no-print-directory web-e2e",
    "scalar": "make --no-print-directory scalar",
    "faults": "make --no-print-directory build && NADIR_FAULT_ROUNDS=20 "
              "python3 -B tests/faults/faults_test.py build/release/bin/nadir",
    "kills": "make --no-print-directory build && NADIR_FAULT_ROUNDS=100 "
             "python3 -B tests/faults/faults_test.py build/release/bin/nadir Kill",
    "packages": "make --no-print-directory build && tests/packaging/run.sh find-package build/release "
                "&& tests/packaging/run.sh add-subdirectory",
    **{f"fuzz-{part}": f"make --no-print-directory fuzz FUZZ_SECONDS=300 FUZZ_PART={part}/{FUZZ_PARTS}"
       for part in range(1, FUZZ_PARTS + 1)},
    "asan": "make --no-print-directory asan-all",
    "bench": "make --no-print-directory bench",
    "fresh-debian": "tools/fresh_debian.sh",
}


@dataclasses.dataclass
class Row:
    """How a part last ended."""
    part: str
    ended: str
    seconds: str
    commit: str
    date: str


def git(*arguments):
    return subprocess.run(["git", "-C", str(ROOT), *arguments], check=False, capture_output=True, text=True)


def head():
    return git("rev-parse", "--short=12", "HEAD").stdout.strip()


def same_tree(commit):
    """Whether nothing but reports differs between a commit and what is there now."""
    return git("diff", "--quiet", commit, "--", ".", ":!benchmarks/reports").returncode == 0


def recorded():
    """Part -> Row, from the newest report."""
    reports = sorted(REPORTS.glob("*-nightly.md"))
    rows = {}
    for line in reports[-1].read_text(encoding="utf-8").splitlines() if reports else []:
        cells = [cell.strip(" `") for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 5 and cells[0] in PARTS:
            rows[cells[0]] = Row(*cells)
    return rows


def record(rows):
    """Writes today's report; an older one of the same kind goes, since its rows are in this one."""
    today = datetime.date.today().isoformat()
    lines = ["# Nightly", "",
             "What `.ci/run` leaves out, by `make nightly` (`tools/nightly.py`): how each part last ended.", "",
             "| part | ended | seconds | commit | date |", "|---|---|---|---|---|"]
    for part in PARTS:
        row = rows.get(part, Row(part, "has not run", "-", "-", "-"))
        lines.append(f"| `{row.part}` | {row.ended} | {row.seconds} | {row.commit} | {row.date} |")
    lines += ["", "| part | command |", "|---|---|"]
    lines += [f"| {part} | `{command}` |" for part, command in PARTS.items()]
    for old in REPORTS.glob("*-nightly.md"):
        old.unlink()
    (REPORTS / f"{today}-nightly.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def run(part, limit_s):
    """Runs a part and returns its row; one that is over the limit is ended."""
    LOGS.mkdir(parents=True, exist_ok=True)
    log = LOGS / f"{part}.log"
    started = time.monotonic()
    with log.open("wb") as out:
        # A session of its own, so that its children end with it.
        child = subprocess.Popen(["bash", "-c", PARTS[part]], cwd=ROOT, stdout=out, stderr=subprocess.STDOUT,
                                 stdin=subprocess.DEVNULL, start_new_session=True)
        try:
            code = child.wait(limit_s)
            ended = "passed" if code == 0 else f"failed ({code})"
        except (subprocess.TimeoutExpired, KeyboardInterrupt) as stopped:
            os.killpg(child.pid, signal.SIGTERM)
            child.wait()
            if isinstance(stopped, KeyboardInterrupt):
                raise
            ended = "stopped by the budget"
    return Row(part, ended, f"{time.monotonic() - started:.0f}", head() + ("" if same_tree("HEAD") else "+"),
               datetime.date.today().isoformat())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--parts", help="names, separated by commas; default: those that have not passed")
    parser.add_argument("--budget", type=float, help="minutes in all")
    parser.add_argument("--list", action="store_true", help="print the parts and end")
    arguments = parser.parse_args()
    rows = recorded()
    if arguments.list:
        for part, command in PARTS.items():
            row = rows.get(part)
            said = f"{row.ended} {row.date} at {row.commit}, {row.seconds} s" if row else "has not run"
            print(f"{part:13} {said}\n{'':13} {command}")
        return 0
    parts = arguments.parts.split(",") if arguments.parts else [
        part for part in PARTS
        if not (part in rows and rows[part].ended == "passed" and same_tree(rows[part].commit))]
    unknown = [part for part in parts if part not in PARTS]
    if unknown:
        parser.error(f"unknown part {', '.join(unknown)}: see --list")

    end = time.monotonic() + 60.0 * arguments.budget if arguments.budget else None
    failed, left = [], list(parts)
    for part in parts:
        limit = None if end is None else end - time.monotonic()
        if limit is not None and limit < 30.0:
            break
        left.remove(part)
        print(f"=== {part}: {PARTS[part]}", flush=True)
        row = run(part, limit)
        rows[part] = row
        record(rows)
        print(f"--- {part}: {row.ended}, {row.seconds} s (build/nightly/{part}.log)", flush=True)
        if row.ended != "passed":
            failed.append(part)
    print(f"nightly: {len(parts) - len(left) - len(failed)} passed, {len(failed)} not passed"
          + (f" ({', '.join(failed)})" if failed else "") + (f", left: {', '.join(left)}" if left else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
