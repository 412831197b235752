#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over src/nadir and apps, by the compile commands of `cmake --preset tidy`.

tools/tidy-base.txt names the newest commit at which all of it was looked at (`make nightly PART=tidy`, or
`tools/tidy.py --all`). Only what has changed since, in commits or in the working tree, and what includes it, is
looked at; everything with --all, where that commit is not in the history, and where .clang-tidy or this
script has changed since.

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
FOLDERS = ("src/nadir", "apps")
BASE = ROOT / "tools" / "tidy-base.txt"
# A change of these is a change of every verdict.
RULES = {".clang-tidy", "tools/tidy.py"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)
# clang-tidy walks through Eigen's headers with every check: without the code for SIMD that is a
# fifth less, and nothing of ours depends on it.
SHORTER = ["--extra-arg=-DEIGEN_DONT_VECTORIZE"]


GROUP = 8


def git(*arguments):
    """The words that git prints; None where it fails."""
    done = subprocess.run(["git", "-C", str(ROOT), *arguments], check=False, capture_output=True, text=True)
    return done.stdout.split() if done.returncode == 0 else None


def changed_since(base):
    """Files changed since a commit, relative to ROOT, untracked ones too; None where it is not in the history."""
    if not base or git("merge-base", "--is-ancestor", base, "HEAD") is None:
        return None
    return {*git("diff", "--name-only", "--no-renames", base), *git("ls-files", "--others", "--exclude-standard")}


def with_includers(changed):
    """The changed files and all of FOLDERS that includes one of them, directly or not."""
    includers = collections.defaultdict(set)
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.[hc]pp")):
            for header in INCLUDE.findall(path.read_text(encoding="utf-8")):
                for root in (path.parent, ROOT / "src", ROOT / "apps" / "nadir"):
                    if (root / header).is_file():
                        includers[(root / header).resolve()].add(path)
                        break
    reached = {(ROOT / name).resolve() for name in changed}
    waiting = list(reached)
    while waiting:
        new = includers[waiting.pop()] - reached
        reached |= new
        waiting += new
    return reached


def chosen(commands, everything):
    """The commands of the sources to look at; says which and why."""
    base = next((line for line in BASE.read_text(encoding="utf-8").split("\n") if line and line[0] != "#"), "")
    changed = None if everything else changed_since(base)
    why = "--all" if everything else f"the base {base[:12]} is not in the history" if changed is None else ""
    if changed is not None and changed & RULES:
        why = f"{', '.join(sorted(changed & RULES))} changed since the base {base[:12]}"
    if why:
        print(f"clang-tidy: all {len(commands)} sources ({why})", flush=True)
        return commands
    reached = with_includers(changed)
    some = {source: command for source, command in commands.items() if source in reached}
    print(f"clang-tidy: {len(some)} of {len(commands)} sources: what changed since the base {base[:12]}, "
          "and what includes it", flush=True)
    return some


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
    parser.add_argument("--all", action="store_true", help="look at every source, whatever the base")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "tidy")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    (build / "tidy").mkdir(exist_ok=True)
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
    common = (ROOT / ".clang-tidy").read_bytes() + version

    commands = chosen(commands_of(build), arguments.all)
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
