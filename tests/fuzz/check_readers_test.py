#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants readers in a small tree and looks at what check_readers.py says of them."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parent / "check_readers.py"

TREE = {
    "src/nadir/io/drives/point_cloud.hpp":
        "/// Reads by extension, as read_nothing() would.\n"
        "PointCloud read_point_cloud(const std::filesystem::path& path);\n"
        "void write_ply(const std::filesystem::path& path, const std::vector<LidarPoint>& points);\n",
    "src/nadir/io/maps/map_tiles.hpp":
        "class MapTiles {\n public:\n  explicit MapTiles(const std::filesystem::path& path);\n"
        "  ~MapTiles();\n  int width() const { return width_; }\n};\n",
    "apps/nadir/frame_range.hpp": "FrameRange parse_frame_range(const std::string& text);\n",
    "tests/fuzz/CMakeLists.txt":
        "function(nadir_add_fuzz_target name)\nendfunction()\n"
        "nadir_add_fuzz_target(cloud READS read_point_cloud)\n"
        "nadir_add_fuzz_target(tiles LIBRARIES nadir::io READS MapTiles)\n"
        "nadir_add_fuzz_target(texts\n  READS parse_frame_range)\n",
    **{f"tests/fuzz/{name}.cpp": "" for name in ("cloud", "tiles", "texts")},
    **{f"tests/fuzz/corpus/{name}/seed": "" for name in ("cloud", "tiles", "texts")},
}


class CheckReadersTest(unittest.TestCase):
    def check(self, changes):
        """The exit code and the lines printed for the tree with these files changed or (None) left out."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, content in {**TREE, **changes}.items():
                if content is not None:
                    (root / name).parent.mkdir(parents=True, exist_ok=True)
                    (root / name).write_text(content, encoding="utf-8")
            done = subprocess.run([sys.executable, CHECKER, "--root", root], check=False,
                                  capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            return done.returncode, done.stdout.splitlines()

    def assert_found(self, changes, *words):
        code, lines = self.check(changes)
        self.assertEqual((code, len(lines)), (1, 1), lines)
        for word in words:
            self.assertIn(word, lines[0])

    def assert_accepted(self, changes):
        self.assertEqual(self.check(changes), (0, []))

    def test_a_tree_whose_readers_have_targets_passes(self):
        self.assert_accepted({})

    def test_a_new_reader_of_io_needs_a_target(self):
        place = "src/nadir/io/las_file.hpp"
        for text in ("PointCloud read_las(const std::filesystem::path& path);\n",
                     "PointCloud\nread_las(\n    const std::filesystem::path& path);\n",
                     "namespace nadir { template <class T> T read_las(std::string_view text); }\n"):
            self.assert_found({place: text}, place, "read_las()", "no fuzz target")

    def test_a_function_of_io_that_takes_a_path_is_a_reader_whatever_its_name(self):
        self.assert_found({"src/nadir/io/las_file.hpp":
                           "LasFacts facts_of(const std::filesystem::path& path);\n"}, "facts_of()")
        self.assert_found({"src/nadir/io/las_file.hpp":
                           "class Las {\n  explicit Las(const std::filesystem::path& path);\n};\n"},
                          "Las()")

    def test_what_writes_is_no_reader(self):
        self.assert_accepted({"src/nadir/io/las_file.hpp":
                              "void write_las(const std::filesystem::path& path);\n"
                              "// PointCloud read_las(const std::filesystem::path& path);\n"})

    def test_readers_of_other_folders_are_told_by_their_names(self):
        for place in ("src/nadir/io/detail/las.hpp", "apps/nadir/las.hpp"):
            self.assert_found({place: "PointCloud parse_las(std::string_view bytes);\n"}, place,
                              "parse_las()")
        self.assert_accepted({"apps/nadir/las.hpp": "float load_pixel(int column, int row);\n"})

    def test_a_target_reads_what_is_declared_and_has_a_source_and_a_corpus(self):
        self.assert_found({"src/nadir/io/maps/map_tiles.hpp": "int x;\n"}, "tiles READS MapTiles")
        self.assert_found({"tests/fuzz/cloud.cpp": None}, "there is no cloud.cpp")
        self.assert_found({"tests/fuzz/corpus/cloud/seed": None}, "corpus/cloud", "no corpus")
        self.assert_found({"tests/fuzz/corpus/clouds/seed": ""}, "corpus/clouds", "no target")

    def test_a_target_that_is_commented_out_does_not_count(self):
        lists = TREE["tests/fuzz/CMakeLists.txt"].replace("nadir_add_fuzz_target(cloud",
                                                          "# nadir_add_fuzz_target(cloud")
        code, lines = self.check({"tests/fuzz/CMakeLists.txt": lists})
        self.assertEqual(code, 1)
        self.assertTrue(any("read_point_cloud()" in line for line in lines), lines)


if __name__ == "__main__":
    unittest.main()
