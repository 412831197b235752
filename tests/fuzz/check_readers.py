#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every way in has a fuzz target.

Lists the readers that the headers declare, and fails for one that no nadir_add_fuzz_target() of
tests/fuzz/CMakeLists.txt names in its READS. A reader is
  - in src/nadir/io/*.hpp: a function or constructor that takes a path, unless its name says that it
    writes or it is listed in NO_READERS with the reason, and
  - there and in every other header of src/nadir and apps/nadir: a function of a path or text whose
    name begins with read_, parse_, load_, open_, decode_ or import_, or that is listed in
    READERS_ELSEWHERE.
Both lists and READS are checked the other way round too: a name that no header declares is an error.
"""

import argparse
import pathlib
import re
import sys

READER_NAME = re.compile(r"^(read|parse|load|open|decode|import)_")
WRITER_NAME = re.compile(r"^(write|remove|create|append|save)_")

# In io, functions that take a path and read no content of a file that came from elsewhere.
NO_READERS = {
    "input_error": "makes a message",
    "lower_extension": "looks at the name alone",
    "file_and_line": "makes a message",
    "is_file": "asks the file system",
    "is_folder": "asks the file system",
    "files_in": "lists names",
    "photo_files": "lists names",
    "check_input_file": "compares the first bytes with those of a Git LFS pointer",
    "read_file": "gives the bytes as they are; every target of a file goes through it",
    "for_each_line": "goes through lines; the targets of text files call it",
    "sha256_of_file": "hashes bytes, whatever they are",
    "run_colmap": "starts a program; what that wrote is read by read_photo_poses",
    "AtomicFile": "writes",
    "UnfinishedFolder": "writes",
    "short_name": "looks at the name alone",
    "shell_quoted_path": "looks at the name alone",
    "SequenceWriter": "writes",
    "StereoDriveWriter": "writes",
    "LidarDriveWriter": "writes",
    # elsewhere, by their names
    "read_flight": "a folder of photos and lists: read_photo_metadata, read_positions, ...",
}

# Ways in that neither rule finds: what is read is no file, or the name says nothing.
READERS_ELSEWHERE = {
    "features_from": "src/nadir/aerial_mapping/sfm/stored.hpp",
    "pair_from": "src/nadir/aerial_mapping/sfm/stored.hpp",
    "gps_rationals": "src/nadir/io/photos/detail/exif.hpp",
    "points_of": "src/nadir/io/bags/detail/rosbag_images.hpp",
    "pixels_of": "src/nadir/io/bags/detail/rosbag_images.hpp",
    "stereo_rig_of": "src/nadir/io/bags/detail/rosbag_images.hpp",
    "KittiCalibration": "src/nadir/io/drives/detail/kitti_calibration.hpp",
    "GeodeticReader": "src/nadir/io/maps/metric_frame.hpp",
    "utm_zone_at": "src/nadir/io/maps/metric_frame.hpp",
    "ParticleLogReader": "src/nadir/runs/particle_log.hpp",
    "GrowingMapFile": "src/nadir/pipelines/flight/growing_map_file.hpp",
    "EffectiveOptions": "src/nadir/pipelines/effective_options.hpp",
    "ViewerServer": "apps/nadir/viewer/viewer_server.hpp",
}

# Readers that others call with the whole of the input: fuzzed through the name on the right.
THROUGH = {
    "read_opensfm": "read_photo_poses",
    "read_metashape": "read_photo_poses",
    "read_nadir_poses": "read_photo_poses",
    "read_colmap_model": "read_photo_poses",
    "read_text_table": "read_control_points",
    "parse_yaml": "read_mounting",
    "read_pcd": "read_point_cloud",
    "read_ply": "read_point_cloud",
    "read_datetimes": "open_drive",
    "open_kitti_stereo": "open_drive",
    "open_kitti_lidar": "open_drive",
    "open_kitti_raw": "open_drive",
    "open_euroc": "open_drive",
    "open_stereo_folder": "open_drive",
    "open_rosbag": "open_drive",
    "read_stereo_from_files": "open_drive",
    "read_lidar_from_files": "open_drive",
    "read_geo_reference": "read_orthomosaic",
    "open_raster": "read_orthomosaic",
    "check_image_size": "decode_image",
    "read_band": "read_orthomosaic",
    "read_validity": "read_orthomosaic",
}

PATH_OR_TEXT = re.compile(r"\bpath\b|\bstring(_view)?\b|\bistream\b")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:[^\"\\\n]|\\.)*\"", re.DOTALL)
# NAME ( arguments ) up to the matching parenthesis, behind something that may be a type or nothing.
CALLABLE = re.compile(r"(?<![\w.>:])~?(\w+)\s*\(")
KEYWORDS = {"if", "for", "while", "switch", "return", "sizeof", "catch", "decltype", "operator",
            "static_assert", "alignof", "noexcept", "function", "explicit"}


def arguments_from(text, begin):
    """The text between the parenthesis at `begin` and its partner."""
    depth = 0
    for position in range(begin, len(text)):
        depth += {"(": 1, ")": -1}.get(text[position], 0)
        if depth == 0:
            return text[begin + 1:position]
    return text[begin + 1:]


def declared_in(header):
    """Pairs of name and arguments of what a header declares."""
    text = COMMENT.sub("", header.read_text(encoding="utf-8"))
    for found in CALLABLE.finditer(text):
        if found.group(0).startswith("~") or found.group(1) in KEYWORDS:
            continue
        yield found.group(1), arguments_from(text, found.end() - 1)


def readers_of(root):
    """The readers by name, with the header that declares each; and all names that are declared."""
    readers, declared = {}, set()
    for folder in ("src/nadir", "apps/nadir"):
        for header in sorted((root / folder).rglob("*.hpp")):
            place = header.relative_to(root).as_posix()
            of_io = place.startswith("src/nadir/io/") and "/detail/" not in place
            for name, arguments in declared_in(header):
                declared.add(name)
                by_path = of_io and "std::filesystem::path&" in arguments
                by_name = READER_NAME.match(name) and PATH_OR_TEXT.search(arguments)
                listed = READERS_ELSEWHERE.get(name) == place
                if (by_path and not WRITER_NAME.match(name)) or by_name or listed:
                    readers.setdefault(name, place)
    return readers, declared


def targets_in(lists):
    """The targets, each with the functions that its READS names."""
    text = re.sub(r"#[^\n]*", "", lists.read_text(encoding="utf-8"))
    targets = {}
    for call in re.finditer(r"nadir_add_fuzz_target\(([^()]*)\)", text):
        name, *words = call.group(1).split()
        if "READS" in words:  # the definition of the function itself has none
            targets[name] = words[words.index("READS") + 1:]
    return targets


def problems_of(root):
    """What is wrong, a sentence each."""
    readers, declared = readers_of(root)
    targets = targets_in(root / "tests/fuzz/CMakeLists.txt")
    named = {name for reads in targets.values() for name in reads}
    for name, place in sorted(readers.items()):
        if name in NO_READERS or name in named or THROUGH.get(name) in named:
            continue
        yield (f"{place}: {name}() reads what came from elsewhere and has no fuzz target; add one "
               "to tests/fuzz (README.md there), or say in check_readers.py why it needs none")
    for target, reads in sorted(targets.items()):
        for name in sorted(set(reads) - declared):
            yield f"tests/fuzz/CMakeLists.txt: {target} READS {name}, which no header declares"
        if not (root / "tests/fuzz" / f"{target}.cpp").is_file():
            yield f"tests/fuzz/CMakeLists.txt: there is no {target}.cpp"
        if not any((root / "tests/fuzz/corpus" / target).glob("*")):
            yield f"tests/fuzz/corpus/{target}: there is no corpus"
    for folder in sorted((root / "tests/fuzz/corpus").glob("*")):
        if folder.name not in targets:
            yield f"tests/fuzz/corpus/{folder.name}: there is no target of that name"
    if root == ROOT:
        for name in sorted({*NO_READERS, *READERS_ELSEWHERE, *THROUGH} - declared):
            yield f"tests/fuzz/check_readers.py: lists {name}, which no header declares"


ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="of the tree")
    problems = list(problems_of(parser.parse_args().root.resolve()))
    print("\n".join(problems), end="\n" if problems else "")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
