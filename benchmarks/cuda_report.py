#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks and measures the CUDA backend on a GPU; writes a dated report.

    benchmarks/cuda_report.py [--build build/release] [-o FILE] [--emulate]

Runs the tests of the backend and nadir_bench_cuda, both from BUILD/bin, and needs nothing else:
standard library only. Exit code 1 where no GPU can be used, a test fails, or a figure that was asked
for is missed; the last two still write the report. --emulate tries the script without a GPU: its
report says that it says nothing.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import re
import subprocess
import sys

TABLE_I_MS = 5.0     # the task of the paper's Table I: wncc_paper at every position
FLOOR_RATIO = 5.0    # the search of the whole map over the floor that memory sets
FILTER = "*uda*"


def run(command):
    """(exit code, standard output); (None, reason) where there is no such program."""
    print("$", " ".join(command), file=sys.stderr, flush=True)
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    except OSError as problem:
        return None, str(problem)
    return done.returncode, done.stdout


def gpus():
    """["NVIDIA H100, driver 580.1"]; empty where the driver names none."""
    code, text = run(["nvidia-smi", "--query-gpu=name,driver_version", "--format=csv,noheader"])
    lines = text.strip().splitlines() if code == 0 else []
    return [", driver ".join(part.strip() for part in line.split(",")) for line in lines]


def parity(build):
    """What the tests of the backend counted: {"ran", "passed", "skipped", "failed": [name]}."""
    code, text = run([f"{build}/bin/map_matching_test", f"--gtest_filter={FILTER}"])
    if code is None:
        return {"error": text}

    def count(pattern):
        found = re.search(pattern, text)
        return int(found.group(1)) if found else 0

    failed = sorted(set(re.findall(r"^\[  FAILED  \] (\S+\.[\w/]+)", text, re.MULTILINE)))
    if code != 0 and not failed:
        failed = [f"ended with code {code}"]
    return {"ran": count(r"(\d+) tests? from \d+ test suites? ran"), "failed": failed,
            "passed": count(r"\[  PASSED  \] (\d+) test"), "skipped": count(r"\[  SKIPPED \] (\d+) test")}


def is_met(task, timing):
    """Whether the figure that is asked for is met: (text, bool), or None where none is asked for."""
    if task.startswith("whole map") and timing["floor_s"]:
        ratio = timing["median_s"] / timing["floor_s"]
        return f"within {FLOOR_RATIO:g} of the floor", ratio <= FLOOR_RATIO
    if task.startswith("Table I") and task.endswith("wncc_paper"):
        return f"under {TABLE_I_MS:g} ms", 1e3 * timing["median_s"] < TABLE_I_MS
    return None


def times_table(tasks, judged):
    rows = ["| task | median, ms | floor, ms | times the floor | asked for |", "|---|---|---|---|---|"]
    for timing in tasks:
        median, floor = timing["median_s"], timing["floor_s"]
        cells = [timing["task"], f"{1e3 * median:.3f}", f"{1e3 * floor:.3f}" if floor else "",
                 f"{median / floor:.2f}" if floor else ""]
        figure = is_met(timing["task"], timing) if judged else None
        cells.append(f"{figure[0]}: {'met' if figure[1] else '**missed**'}" if figure else "")
        rows.append("| " + " | ".join(cells) + " |")
    return rows


def parity_lines(tests):
    if "error" in tests:
        return [f"The tests could not be run: {tests['error']}."]
    lines = [f"{tests['ran']} tests (`{FILTER}`): {tests['passed']} passed, {tests['skipped']} skipped, "
             f"{len(tests['failed'])} failed. They hold every score, on the GPU and by the same kernels on "
             "the CPU, against the reference."]
    return lines + [f"- failed: `{name}`" for name in tests["failed"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", default="build/release", help="folder that has bin/ with the programs")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--emulate", action="store_true", help="without a GPU: a test of this script")
    arguments = parser.parse_args()
    today = datetime.date.today().isoformat()
    output = arguments.output or pathlib.Path(__file__).parent / "reports" / f"{today}-cuda.md"

    found = gpus()
    bench = [f"{arguments.build}/bin/nadir_bench_cuda", "--json", *["--emulate"] * arguments.emulate]
    code, text = run(bench)
    if code != 0:
        reason = f": {text}" if code is None else f" (code {code}); the GPUs here: {', '.join(found) or 'none'}"
        print(f"cuda_report: nothing measured{reason}; no report written", file=sys.stderr)
        return 1
    measured = json.loads(text)
    tests = parity(arguments.build)

    report = [f"# The CUDA backend, {today}", ""]
    if arguments.emulate:
        report += ["**Emulated on the CPU, on a tiny place: these times say nothing about a GPU.**", ""]
    copy = measured["copy_bytes_per_s"]
    about = ("Medians of 21 runs, from the call to the results in the host's memory, on a synthetic place of "
             "416 x 1158 pixels with a template of 180 x 180; some results of each task are compared with "
             "the reference first. The floor: docs/cuda.md.")
    report += [f"- GPU: {'; '.join(found) or 'none'}",
               f"- the backend says: {measured['device']}; CUDA {measured['cuda'] or 'not in this build'}",
               *([f"- a copy on the device moves {1e-9 * copy:.0f} GB/s, read and written"] if copy else []),
               f"- host: {platform.machine()}, {len(os.sched_getaffinity(0))} cores, {platform.system()}",
               "", "Written by", "", "    benchmarks/cuda_report.py", "", "which runs", "",
               f"    map_matching_test --gtest_filter='{FILTER}'", "    nadir_bench_cuda --json", "",
               "## Against the reference", "", *parity_lines(tests), "", "## Times", "",
               *([about, ""] if not arguments.emulate else []),
               *times_table(measured["tasks"], judged=not arguments.emulate), ""]
    output.write_text("\n".join(report))
    print(output)

    figures = [(timing["task"], is_met(timing["task"], timing)) for timing in measured["tasks"]]
    missed = [f"{task} {figure[0]}" for task, figure in figures
              if figure and not figure[1] and not arguments.emulate]
    wrong = "error" in tests or bool(tests["failed"])
    if missed or wrong:
        print(f"cuda_report: missed: {', '.join(missed) or 'none'}; tests {'failed' if wrong else 'passed'}",
              file=sys.stderr)
    return 1 if missed or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
