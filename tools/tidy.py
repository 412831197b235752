#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy by the compile commands of `cmake --preset tidy`, over the library but for its figures.

src/nadir/report and apps have not been brought to pass yet: they belong in FOLDERS next.

Most of clang-tidy's time goes into the headers of Eigen and OpenCV. So the sources of a target are
looked at in groups, each as one source that includes them, which the static analyzer knows as
"unified sources" and analyzes in full. A group with anything to say, or one that does not compile
because two of its sources have the same name for something, is looked at source by source, and only
that counts.

What passed is not looked at again until what the compiler sees of it, comments included, or
.clang-tidy changes: the marks lie in <build>/tidy.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = [f"src/nadir/{module}" for module in
           ("core", "aerial_mapping", "ground_mapping", "map_matching", "localization",
            "evaluation", "simulation", "io")]
FOLDERS.append("src/nadir/localizer.cpp")
# clang-tidy walks through Eigen's headers with every check: without the code for SIMD that is a
# fifth less, and nothing of ours depends on it.
SHORTER = ["--extra-arg=-DEIGEN_DONT_VECTORIZE"]


GROUP = 8


def commands_of(build):
    """Source -> (target, compiler arguments without the compiler cache, the source and the output)."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        source = pathlib.Path(entry["file"]).resolve()
        if source.suffix != ".cpp" or not any(source.is_relative_to(ROOT / folder) for folder in FOLDERS):
            continue
        arguments = shlex.split(entry["command"])
        if pathlib.Path(arguments[0]).name == "ccache":
            arguments = arguments[1:]
        output = arguments.index("-o")
        target = arguments[output + 1].split(".dir/")[0]
        commands[source] = (target, arguments[:output])
    return commands


def groups_of(commands):
    """Lists of sources that one compiler command serves, at most GROUP in each."""
    alike = collections.defaultdict(list)
    for source, (target, arguments) in sorted(commands.items()):
        alike[target, tuple(arguments)].append(source)
    return [sources[i:i + GROUP] for sources in alike.values() for i in range(0, len(sources), GROUP)]


def said_of(source, arguments, build, common, checks=()):
    """What clang-tidy says against the source; empty where it has nothing to say."""
    seen = subprocess.run([*arguments, "-E", "-C", str(source)], cwd=build, check=True, capture_output=True)
    mark = build / "tidy" / hashlib.sha256(
        common + shlex.join([*arguments, *checks]).encode() + seen.stdout).hexdigest()
    if mark.exists():
        return ""
    done = subprocess.run(["clang-tidy", "--quiet", *checks, *SHORTER, str(source), "--", *arguments[1:]],
                          cwd=build, check=False, capture_output=True, text=True)
    if done.returncode == 0:
        mark.touch()
        return ""
    noise = re.compile(r"^\d+ warnings? (and \d+ errors? )?generated\.$|^\d+ warnings? treated as")
    said = [line for line in (done.stdout + done.stderr).splitlines() if not noise.match(line)]
    return "\n".join(said)


def tidy(sources, arguments, build, common):
    """What clang-tidy says against the sources, one text each."""
    if len(sources) > 1:
        text = "".join(f'#include "{source}"\n' for source in sources)
        together = build / "tidy" / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.cpp"
        together.write_text(text, encoding="utf-8")
        compiled = subprocess.run([*arguments, "-fsyntax-only", str(together)], cwd=build,
                                  check=False, capture_output=True)
        if compiled.returncode == 0 and not said_of(together, arguments, build, common, ["--checks=-bugprone-suspicious-include"]):
            return []
    said = [said_of(source, arguments, build, common) for source in sources]
    return [text for text in said if text]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "tidy")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    (build / "tidy").mkdir(exist_ok=True)
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
    common = (ROOT / ".clang-tidy").read_bytes() + version

    commands = commands_of(build)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        jobs = [pool.submit(tidy, sources, commands[sources[0]][1], build, common)
                for sources in groups_of(commands)]
        for job in concurrent.futures.as_completed(jobs):
            for said in job.result():
                failed += 1
                print(said, flush=True)
    print(f"clang-tidy: {len(commands)} sources, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
