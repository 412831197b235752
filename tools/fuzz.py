#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the fuzz targets one by one, adds up what they did, and prints it as a table.

The programs are those of the preset `fuzz` (`make fuzz` builds them). What they learn is kept in
build/fuzz-corpus, so that the next run goes on from there; what they find lies in build/fuzz-findings.
Executions, CPU seconds, edges and findings of all runs are added up in build/fuzz/state.json.
"""

import argparse
import concurrent.futures
import datetime
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parents[1]
SEEDS = ROOT / "tests/fuzz/corpus"
DICTIONARIES = ROOT / "tests/fuzz/dictionaries"

HANG_S = 60  # of the wall clock; a target itself measures 5 s of processor time
LARGEST_INPUT = 4096  # bytes; formats of many bytes a point or pixel get more
LARGER_INPUTS = {"rosbag": 16384, "stored_features": 8192, "http_request": 8192}
MOST_MEMORY_MB = 2048  # a leak of many small pieces
LARGEST_PIECE_MB = 512  # one allocation of an input of some KB

EDGES = re.compile(r"\bcov: (\d+)")
EXECUTIONS = re.compile(r"stat::number_of_executed_units: (\d+)")
# In a library that the fuzzer cannot see into, a leak that it reports may be a cache.
SANITIZERS = {"ASAN_OPTIONS": "detect_leaks=1:allocator_may_return_null=0:handle_abort=1",
              "UBSAN_OPTIONS": "print_stacktrace=1"}


def targets_in(folder):
    """The names of the fuzzers that were built."""
    return sorted(program.name.removeprefix("fuzz_") for program in folder.glob("fuzz_*")
                  if program.is_file() and os.access(program, os.X_OK))


def command_of(options, target, seconds):
    corpus = options.corpus / target
    findings = options.findings / target
    for folder in (corpus, findings):
        folder.mkdir(parents=True, exist_ok=True)
    command = [options.bin / f"fuzz_{target}", corpus, SEEDS / target, f"-max_total_time={seconds}",
               f"-timeout={HANG_S}", f"-rss_limit_mb={MOST_MEMORY_MB}",
               f"-malloc_limit_mb={LARGEST_PIECE_MB}",
               f"-max_len={LARGER_INPUTS.get(target, LARGEST_INPUT)}",
               f"-artifact_prefix={findings}/", "-print_final_stats=1", "-reload=0", "-close_fd_mask=1"]
    dictionary = DICTIONARIES / f"{target}.dict"
    if dictionary.is_file():
        command.append(f"-dict={dictionary}")
    return [str(word) for word in command]


def fuzz(options, target, seconds):
    """One run of one target: executions, CPU seconds, edges, and the first line of a finding."""
    log = options.findings / f"{target}.log"
    command = command_of(options, target, seconds)
    with open(log, "wb") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT,
                                   env={**os.environ, **SANITIZERS}, cwd=ROOT)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    for parent in ("/dev/shm", tempfile.gettempdir()):  # libFuzzer ends without destructors
        shutil.rmtree(f"{parent}/nadir-fuzz-{process.pid}", ignore_errors=True)
    text = log.read_text(encoding="utf-8", errors="replace")
    executions = EXECUTIONS.findall(text)
    edges = [int(number) for number in EDGES.findall(text)]
    finding = None
    if process.returncode != 0:
        said = [line for line in text.splitlines()
                if "ERROR: " in line or "runtime error" in line or "what():" in line]
        finding = said[0].strip() if said else f"exit code {process.returncode}"
    return {"executions": int(executions[-1]) if executions else 0,
            "cpu_s": round(usage.ru_utime + usage.ru_stime, 1),
            "edges": max(edges, default=0), "finding": finding}


def added(state, target, run):
    """The state of a target with one more run."""
    old = state.get(target, {"executions": 0, "cpu_s": 0.0, "edges": 0, "findings": []})
    findings = list(old["findings"])
    if run["finding"] and run["finding"] not in findings:
        findings.append(run["finding"])
    return {"executions": old["executions"] + run["executions"],
            "cpu_s": round(old["cpu_s"] + run["cpu_s"], 1),
            "edges": max(old["edges"], run["edges"]), "findings": findings}


def table_of(state):
    """All that the targets have done, in Markdown."""
    lines = ["| target | executions | CPU s | edges | stopped by a finding |", "|---|--:|--:|--:|--:|"]
    for target, done in sorted(state.items()):
        lines.append(f"| {target} | {done['executions']:,} | {done['cpu_s']:.0f} | {done['edges']} | "
                     f"{len(done['findings'])} |")
    total = [sum(done[key] for done in state.values()) for key in ("executions", "cpu_s")]
    lines.append(f"| {len(state)} targets | {total[0]:,} | {total[1]:.0f} | | "
                 f"{sum(len(done['findings']) for done in state.values())} |")
    return "\n".join(lines)


def merge(options, target):
    """Keeps of the working corpus only what adds an edge."""
    corpus, smaller = options.corpus / target, options.corpus / f".{target}"
    if not corpus.is_dir():
        return
    smaller.mkdir(parents=True, exist_ok=True)
    subprocess.run([options.bin / f"fuzz_{target}", "-merge=1", smaller, corpus, SEEDS / target],
                   check=False, capture_output=True, cwd=ROOT, env={**os.environ, **SANITIZERS})
    for file in corpus.iterdir():
        file.unlink()
    corpus.rmdir()
    smaller.rename(corpus)


def parsed_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=int, default=60, help="for each target")
    parser.add_argument("--targets", help="names separated by commas; default: all that were built")
    parser.add_argument("--part", metavar="K/N", help="the K-th of N equal parts of the targets")
    parser.add_argument("--jobs", type=int, default=1, help="targets at the same time")
    parser.add_argument("--merge", action="store_true", help="first drop what adds no edge")
    parser.add_argument("--table", action="store_true", help="print what was done so far, and end")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/fuzz/bin")
    parser.add_argument("--corpus", type=pathlib.Path, default=ROOT / "build/fuzz-corpus")
    parser.add_argument("--findings", type=pathlib.Path, default=ROOT / "build/fuzz-findings")
    parser.add_argument("--state", type=pathlib.Path, default=ROOT / "build/fuzz/state.json")
    return parser.parse_args()


def chosen(options):
    names = targets_in(options.bin)
    if options.targets:
        asked = options.targets.split(",")
        unknown = sorted(set(asked) - set(names))
        if unknown:
            sys.exit(f"fuzz.py: there is no target {', '.join(unknown)}; built are: {', '.join(names)}")
        names = asked
    if options.part:
        number, parts = (int(word) for word in options.part.split("/"))
        names = names[number - 1::parts]
    if not names:
        sys.exit(f"fuzz.py: {options.bin} holds no fuzz_* programs; `make fuzz` builds them")
    return names


def main():
    options = parsed_arguments()
    state = json.loads(options.state.read_text()) if options.state.is_file() else {}
    if options.table:
        print(table_of(state))
        return 0
    lock = threading.Lock()
    found = []

    def work(target):
        if options.merge:
            merge(options, target)
        run = fuzz(options, target, options.seconds)
        with lock:
            state[target] = added(state, target, run)
            options.state.parent.mkdir(parents=True, exist_ok=True)
            options.state.write_text(json.dumps(state, indent=1, sort_keys=True) + "\n")
            print(f"{datetime.datetime.now():%H:%M:%S} {target}: {run['executions']} executions, "
                  f"{run['edges']} edges" + (f", FOUND: {run['finding']}" if run["finding"] else ""),
                  flush=True)
            if run["finding"]:
                found.append(target)

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        list(pool.map(work, chosen(options)))
    print(f"\n{table_of(state)}")
    for target in found:
        print(f"fuzz.py: {target} found something: {options.findings}/{target}.log", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
