#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Nothing lost, nothing half written, always stoppable: the program under signals, SIGKILL, a full or
read-only disk, inputs that fail while they are read, and too little memory.

    faults_test.py PROGRAM [GROUP ...]

Moments and limits are drawn by seeds. A few rounds for the gate; NADIR_FAULT_ROUNDS=100 for a night.
"""

import ctypes
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from site_of_faults import Site, contents, faults_of, leftovers, limit, rounds, seeded  # noqa: E402

LONGEST_STOP_S = 3.0
LONG_VERBS = ("map", "ground", "localize", "match", "run", "simulate", "convert", "demo")
KILLED_VERBS = ("map", "ground", "localize", "run", "convert")
WRITING_VERBS = ("map", "ground", "localize", "match", "run", "simulate", "convert")
DEMO_S = 4.0  # of the demo, in which it is stopped

site = None


class Faults(unittest.TestCase):
    def each(self, names):
        """Decorates a check of one verb: it runs at once with each of these, whatever fails."""
        def run(check):
            for name in names:
                with self.subTest(verb=name):
                    check(site.verbs[name])
        return run

    def expect_one_error(self, ended, codes, *parts):
        self.assertIn(ended.code, codes, ended)
        self.assertEqual(len(ended.error_lines()), 1, ended)
        for part in parts:
            self.assertIn(part, ended.error_lines()[0], ended)


class Stop(Faults):
    """SIGINT and SIGTERM."""

    def stop(self, arguments, after_s, number):
        """Starts, waits, sends; the end, and the seconds that it took from the signal."""
        process = site.start(arguments)
        started = time.monotonic()
        try:
            process.wait(after_s)
        except subprocess.TimeoutExpired:
            pass
        sent = time.monotonic()
        ran = process.poll() is None
        if ran:
            process.send_signal(number)
        ended = site.finish(process, started)
        return ended, ran, time.monotonic() - sent

    def test_every_long_verb_ends_within_three_seconds(self):
        longest = [(0.0, "none")]
        stopped = []

        @self.each(LONG_VERBS)
        def check(verb):
            duration, _, whole = (DEMO_S, 0, {}) if verb.name == "demo" else site.reference(verb.name)
            draw = seeded("stop", verb.name)
            for number in range(rounds(3, 20)):
                folder = site.fresh("stopped")
                sent = (signal.SIGINT, signal.SIGTERM)[number % 2]
                moment = draw.uniform(0.02, 0.95 * duration)
                ended, ran, seconds = self.stop(verb.arguments(folder), moment, sent)
                told = f"{verb.name}, {sent.name} after {moment:.2f} s: {seconds:.2f} s\n{ended}"
                stopped.append(ended.code == 128 + sent)
                if ended.code == 0 and verb.name != "demo":  # it was done, or nearly
                    self.assertEqual(sorted(contents(folder)), sorted(whole), told)
                    self.assertEqual(faults_of(contents(folder), whole), [], told)
                elif ended.code != -sent or moment > 0.3:  # before main() the signal itself ends it
                    self.assertEqual(ended.code, 128 + sent, told)
                self.assertLess(seconds, LONGEST_STOP_S, told)
                self.assertEqual(ended.error_lines(), [], told)
                if "cannot be interrupted" not in ended.errors:
                    self.assertEqual(leftovers(folder), [], told)
                longest.append((seconds, told.splitlines()[0]))
        self.assertGreater(sum(stopped), len(stopped) // 2)
        print(f"longest from signal to end: {max(longest)[1]}", flush=True)

    def test_a_map_goes_on_where_it_was_stopped(self):
        verb = site.verbs["map"]
        duration, _, whole = site.reference("map")
        draw = seeded("resume")
        for _ in range(rounds(1, 20)):
            folder = site.fresh("resumed")
            ended, ran, _ = self.stop(verb.arguments(folder), draw.uniform(0.3, 0.7) * duration,
                                      signal.SIGTERM)
            work = folder / ".map.work"
            kept = ran and work.is_dir() and any(work.iterdir())
            if kept and ended.code != 0:
                self.assertIn("goes on from", ended.errors + "goes on from" * (
                    "cannot be interrupted" in ended.errors), ended)
            again = site.run(verb.arguments(folder) + ["--overwrite"])
            self.assertEqual(again.code, 0, again)
            if kept and ended.code != 0:
                self.assertIn("took up", again.errors, again)
            self.assertEqual(faults_of(contents(folder), whole), [])
            self.assertFalse(work.exists())

    def test_what_waits_ends_with_success(self):
        incoming = site.fresh("waiting") / "incoming"
        incoming.mkdir()
        folder = incoming.parent
        follow = ["map", str(incoming), "-o", str(folder / "live.tif"), "--follow"]
        ended, _, seconds = self.stop(follow, 1.0, signal.SIGTERM)
        self.assertEqual(ended.code, 0, ended)
        self.assertLess(seconds, LONGEST_STOP_S)
        for photo in sorted((site.folder / "photos").iterdir())[:2]:
            shutil.copy(photo, incoming)
        for moment in [seeded("follow").uniform(1.0, 4.0) for _ in range(rounds(1, 20))]:
            ended, _, seconds = self.stop(follow + ["--overwrite"], moment, signal.SIGINT)
            self.assertEqual(ended.code, 0, ended)
            self.assertLess(seconds, LONGEST_STOP_S)
            self.assertEqual(leftovers(folder), [])
            if (folder / "live.tif").exists():
                told = site.run(["info", str(folder / "live.tif"), "--json"])
                self.assertEqual(told.code, 0, told)

    def test_the_viewer_ends_with_success(self):
        folder = site.fresh("viewed")
        verb = site.verbs["localize"]
        serve = verb.arguments(folder) + ["--serve", "--port", "0"]
        ended, _, seconds = self.stop(serve, 3.0 + 2.0 * site.reference("localize")[0], signal.SIGINT)
        self.assertEqual(ended.code, 0, ended)
        self.assertLess(seconds, LONGEST_STOP_S)
        ended, _, seconds = self.stop(["view", str(folder / "run"), "--port", "0"], 1.5, signal.SIGTERM)
        self.assertEqual(ended.code, 0, ended)
        self.assertLess(seconds, LONGEST_STOP_S)


class Kill(Faults):
    """SIGKILL."""

    def test_nothing_half_written_and_the_next_run_works(self):
        @self.each(KILLED_VERBS)
        def check(verb):
            duration, _, whole = site.reference(verb.name)
            draw = seeded("kill", verb.name)
            for _ in range(rounds(3, 100)):
                folder = site.fresh("killed")
                process = site.start(verb.arguments(folder))
                moment = draw.uniform(0.02, 1.05 * duration)
                try:
                    process.wait(moment)
                except subprocess.TimeoutExpired:
                    process.kill()
                site.finish(process, 0.0)
                told = f"{verb.name}, killed after {moment:.2f} s"
                self.assertEqual(faults_of(contents(folder), whole), [], told)
                work = folder / ".map.work"
                kept = work.is_dir() and any(p for p in work.iterdir() if p.is_file())
                overwrite = ["--overwrite"] if (folder / verb.output).exists() else []
                again = site.run(verb.arguments(folder) + overwrite)
                self.assertEqual(again.code, 0, f"{told}\n{again}")
                if kept:
                    self.assertIn("took up", again.errors, told)
                found = contents(folder)
                self.assertEqual(faults_of(found, whole), [], told)
                self.assertEqual(sorted(found), sorted(whole), told)
                self.assertEqual(leftovers(folder), [], told)


class Disk(Faults):
    """A disk that is full, or may not be written."""

    def expect_refused(self, ended, folder):
        self.expect_one_error(ended, (1,), "cannot be written", "free space")
        visible = [path for path in contents(folder) if ".work" not in path]
        self.assertEqual(visible, [], ended)
        self.assertEqual(leftovers(folder), [], ended)

    def test_files_that_may_not_grow(self):
        @self.each(WRITING_VERBS)
        def check(verb):
            whole = site.reference(verb.name)[2]
            largest = max(len(data) for data in whole.values())
            draw = seeded("full", verb.name)
            for number in range(rounds(2, 20)):
                folder = site.fresh("full")
                most = 512 if number == 0 else int(draw.uniform(0.1, 0.9) * largest)
                ended = site.run(verb.arguments(folder), limit(resource.RLIMIT_FSIZE, most))
                self.expect_refused(ended, folder)

    def test_a_small_disk(self):
        disk = site.fresh("disk")
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk)],
                          capture_output=True, check=False).returncode != 0:
            self.skipTest("tmpfs cannot be mounted here")
        try:
            @self.each(WRITING_VERBS)
            def check(verb):
                if sum(map(len, site.reference(verb.name)[2].values())) < 256 * 1024:
                    return
                ended = site.run(verb.arguments(disk))
                if verb.name == "map":  # looks at the space before it begins
                    self.expect_one_error(ended, (2,), "are free", "free some space")
                else:
                    self.expect_refused(ended, disk)
                self.assertEqual(contents(disk), {}, ended)
        finally:
            subprocess.run(["umount", str(disk)], check=True)

    def test_a_folder_that_may_not_be_written(self):
        folder = site.fresh("locked")
        prepare, undo = read_only(folder)
        if prepare is None:
            self.skipTest("no way to make a folder read-only for this user")
        try:
            @self.each(WRITING_VERBS)
            def check(verb):
                ended = site.run(verb.arguments(folder), prepare)
                self.expect_one_error(ended, (1,), "cannot be written", "check the folder")
                self.assertEqual(contents(folder), {})
        finally:
            undo()


def read_only(folder):
    """Makes a folder read-only: (what the child must do before it starts, how it is undone)."""
    nothing = lambda: None  # noqa: E731
    if os.geteuid() != 0:
        folder.chmod(0o555)
        return nothing, lambda: folder.chmod(0o755)
    quiet = {"capture_output": True, "check": False}
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "tmpfs", str(folder)],
                      **quiet).returncode == 0:
        return nothing, lambda: subprocess.run(["umount", str(folder)], check=True)
    if subprocess.run(["chattr", "+i", str(folder)], **quiet).returncode == 0:
        return nothing, lambda: subprocess.run(["chattr", "-i", str(folder)], check=True)
    # Without the capabilities that let root write everywhere: the permission bits bind.
    folder.chmod(0o555)

    def drop():
        pr_capbset_drop, cap_dac_override, cap_dac_read_search = 24, 1, 2
        libc = ctypes.CDLL(None, use_errno=True)
        for capability in (cap_dac_override, cap_dac_read_search):
            libc.prctl(pr_capbset_drop, capability, 0, 0, 0)
    return drop, lambda: folder.chmod(0o755)


class Input(Faults):
    """Inputs that fail while they are read."""

    def copy_of_site(self, part):
        copy = site.scratch / "damaged"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(site.folder / part, copy)
        return copy

    def verb_on(self, name, place):
        verb = site.verbs[name]
        words = list(verb.words)
        words[1] = str(place)
        return words + ["-o", str(site.fresh("from_damaged") / verb.output)]

    def images(self, name):
        part, pattern = {"map": ("photos", "*.jpg"), "ground": ("stereo", "image_*/*.png"),
                         "run": ("stereo", "image_*/*.png"),
                         "localize": ("truth", "local*/*.png")}[name]
        copy = self.copy_of_site(part)
        files = sorted(copy.glob(pattern)) or sorted(copy.rglob("*.png")) or sorted(
            copy.rglob("*.tif"))
        return copy, files

    def test_a_file_in_the_middle_that_cannot_be_read(self):
        @self.each(("ground", "localize", "run"))
        def check(verb):
            copy, files = self.images(verb.name)
            middle = files[len(files) // 2]
            middle.unlink()
            middle.symlink_to("/proc/self/mem")  # a regular file; reading it fails
            ended = site.run(self.verb_on(verb.name, copy))
            self.expect_one_error(ended, (3,), middle.name)

    def test_a_photo_that_cannot_be_read_is_left_out(self):
        copy, files = self.images("map")
        files[2].unlink()
        files[2].symlink_to("/proc/self/mem")
        ended = site.run(self.verb_on("map", copy))
        self.assertEqual(ended.code, 0, ended)
        self.assertIn(files[2].name, ended.errors, ended)

    def test_a_photo_that_fails_late_does_not_cost_the_others(self):
        copy, files = self.images("map")
        arguments = self.verb_on("map", copy) + ["--threads", "1"]
        work = pathlib.Path(arguments[arguments.index("-o") + 1]).parent / ".map.work"
        started = time.monotonic()
        process = site.start(arguments)
        while process.poll() is None and not (work.is_dir() and any(
                path.is_file() for path in work.iterdir())):
            time.sleep(0.002)
        whole = files[-1].read_bytes()
        files[-1].write_bytes(whole[:1000])
        ended = site.finish(process, started)
        self.expect_one_error(ended, (3,), files[-1].name)
        self.assertIn("goes on from", ended.errors, ended)
        self.assertTrue(any(work.iterdir()))
        files[-1].write_bytes(whole)
        again = site.run(arguments)
        self.assertEqual(again.code, 0, again)
        self.assertIn("took up", again.errors, again)
        self.assertFalse(work.exists())

    def test_files_that_shrink_while_they_are_read(self):
        @self.each(("map", "ground", "localize", "run"))
        def check(verb):
            draw = seeded("shrink", verb.name)
            duration = site.reference(verb.name)[0]
            for _ in range(rounds(1, 20)):
                copy, files = self.images(verb.name)
                started = time.monotonic()
                process = site.start(self.verb_on(verb.name, copy))
                time.sleep(draw.uniform(0.0, 0.6) * duration)
                for path in files[len(files) // 2:]:
                    os.truncate(path, path.stat().st_size // 3)
                ended = site.finish(process, started)
                self.assertIn(ended.code, (0, 3), ended)
                self.assertEqual(len(ended.error_lines()), 0 if ended.code == 0 else 1, ended)


class Memory(Faults):
    """Memory that is refused."""

    def test_every_verb_says_so(self):
        failed = []
        @self.each(WRITING_VERBS)
        def check(verb):
            peak = site.reference(verb.name)[1]
            least = max(smallest_address_space(), peak // 4)
            count = rounds(3, 20)
            for number in range(count):
                folder = site.fresh("starved")
                most = least + (peak - least) * (2 * number + 1) // (2 * count)
                ended = site.run(verb.arguments(folder), limit(resource.RLIMIT_AS, most))
                told = f"{verb.name} with {most >> 20} of {peak >> 20} MiB\n{ended}"
                self.assertIn(ended.code, (0, 1), told)
                self.assertEqual(len(ended.error_lines()), ended.code, told)
                if ended.code == 1:
                    # The last are words of TBB, where a thread has no place for its stack.
                    self.assertRegex(ended.error_lines()[0], "memory|allocate|pthread_create", told)
                    self.assertEqual(leftovers(folder), [], told)
                failed.append(ended.code)
        self.assertIn(1, failed)


def smallest_address_space():
    """Bytes in which the program starts at all, as a shared library or two more would not."""
    least = 64 << 20
    while site.run(["version"], limit(resource.RLIMIT_AS, least)).code != 0:
        least += 32 << 20
    return least + (32 << 20)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="nadir_faults_") as scratch:
        os.chmod(scratch, 0o755)
        site = Site(sys.argv[1], scratch)
        result = unittest.main(argv=[sys.argv[0], *sys.argv[2:]], exit=False, verbosity=2).result
    sys.exit(0 if result.wasSuccessful() else 1)
