# SPDX-License-Identifier: Apache-2.0
"""A small place, made once, the long verbs on it, and the means to run them and look at what they leave."""

import json
import os
import pathlib
import random
import resource
import shutil
import subprocess
import threading
import time

ROUNDS = int(os.environ.get("NADIR_FAULT_ROUNDS", "0"))  # 0 = few, for the gate
# Files that hold times, memory or paths, and differ between runs that do the same.
VARYING = {"manifest.json", "timing.csv", "report.html", "map.report.json", "map.report.html",
           "frames.csv", "run_time.svg", "run_time_over_run.svg"}
# What a writer that was killed may leave, and the next one removes.
UNFINISHED = ".unfinished-"


def rounds(gate, nightly):
    """How many rounds of a test: a few, or as many as NADIR_FAULT_ROUNDS asks, at most `nightly`."""
    return min(ROUNDS, nightly) if ROUNDS else gate


class Ended:
    """How a run of the program ended."""

    def __init__(self, code, output, errors, seconds):
        self.code = code  # negative: the signal that ended it
        self.output = output
        self.errors = errors
        self.seconds = seconds

    def error_lines(self):
        return [line for line in self.errors.splitlines() if line.startswith("nadir: error:")]

    def __str__(self):
        return f"exit {self.code} after {self.seconds:.2f} s\n{self.errors[-3000:]}"


class Verb:
    """A verb on the site: its words, and what it writes below a folder of its own."""

    def __init__(self, name, words, output):
        self.name = name
        self.words = words  # without -o
        self.output = output

    def arguments(self, folder):
        words = self.words + ["-o", str(folder / self.output)]
        return words


class Site:
    """`nadir simulate` and the maps that the other verbs need, in a scratch folder."""

    def __init__(self, program, scratch):
        self.program = program
        self.scratch = pathlib.Path(scratch)
        self.folder = self.scratch / "site"
        small = []
        for option in ("flight_image_width=480", "flight_image_height=360", "flight_focal_px=375",
                       "stereo_image_width=320", "stereo_image_height=240", "stereo_focal_px=190",
                       "texel_m=0.2", "margin_m=5", "width_m=60", "depth_m=50"):
            small += ["--set", "simulation." + option]
        self.simulate = ["simulate", "--photos", "6", "--frames", "4", "--sensors", "stereo"] + small
        made = self.run(self.simulate + ["-o", str(self.folder)])
        assert made.code == 0, made
        truth = self.folder / "truth"
        quick = ["--gsd", "0.2", "--set", "aerial_mapping.features_per_photo=1000"]
        few = ["--prior", "truth", "--particles", "100"]
        self.verbs = {verb.name: verb for verb in (
            Verb("map", ["map", str(self.folder / "photos"), "--allow-parts"] + quick, "map.tif"),
            Verb("ground", ["ground", str(self.folder / "stereo")], "ground"),
            Verb("localize", ["localize", str(truth)] + few, "run"),
            Verb("match", ["match", str(truth), "--frame", "2"], "match"),
            Verb("run", ["run", str(self.folder / "stereo"), "--map", str(truth / "map.tif")] + few,
                 "run"),
            Verb("simulate", self.simulate, "simulated"),
            Verb("convert", ["convert", "map", str(truth / "map.tif"), "--gsd", "0.07"], "map.tif"),
            Verb("demo", ["demo", "--quick"], "demo"),
        )}
        self.undisturbed = {}

    def fresh(self, name):
        """An empty folder for the outputs of a round."""
        folder = self.scratch / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def start(self, arguments, prepare=None):
        return subprocess.Popen([self.program, *arguments], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                errors="replace", preexec_fn=prepare)

    def finish(self, process, started):
        output, errors = process.communicate(timeout=600)
        return Ended(process.returncode, output, errors, time.monotonic() - started)

    def run(self, arguments, prepare=None):
        started = time.monotonic()
        return self.finish(self.start(arguments, prepare), started)

    def reference(self, name):
        """Seconds, largest address space (bytes) and outputs of an undisturbed run of a verb."""
        if name not in self.undisturbed:
            verb = self.verbs[name]
            folder = self.fresh("undisturbed_" + name)
            started = time.monotonic()
            process = self.start(verb.arguments(folder))
            peak = AddressSpace(process.pid)
            ended = self.finish(process, started)
            assert ended.code == 0, ended
            self.undisturbed[name] = (ended.seconds, peak.end(), contents(folder))
        return self.undisturbed[name]


class AddressSpace:
    """Watches how large the address space of a process becomes."""

    def __init__(self, pid):
        self.pid = pid
        self.largest = 0
        self.thread = threading.Thread(target=self.watch)
        self.thread.start()

    def watch(self):
        while True:
            try:
                status = pathlib.Path(f"/proc/{self.pid}/status").read_text(encoding="ascii")
            except OSError:
                return
            for line in status.splitlines():
                if line.startswith("VmPeak:"):
                    self.largest = 1024 * int(line.split()[1])
            if "\nState:\tZ" in status:
                return
            time.sleep(0.01)

    def end(self):
        self.thread.join()
        return self.largest


def contents(folder):
    """Bytes of every file below a folder, by its path; hidden ones too."""
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def leftovers(folder):
    """What writers have left unfinished in a folder."""
    return [str(path.relative_to(folder)) for path in folder.rglob("*") if UNFINISHED in path.name]


def faults_of(found, whole):
    """What is wrong with outputs: each must be one of the undisturbed run, and as it was there."""
    faults = []
    for path, data in found.items():
        if any(UNFINISHED in part or part.endswith(".work") for part in pathlib.PurePath(path).parts):
            continue
        if path not in whole:
            faults.append(f"{path} is none of the outputs")
        elif path.endswith(".json"):
            try:
                json.loads(data)
            except ValueError:
                faults.append(f"{path} is no whole document")
        elif pathlib.PurePath(path).name in VARYING:
            kind = path.rpartition(".")[2]
            if kind in ("html", "svg") and not data.rstrip().endswith(b"</" + kind.encode() + b">"):
                faults.append(f"{path} is not whole")
        elif data != whole[path]:
            faults.append(f"{path} is not as in the undisturbed run")
    return faults


def seeded(*words):
    """Random numbers that follow from these words alone."""
    return random.Random(" ".join(str(word) for word in words))


def limit(kind, amount):
    """Sets a limit of the process to be started."""
    def prepare():
        resource.setrlimit(kind, (amount, amount))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return prepare
