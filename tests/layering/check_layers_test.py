#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants includes in a small tree and looks at what tools/check_layers.py says of them."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_layers.py"

TREE = {
    "src/nadir/core/raster.hpp": "#include <vector>\n#include <Eigen/Core>\n",
    "src/nadir/map_matching/matching.hpp": '#include "nadir/core/raster.hpp"\n',
    "src/nadir/map_matching/cpu/fft.hpp": "#include <pocketfft_hdronly.h>\n",
    "src/nadir/map_matching/cpu/fft.cpp": '#include "nadir/map_matching/cpu/fft.hpp"\n'
                                          "#include <tbb/parallel_for.h>\n",
    "src/nadir/localization/filter.hpp": '#include "nadir/core/raster.hpp"\n',
    "src/nadir/io/image.cpp": '#include <gdal_priv.h>\n#include <cpl_conv.h>\n'
                              '#include <filesystem>\n#include "nadir/core/raster.hpp"\n',
    "src/nadir/report/figures.cpp": '#include <opencv2/core.hpp>\n'
                                    '#include "nadir/core/raster.hpp"\n',
    "src/nadir/simulation/drive.cpp": '#include "nadir/core/raster.hpp"\n',
    "src/nadir/localizer.hpp": '#include "nadir/localization/filter.hpp"\n'
                               '#include "nadir/map_matching/matching.hpp"\n',
    "src/nadir/nadir.hpp": '#include "nadir/localizer.hpp"\n',
    "src/nadir/io/maps/tiles.hpp": "",
    "src/nadir/runs/run_folder.hpp": '#include "nadir/localizer.hpp"\n#include "nadir/io/maps/tiles.hpp"\n',
    "src/nadir/pipelines/flight/map_flight.hpp": '#include "nadir/runs/run_folder.hpp"\n',
    "src/nadir/pages/run_page.hpp": '#include "nadir/pipelines/flight/map_flight.hpp"\n'
                                    '#include "nadir/report/figures.hpp"\n',
    "src/nadir/viewer/server.cpp": '#include <httplib.h>\n#include "nadir/pipelines/flight/map_flight.hpp"\n',
    "apps/nadir/cli/streams.hpp": "#include <CLI/CLI.hpp>\n",
    "apps/nadir/main.cpp": '#include <iostream>\n#include "cli/streams.hpp"\n'
                           '#include "nadir/nadir.hpp"\n#include "nadir/report/figures.hpp"\n',
    "src/nadir/report/figures.hpp": "",
}


