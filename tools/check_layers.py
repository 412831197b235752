#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds every #include of src/ and apps/ that goes against docs/architecture.md, and every call that
has a home of its own.

Prints `file:line: what is wrong` for each and ends with exit code 1; nothing and 0 where there is
none. Standard library only.
"""

import argparse
import pathlib
import re
import sys

STAGES = ("aerial_mapping", "ground_mapping", "map_matching", "localization", "evaluation")
BESIDE = ("simulation", "report", "io")
ABOVE = ("runs", "pipelines", "pages", "viewer")
MODULES = ("core",) + STAGES + BESIDE + ABOVE
ROOT = "composition root"
APPS = "apps"
# The only files of src/nadir itself: the composition root, the umbrella header, and the version.
ROOT_FILES = ("localizer.hpp", "localizer.cpp", "nadir.hpp", "version.hpp")
UMBRELLA = "src/nadir/nadir.hpp"

# What a module may include besides itself. core and the stages have rules, and messages, of their own.
MAY_INCLUDE = {
    **{module: {"core"} for module in BESIDE},
    ROOT: {"core", *STAGES},
    "runs": {"core", "localization", "evaluation", ROOT, "io"},
    "pipelines": {"core", *STAGES, "simulation", "io", ROOT, "runs"},
    "pages": {"core", *STAGES, "report", "io", ROOT, "runs", "pipelines"},
    "viewer": {"core", *STAGES, "io", ROOT, "runs", "pipelines"},
}
# Folders within a module whose headers are public, as are those directly in the module's folder.
ROOMS = {
    "io": {"maps", "photos", "drives", "bags", "trajectories", "options", "provenance"},
    "pipelines": {"flight", "drive", "localize", "match", "simulate"},
}

# Third parties by the beginning of the include; a header that matches none is unknown.
THIRD_PARTIES = {
    "Eigen": r"Eigen/",
    "OpenCV": r"opencv2/",
    "GDAL": r"(gdal|ogr|cpl_|vrtdataset)\w*(/\w+)?\.h$",
    "oneTBB": r"(oneapi/)?tbb/",
    "pocketfft": r"pocketfft_hdronly\.h$",
    "Highway": r"hwy/",
    "SIMD": r"\w*intrin\.h$|arm_neon\.h$",
    "yaml-cpp": r"yaml-cpp/",
    "nlohmann-json": r"nlohmann/",
    "fmt": r"fmt/",
    "OpenSSL": r"openssl/",
    "CLI11": r"CLI/",
    "cpp-httplib": r"httplib\.h$",
    "Ceres": r"ceres/",
    "CUDA": r"(cuda|cufft)\w*\.h$|cub/|thrust/",
    "ROS bag": r"(rosbag|ros|console_bridge|sensor_msgs|nav_msgs|geometry_msgs|std_msgs|tf2_msgs)/",
    "bzip2": r"bzlib\.h$",
    "LZ4": r"lz4\w*\.h$",
    "POSIX": r"(unistd|fcntl|signal|poll|sched|spawn|termios)\.h$|sys/\w+\.h$",
}
COMPUTING = {"Eigen", "OpenCV", "oneTBB"}
ALLOWED = {
    "core": {"Eigen"},
    **{stage: COMPUTING for stage in STAGES},
    "map_matching": COMPUTING | {"pocketfft", "Highway", "SIMD", "CUDA"},
    "aerial_mapping": COMPUTING | {"Ceres"},
    "simulation": COMPUTING,
    "report": COMPUTING | {"fmt"},
    "io": COMPUTING | {"GDAL", "yaml-cpp", "nlohmann-json", "fmt", "OpenSSL", "POSIX", "ROS bag",
                       "bzip2", "LZ4"},
    ROOT: COMPUTING,
    "runs": COMPUTING | {"nlohmann-json", "fmt"},
    "pipelines": COMPUTING | {"yaml-cpp", "nlohmann-json", "fmt", "POSIX"},
    "pages": COMPUTING | {"nlohmann-json", "fmt"},
    "viewer": COMPUTING | {"nlohmann-json", "fmt", "cpp-httplib", "POSIX"},
    APPS: COMPUTING | {"yaml-cpp", "nlohmann-json", "fmt", "OpenSSL", "CLI11", "POSIX"},
}

FILES = {"filesystem", "fstream"}
TERMINAL = {"iostream", "print", "syncstream"}
THREADS = {"thread", "mutex", "shared_mutex", "condition_variable", "future", "atomic", "semaphore",
           "latch", "barrier", "stop_token", "execution"}
CLOCK = {"chrono", "ctime"}
SIGNALS = {"csignal"}
NO_SIGNALS = "signals belong to apps: work is stopped through a StopToken"
NO_FILES = "files belong to io and apps"
NO_TERMINAL = "a library does not talk to the terminal"
FORBIDDEN_STANDARD = {
    "core": [(FILES, NO_FILES), (TERMINAL, NO_TERMINAL), (THREADS, "core knows no threads"),
             (CLOCK, "core knows no clock")],
    **{module: [(FILES, NO_FILES), (TERMINAL, NO_TERMINAL)]
       for module in STAGES + ("simulation", "report", ROOT)},
    **{module: [(TERMINAL, NO_TERMINAL), (SIGNALS, NO_SIGNALS)] for module in ("io",) + ABOVE},
    APPS: [],
}

# Calls that one file makes for all: (pattern, that file, what to use instead).
HOMES = [
    (re.compile(r"(?:\.|->)\s*dump\s*\("), "src/nadir/io/json.cpp",
     "a bare dump() throws at names that are not UTF-8: use json_text() of nadir/io/json.hpp"),
]

# Calls that belong to apps: a library gives results, and does not end the process.
APPS_ONLY = [
    (re.compile(r"\bstd::(?:printf|puts|putchar|cout|cerr|clog)\b|\bfmt::print\s*\(|"
                r"\b(?:std::)?(?:fprintf|fputs|fwrite)\s*\([^;]*\bstd(?:err|out)\b"),
     NO_TERMINAL),
    (re.compile(r"\b(?:std::(?:exit|_Exit|quick_exit|abort)|_exit)\s*\("), "only apps end the process"),
    (re.compile(r"\b(?:std::(?:signal|raise)|sigaction|alarm)\s*\("), NO_SIGNALS),
]

SOURCE_SUFFIXES = {".hpp", ".cpp", ".h", ".cc", ".cu", ".cuh", ".ipp"}
# Strings are matched too, so that what looks like a comment inside one is left alone.
STRING_OR_COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*(?:include|import)[ \t]*(?:<([^>]+)>|"([^"]+)"|(\S+))',
                     re.MULTILINE)


def owner(path):
    """The layer of a file, given relative to the root of the tree; None where there is none."""
    parts = path.parts
    if parts[0] == "apps":
        return APPS
    if len(parts) < 3 or parts[1] != "nadir":
        return None
    if len(parts) == 3:
        return ROOT if parts[2] in ROOT_FILES else None
    return parts[2] if parts[2] in MODULES else None


def is_internal(header):
    """Deeper than nadir/<module>/ and no room: a module's own, neither installed nor for others."""
    parts = pathlib.PurePosixPath(header).parts
    if len(parts) <= 3:
        return False
    return len(parts) > 4 or parts[2] not in ROOMS.get(parts[1], ())


