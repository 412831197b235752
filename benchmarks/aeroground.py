#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures nadir on the Aero-Ground run and writes a dated report.

    benchmarks/aeroground.py DATA [--seeds 20] [--nadir build/release/bin/nadir]

DATA is the folder with global_no_cars.jpg, local/ and truth.txt. Everything is measured through the
command line, as a user would; standard library only.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

FRAMES = "160:224"  # those with truth
PARTICLES = 1000


def nadir(program, *arguments):
    """Runs a verb quietly and returns its JSON document."""
    command = [program, *map(str, arguments), "--json", "--quiet"]
    print("$", " ".join(command), file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


def localize(program, site, folder, seeds, *options):
    result = nadir(program, "localize", site, "-o", folder, "--prior", "truth", "--frames", FRAMES,
                   "--particles", PARTICLES, "--seed", 0, "--seeds", seeds, *options)
    runs = result["runs"]
    summary = result["summary"]
    rates = [run["localize_frames_per_s"] for run in runs]
    nees = [run["evaluation"]["nees"]["mean"] for run in runs]
    return {"rmse": summary["ape_rmse_m"], "yaw": summary["yaw_rmse_deg"],
            "largest": summary["ape_max_m"]["highest"], "lost": summary["lost"], "seeds": seeds,
            "rate": statistics.median(rates), "nees": statistics.mean(nees),
            "unanswered": sum(run["evaluation"]["unanswered"] for run in runs)}


def localization_table(program, site, folder, all_seeds, slow_seeds):
    cases = [("default", (), all_seeds),
             ("default, 1000 from the start",
              ("--set", f"localization.start_particles={PARTICLES}"), all_seeds)]
    for score in ("ncc", "wncc", "wncc_paper"):
        # wncc_paper has no closed form: its poses are scored one by one, thirty times slower.
        seeds = slow_seeds if score == "wncc_paper" else all_seeds
        cases.append((f"paper, {score}", ("--preset", "paper", "--score", score), seeds))
    rows = []
    for name, options, seeds in cases:
        row = localize(program, site, folder / name.replace(", ", "_").replace(" ", "_"), seeds, *options)
        rows.append(f"| {name} | {row['rmse']['mean']:.3f} ± {row['rmse']['spread']:.3f} "
                    f"| {row['yaw']['mean']:.2f} | {row['largest']:.2f} | {row['lost']} of {seeds} "
                    f"| {row['unanswered']} | {row['nees']:.2f} | {row['rate']:.1f} |")
    return ["| preset, score | RMSE, m, mean ± spread | yaw RMSE, deg | largest error, m "
            "| seeds lost (> 2 m) | unanswered frames | NEES | local maps a second |",
            "|---|---|---|---|---|---|---|---|", *rows]


def sharpness_table(program, site, folder, seeds):
    """The default over `localization.temper`, from a near prior and from a wide one."""
    rows = []
    for spread in ("5,5", "15,30"):
        for temper in (25, 50, 75, 100, 150, 200):
            row = localize(program, site, folder / f"temper_{temper}_{spread.replace(',', '_')}", seeds,
                           "--prior-spread", spread, "--set", f"localization.temper={temper}")
            rows.append(f"| {spread.replace(',', ' m, ')}° | {temper} | {row['rmse']['mean']:.3f} "
                        f"| {row['yaw']['mean']:.2f} | {row['largest']:.2f} | {row['lost']} of {seeds} "
                        f"| {row['nees']:.2f} |")
    return ["| prior off by up to | `temper` | RMSE, m | yaw RMSE, deg | largest error, m "
            "| seeds lost (> 2 m) | NEES |", "|---|---|---|---|---|---|---|", *rows]


def truth_frames(site):
    lines = (site / "truth.tum").read_text().splitlines()
    return [int(float(line.split()[0])) for line in lines if line and not line.startswith("#")]


def whole_map(program, site, folder):
    """Every frame with truth, matched in the whole map at the heading of the truth."""
    first, last = map(int, FRAMES.split(":"))
    errors = {}
    for frame in truth_frames(site):
        if not first <= frame <= last:
            continue
        result = nadir(program, "match", site, "--frame", frame, "-o", folder / f"match_{frame}")
        candidates = result["matches"][0]["candidates"]
        errors[frame] = candidates[0]["error_m"] if candidates else float("inf")
    near = sum(error <= 0.5 for error in errors.values())
    far = ", ".join(f"{frame} ({error:.2f} m)" for frame, error in errors.items() if error > 0.5)
    return [f"{near} of {len(errors)} frames within 0.5 m: {100 * near / len(errors):.1f} %; "
            f"median error {statistics.median(errors.values()):.2f} m.", "", f"Farther off: {far}."]


def machine():
    model = "unknown processor"
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    return f"{model}, {len(os.sched_getaffinity(0))} cores, {platform.system()} {platform.machine()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--slow-seeds", type=int, default=5, help="seeds of wncc_paper")
    parser.add_argument("--nadir", default="build/release/bin/nadir")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    arguments = parser.parse_args()
    today = datetime.date.today().isoformat()
    output = arguments.output or pathlib.Path(__file__).parent / "reports" / f"{today}-aeroground.md"
    version = subprocess.run([arguments.nadir, "version"], stdout=subprocess.PIPE, text=True,
                             check=True).stdout.splitlines()[0]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        site = folder / "site"
        nadir(arguments.nadir, "convert", "aeroground", arguments.data, "-o", site)
        table = localization_table(arguments.nadir, site, folder, arguments.seeds,
                                   arguments.slow_seeds)
        sharpness = sharpness_table(arguments.nadir, site, folder, arguments.seeds)
        matches = whole_map(arguments.nadir, site, folder)
    text = [f"# Aero-Ground run, {today}", "",
            f"{version}; {machine()}. Written by", "",
            "    benchmarks/aeroground.py DATA", "",
            f"## Localization, frames {FRAMES} (56 with truth), {PARTICLES} particles, "
            f"{arguments.seeds} seeds ({arguments.slow_seeds} of wncc_paper)", "",
            "The default has 20000 particles until the first resampling, as a rule for one "
            "frame; the second row has 1000 there too. Start uniform in ±5 m and ±5 degrees around a prior that the seed moves by up to as "
            "much; odometry registered from the local maps; online estimates; no alignment. The "
            "paper's Table II: 0.4256 m (WNCC + PF), 1.2988 m (NCC + PF).", "", *table, "",
            "Why the paper's own protocol stands so far from its Table II here: its scores are so "
            "flat that the effective sample size stays at 99.9 % of the particles (docs/scores.md), "
            "so the weighted mean stays about where prior and odometry put it, and the prior is "
            "off by up to 5 m on purpose; the scripts published with the paper cut the map around "
            "the true place, so that their filter cannot leave it, and used an odometry that was "
            "not published.", "",
            "## Sharpness of the likelihood, `localization.temper`", "", *sharpness, "",
            "The default is 100. The 95 % band of the NEES over all frames of a run, were they "
            "independent, is about 2.4 to 3.6; below it the covariance is too large, above it too "
            "small.", "",
            f"## Whole map at the true heading, zwncc with high-pass, frames {FRAMES}", "",
            *matches, ""]
    output.write_text("\n".join(text))
    print(output)


if __name__ == "__main__":
    main()