class CheckLayersTest(unittest.TestCase):
    def check(self, path=None, text=""):
        """The exit code and the lines printed for the tree with one more file."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, content in {**TREE, **({path: text} if path else {})}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(content, encoding="utf-8")
            done = subprocess.run([sys.executable, CHECKER, "--root", root], check=False,
                                  capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            return done.returncode, done.stdout.splitlines()

    def assert_found(self, path, text, *words, line=1):
        code, lines = self.check(path, text)
        self.assertEqual((code, len(lines)), (1, 1), f"{path} {text!r}: {lines}")
        self.assertTrue(lines[0].startswith(f"{path}:{line}: "), lines[0])
        for word in words:
            self.assertIn(word, lines[0])

    def assert_accepted(self, path, text):
        self.assertEqual(self.check(path, text), (0, []))

    def test_a_clean_tree_passes(self):
        self.assertEqual(self.check(), (0, []))

    def test_core_knows_std_and_eigen_only(self):
        for header in ("opencv2/core.hpp", "gdal.h", "tbb/tbb.h", "fmt/core.h", "spdlog/spdlog.h",
                       "filesystem", "fstream", "iostream", "thread", "mutex", "atomic", "chrono",
                       "unistd.h"):
            self.assert_found("src/nadir/core/x.cpp", f"#include <{header}>\n", header)
        for module in ("map_matching/matching.hpp", "report/figures.hpp", "localizer.hpp"):
            self.assert_found("src/nadir/core/x.hpp", f'#include "nadir/{module}"\n', "core includes")

    def test_a_stage_includes_no_other_stage(self):
        self.assert_found("src/nadir/localization/x.cpp",
                          '#include "nadir/map_matching/matching.hpp"\n', "stage map_matching")
        self.assert_found("src/nadir/evaluation/x.cpp",
                          '#include "nadir/localization/filter.hpp"\n', "stage localization")

    def test_a_stage_includes_nothing_beside_or_above(self):
        for header in ("report/figures.hpp", "localizer.hpp", "nadir.hpp"):
            self.assert_found("src/nadir/map_matching/x.cpp", f'#include "nadir/{header}"\n')
        self.assert_found("src/nadir/map_matching/x.cpp", "#include <filesystem>\n", "files")

    def test_simulation_report_and_io_include_core_only(self):
        for module in ("simulation", "report", "io"):
            self.assert_found(f"src/nadir/{module}/x.cpp",
                              '#include "nadir/map_matching/matching.hpp"\n', "core only")
        self.assert_found("src/nadir/report/x.cpp", "#include <fstream>\n", "files")

    def test_the_upper_rooms_know_those_below_them_only(self):
        for path, header in (("runs/x.cpp", "pipelines/flight/map_flight.hpp"), ("runs/x.cpp", "report/figures.hpp"),
                             ("runs/x.cpp", "map_matching/matching.hpp"), ("pipelines/x.cpp", "pages/run_page.hpp"),
                             ("pipelines/localize/x.cpp", "report/figures.hpp"),
                             ("viewer/x.cpp", "pages/run_page.hpp"), ("viewer/x.cpp", "report/figures.hpp"),
                             ("localizer.cpp", "report/figures.hpp"), ("io/x.cpp", "runs/run_folder.hpp")):
            self.assert_found(f"src/nadir/{path}", f'#include "nadir/{header}"\n', "may include")

    def test_rooms_are_public_and_what_is_deeper_is_not(self):
        self.assert_accepted("src/nadir/runs/x.hpp", '#include "nadir/io/maps/tiles.hpp"\n')
        self.assert_found("src/nadir/runs/x.hpp", '#include "nadir/io/maps/detail/x.hpp"\n', "there is no")

    def test_prints_signals_and_exits_belong_to_apps(self):
        calls = ('fmt::print("x");', "std::cout << 1;", 'std::fputs("x", stderr);', "std::exit(1);", "_exit(1);",
                 "std::signal(SIGINT, f);", "std::raise(SIGTERM);")
        for path in ("src/nadir/core/x.cpp", "src/nadir/pipelines/x.cpp", "src/nadir/viewer/x.cpp"):
            for call in calls:
                self.assert_found(path, call + "\n", "terminal" if re.search("print|cout|fputs", call) else "apps")
        for call in calls:
            self.assert_accepted("apps/nadir/cli/x.cpp", call + "\n")
        self.assert_found("src/nadir/pipelines/x.cpp", "#include <csignal>\n", "signals")

    def test_the_command_line_and_the_server_have_a_home(self):
        self.assert_found("src/nadir/pipelines/x.cpp", "#include <CLI/CLI.hpp>\n", "CLI11")
        for path in ("src/nadir/pages/x.cpp", "apps/nadir/verbs/x.cpp"):
            self.assert_found(path, "#include <httplib.h>\n", "cpp-httplib")

    def test_gdal_lives_in_io(self):
        for path in ("src/nadir/map_matching/x.cpp", "src/nadir/report/x.cpp", "apps/nadir/x.cpp"):
            for header in ("gdal_priv.h", "ogr_spatialref.h", "cpl_string.h", "gdal/gdal.h"):
                self.assert_found(path, f"#include <{header}>\n", "GDAL")

    def test_internal_headers_stay_inside(self):
        for path in ("apps/nadir/x.cpp", "src/nadir/localizer.cpp", "src/nadir/io/x.cpp"):
            self.assert_found(path, '#include "nadir/map_matching/cpu/fft.hpp"\n', "internal")
        self.assert_found("src/nadir/map_matching/x.hpp",
                          '#include "nadir/map_matching/cpu/fft.hpp"\n', "not installed")
        self.assert_accepted("src/nadir/map_matching/x.cpp",
                             '#include "nadir/map_matching/cpu/fft.hpp"\n')

    def test_the_composition_root_includes_stages_but_only_it(self):
        self.assert_accepted("src/nadir/localizer.cpp", '#include "nadir/localizer.hpp"\n'
                             '#include "nadir/map_matching/matching.hpp"\n')
        self.assert_found("src/nadir/other.cpp", '#include "nadir/core/raster.hpp"\n', "no layer")

    def test_an_unknown_folder_is_an_error(self):
        for path in ("src/nadir/utils/x.hpp", "src/other/localizer.hpp", "src/x.hpp"):
            self.assert_found(path, "", "no layer")

    def test_an_unknown_third_party_is_an_error(self):
        for path in ("src/nadir/io/x.cpp", "apps/nadir/x.cpp"):
            self.assert_found(path, "#include <boost/asio.hpp>\n", "no known third party")

    def test_a_missing_or_relative_header_is_an_error(self):
        self.assert_found("apps/nadir/x.cpp", '#include "nadir/core/gone.hpp"\n', "there is no")
        self.assert_found("apps/nadir/x.cpp", '#include "gone.hpp"\n', "there is no")
        self.assert_found("src/nadir/io/x.cpp", '#include "image.hpp"\n', "not written from src/")

    def test_every_spelling_of_an_include_is_seen(self):
        for text in ("#include<gdal.h>\n", "  #  include  <gdal.h>\n", "#\tinclude\t<gdal.h>\n",
                     "#include <gdal.h>  // why\n", "#include /* why */ <gdal.h>\n"):
            self.assert_found("src/nadir/core/x.hpp", text, "GDAL")
        self.assert_found("src/nadir/core/x.hpp", "#include GDAL_HEADER\n", "cannot be checked")
        self.assert_found("src/nadir/io/x.cpp", "#include <nadir/localization/filter.hpp>\n")

    def test_what_is_commented_out_is_not_seen_and_lines_stay_right(self):
        self.assert_accepted("src/nadir/core/x.hpp",
                             "// #include <gdal.h>\n/*\n#include <gdal.h>\n*/\n")
        self.assert_found("src/nadir/core/x.hpp", "/*\n\n*/\n#include <gdal.h>\n", "GDAL", line=4)
        for opening in ("// src/*.hpp\n", 'auto glob = "src/*.hpp";\n'):
            self.assert_found("src/nadir/core/x.hpp", opening + "#include <gdal.h>\n/* */\n", "GDAL",
                              line=2)

    def test_json_becomes_text_in_one_place(self):
        for path in ("src/nadir/io/x.cpp", "apps/nadir/x.cpp"):
            for text in ("auto text = json.dump(2);\n", "p->dump();\n", "json\n.dump (-1);\n"):
                self.assert_found(path, text, "json_text()", line=text.count("\n"))
            self.assert_accepted(path, '// json.dump()\nauto text = "json.dump()";\ndump(x);\n')
        self.assert_accepted("src/nadir/io/json.cpp", "json.dump(2);\n")


if __name__ == "__main__":
    unittest.main()