def check_own(path, layer, header, exists):
    """What is wrong with including a header of nadir itself; None where nothing is."""
    if not exists:
        return f"there is no src/{header}"
    target = owner(pathlib.PurePosixPath("src") / header)
    if target is None:
        return f"{header} lies where no layer is"
    if layer == target:
        public = path.suffix == ".hpp" and layer != APPS and not is_internal("/".join(path.parts[1:]))
        if public and is_internal(header):
            return f"a public header includes {header}, which is not installed"
        return None
    if is_internal(header):
        return f"{header} is internal to {target}"
    if layer == APPS or target == "core" or path.as_posix() == UMBRELLA:
        return None
    if layer == "core":
        return f"core includes {target}: it knows the standard library and Eigen only"
    if layer in STAGES:
        if target in STAGES:
            return f"stage {layer} includes stage {target}: they meet in core types and the localizer"
        return f"{layer} includes {target}: it may include core only"
    allowed = MAY_INCLUDE[layer]
    if target in allowed:
        return None
    return f"{layer} includes {target}: it may include {', '.join(sorted(allowed))} only"


def check_foreign(layer, header):
    """What is wrong with including a header from outside; None where nothing is."""
    for name, pattern in THIRD_PARTIES.items():
        if re.match(pattern, header):
            return None if name in ALLOWED[layer] else f"{layer} may not use {name}: {header}"
    if not re.fullmatch(r"[a-z_]+", header):
        return f"{header} belongs to no known third party (tools/check_layers.py lists them)"
    for headers, reason in FORBIDDEN_STANDARD[layer]:
        if header in headers:
            return f"{layer} may not include <{header}>: {reason}"
    return None


def without_comments(text):
    """The text with comments reduced to their line breaks, so that line numbers stay right."""
    def reduced(match):
        token = match.group()
        return token if token.startswith('"') else "\n" * token.count("\n")
    return STRING_OR_COMMENT.sub(reduced, text)


def check_file(root, path):
    layer = owner(path)
    if layer is None:
        return [(path, 1, "no layer knows this place (docs/architecture.md)")]
    text = without_comments((root / path).read_text(encoding="utf-8"))
    faults = []
    for found in INCLUDE.finditer(text):
        angled, quoted, computed = found.groups()
        if computed:
            fault = f"the include of {computed} cannot be checked: name the header"
        elif (angled or quoted).startswith("nadir/"):
            header = angled or quoted
            fault = check_own(path, layer, header, (root / "src" / header).is_file())
        elif quoted and layer == APPS:
            fault = None if (root / "apps" / "nadir" / quoted).is_file() else (
                f"there is no {quoted} in apps/nadir")
        elif quoted:
            fault = f'"{quoted}" is not written from src/: "nadir/<module>/<header>"'
        else:
            fault = check_foreign(layer, angled)
        if fault:
            faults.append((path, text.count("\n", 0, found.start()) + 1, fault))
    return faults


def check_calls(root, path):
    """Calls outside of their home; what stands in a string or a comment is no call."""
    text = STRING_OR_COMMENT.sub(lambda m: "\n" * m.group().count("\n"),
                                 (root / path).read_text(encoding="utf-8"))
    elsewhere = [(pattern, instead) for pattern, home, instead in HOMES if path.as_posix() != home]
    return [(path, text.count("\n", 0, found.start()) + 1, instead)
            for pattern, instead in elsewhere + (APPS_ONLY if owner(path) != APPS else [])
            for found in pattern.finditer(text)]


def check_tree(root):
    faults = []
    for folder in ("src", "apps"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in SOURCE_SUFFIXES:
                faults += check_file(root, file.relative_to(root))
                faults += check_calls(root, file.relative_to(root))
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--root", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent.parent)
    root = parser.parse_args().root
    if not (root / "src" / "nadir").is_dir():
        parser.error(f"{root} has no src/nadir")
    faults = check_tree(root)
    for path, line, fault in faults:
        print(f"{path}:{line}: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
