#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures matching against its peers and how its cost grows; writes a dated report with plots.

    benchmarks/peers_report.py [--data DIR] [--quick] [--build build/release]

DIR holds the Aero-Ground run; without it a seeded synthetic place serves. Standard library only.
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import platform
import re
import subprocess
import sys

GROWTH = {"growth_map_side": "side of a square map, px",
          "growth_template_side": "side of a square template, px",
          "growth_headings": "headings",
          "growth_poses": "poses",
          "growth_threads": "threads (time of the wall)"}
WIDTH, HEIGHT, MARGIN = 420, 280, 56
COLOURS = ("#1f77b4", "#d95f02", "#444444")


def run(command):
    print("$", " ".join(command), file=sys.stderr, flush=True)
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)


def growth(build):
    """{benchmark: {variant: [(size, seconds)]}}"""
    document = run([f"{build}/bin/matching_bench", "--benchmark_filter=^growth_",
                    "--benchmark_format=json", "--benchmark_min_time=0.2"])
    curves = {}
    for entry in document["benchmarks"]:
        name, *rest = entry["name"].split("/")
        variant = "".join(word for word in rest[:1] if not word.isdigit())
        size = int(next(word for word in rest if word.isdigit()))
        kind = "real_time" if "real_time" in rest else "cpu_time"
        unit = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}[entry["time_unit"]]
        curves.setdefault(name, {}).setdefault(variant, []).append((size, entry[kind] * unit))
    return curves


def plot(curves, label):
    """Both axes logarithmic."""
    points = [point for curve in curves.values() for point in curve]
    low = [math.log10(min(point[axis] for point in points)) - 0.05 for axis in (0, 1)]
    high = [math.log10(max(point[axis] for point in points)) + 0.05 for axis in (0, 1)]

    def place(point):
        share = [(math.log10(point[a]) - low[a]) / (high[a] - low[a]) for a in (0, 1)]
        return (MARGIN + share[0] * (WIDTH - 1.3 * MARGIN),
                HEIGHT - MARGIN - share[1] * (HEIGHT - 1.4 * MARGIN))

    text = '<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}">{}</text>'
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
             'font-family="sans-serif" font-size="12">',
             '<!-- SPDX-License-Identifier: Apache-2.0 -->',
             '<rect width="100%" height="100%" fill="white"/>']
    for size in sorted({point[0] for point in points}):
        x, _ = place((size, points[0][1]))
        parts.append(f'<path d="M{x:.1f} {HEIGHT - MARGIN}v5" stroke="black"/>')
        parts.append(text.format(x, HEIGHT - MARGIN + 19, "middle", "black", size))
    for exponent in range(math.ceil(low[1]), math.floor(high[1]) + 1):
        for factor in (1, 2, 5):
            seconds = factor * 10.0 ** exponent
            if not low[1] <= math.log10(seconds) <= high[1]:
                continue
            _, y = place((points[0][0], seconds))
            parts.append(f'<path d="M{MARGIN} {y:.1f}H{WIDTH - 0.3 * MARGIN:.1f}" stroke="#ddd"/>')
            parts.append(text.format(MARGIN - 5, y + 4, "end", "black", f"{1e3 * seconds:g}"))
    for colour, (variant, curve) in zip(COLOURS, curves.items()):
        line = " ".join("{:.1f},{:.1f}".format(*place(point)) for point in curve)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += ['<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>'.format(*place(p), colour)
                  for p in curve]
        if variant:
            x, y = place(curve[-1])
            parts.append(text.format(x - 6, y - 8, "end", colour, variant))
    parts.append(text.format(WIDTH / 2, HEIGHT - 12, "middle", "black", label))
    parts.append(text.format(MARGIN - 40, 18, "start", "black", "ms"))
    return "\n".join(parts + ["</svg>", ""])


def machine():
    info = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"model name\s*: (.*)", info)
    return (f"{model.group(1) if model else platform.machine()}, "
            f"{len(os.sched_getaffinity(0))} cores, load {os.getloadavg()[0]:.1f} at the start")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", help="folder of the Aero-Ground run")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    arguments = parser.parse_args()
    today = datetime.date.today().isoformat()
    output = (arguments.output or
              pathlib.Path(__file__).parent / "reports" / f"{today}-peers.md")
    host = machine()
    version = subprocess.run([f"{arguments.build}/bin/nadir", "version"], check=True, text=True,
                             stdout=subprocess.PIPE).stdout.strip().splitlines()
    peers = run([f"{arguments.build}/bin/nadir_bench_peers", "--json",
                 *(["--quick"] if arguments.quick else []),
                 *(["--data", arguments.data] if arguments.data else [])])
    place = "one frame of the Aero-Ground run" if arguments.data else "the synthetic place"
    text = [f"# Matching against peers, {today}", "", f"{host}. Written by", "",
            "    benchmarks/peers_report.py " + " ".join(
                ["--data DIR"] * bool(arguments.data) + ["--quick"] * arguments.quick), "",
            f"On {place}; docs/performance.md says what the contenders are. A dash: another "
            "definition, nothing to compare.", "",
            "| task | contender | median, ms | times ours | largest difference | rms |",
            "|---|---|---|---|---|---|"]

    def number(value):
        return "–" if value is None else f"{value:.2g}"

    for task, contenders in peers.items():
        for name, timing in sorted(contenders.items(), key=lambda item: item[1]["median_s"]):
            text.append(f"| {task} | {name} | {1e3 * timing['median_s']:.4g} "
                        f"| {timing['ratio_to_ours']:.3g} | {number(timing['max_abs_diff'])} "
                        f"| {number(timing.get('rms_diff'))} |")
    text += ["", "## How cost grows", ""]
    for name, curves in growth(arguments.build).items():
        picture = output.with_name(f"{output.stem}-{name.removeprefix('growth_')}.svg")
        picture.write_text(plot(curves, GROWTH[name]))
        text += [f"![{GROWTH[name]}]({picture.name})", ""]
        for variant, curve in curves.items():
            values = ", ".join(f"{size}: {1e3 * seconds:.3g} ms" for size, seconds in curve)
            text += [f"{GROWTH[name]}{', ' + variant if variant else ''}: {values}", ""]
    text += ["## Versions", "", *[f"    {line}" for line in version], ""]
    output.write_text("\n".join(text))
    print(output)


if __name__ == "__main__":
    main()
