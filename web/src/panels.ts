// SPDX-License-Identifier: Apache-2.0
// The table of the frame, the layers' switches, and the marks of the time line.
import { css, inferno } from "./colour";
import { degrees, errorOf, fixed } from "./geometry";
import type { HeatPicture } from "./pictures";
import type { Layers, Store } from "./state";
import type { Frame } from "./types";

const STATUS: Record<string, string> = {
  ok: "compared with the map",
  no_overlap: "too little of it lies in the map: by odometry only",
  no_texture: "nothing to compare: by odometry only",
  no_odometry: "no odometry: the cloud was only spread",
};

export function fillFrameTable(table: HTMLTableElement, frame: Frame | undefined): void {
  const rows: [string, string, string?][] = [];
  if (frame) {
    const error = errorOf(frame);
    const [xx, , , yy, , ww] = frame.covariance;
    rows.push(
      ["frame", `${frame.number}`],
      ["stamp", `${fixed(frame.stamp, 2)} s`],
      ["status", frame.status, STATUS[frame.status]],
      ["x, y", `${fixed(frame.pose[0], 2)}, ${fixed(frame.pose[1], 2)} m`],
      ["yaw", `${fixed(degrees(frame.pose[2]), 1)}°`],
      ["2 sigma", `${fixed(2 * Math.sqrt(xx + yy), 2)} m, ${fixed(degrees(2 * Math.sqrt(ww)), 1)}°`],
    );
    if (error) {
      rows.push(["error", `${fixed(error.position, 3)} m, ${fixed(degrees(error.yaw), 2)}°`]);
    }
    rows.push(
      ["N_eff", `${fixed(frame.effective_particles, 0)}${frame.resampled ? " (drawn anew)" : ""}`],
      ["best score", fixed(frame.best_score, 3), "of the particles"],
      ["valid weight", fixed(frame.valid_weight, 2), "share of the local map that was compared"],
      ["clusters", `${frame.clusters}, the heaviest has ${fixed(100 * (frame.cluster_mass ?? 0), 0)} %`],
      ["time", `${fixed(frame.update_ms, 1)} ms, reading ${fixed(frame.decode_ms, 1)} ms`],
    );
  }
  table.replaceChildren(...rows.map(([name, value, hint]) => {
    const row = document.createElement("tr");
    const head = document.createElement("th");
    head.textContent = name;
    const cell = document.createElement("td");
    cell.textContent = value;
    if (name === "status") cell.dataset.status = value;
    if (hint) row.title = hint;
    row.append(head, cell);
    return row;
  }));
}

const SWITCHES: [keyof Layers, string][] = [
  ["particles", "particles"], ["ellipse", "2-sigma ellipse"], ["estimate", "estimate"],
  ["truth", "truth"], ["odometry", "odometry alone"], ["local", "local map"],
  ["heat", "score heat map"],
];
const SLIDERS: [keyof Layers, string, keyof Layers][] = [
  ["localOpacity", "opacity", "local"], ["localSwipe", "swipe", "local"],
  ["heatOpacity", "opacity", "heat"],
];

export function buildLayers(parent: HTMLElement, store: Store): void {
  const known = store.state.run.frames.some((frame) => frame.truth);
  for (const [name, label] of SWITCHES) {
    const line = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.dataset.layer = name;
    box.disabled = (name === "truth" && !known) ||
      (name === "odometry" && store.state.run.odometry.length === 0);
    box.addEventListener("change", () => store.setLayers({ [name]: box.checked }));
    line.append(box, ` ${label}${box.disabled ? " (not known)" : ""}`);
    line.className = `layer-${name}`;
    parent.append(line);
    for (const [key, text, owner] of SLIDERS) {
      if (owner !== name) continue;
      const slider = document.createElement("label");
      slider.className = "slider";
      const range = document.createElement("input");
      Object.assign(range, { type: "range", min: "0", max: "1", step: "0.01" });
      range.dataset.layer = key;
      range.addEventListener("input", () => store.setLayers({ [key]: Number(range.value) }));
      slider.append(text, range);
      parent.append(slider);
    }
  }
  const show = () => {
    for (const input of parent.querySelectorAll<HTMLInputElement>("input")) {
      const value = store.state.layers[input.dataset.layer as keyof Layers];
      if (input.type === "checkbox") input.checked = Boolean(value) && !input.disabled;
      else input.value = String(value);
    }
  };
  store.listen((_, changed) => { if (changed.has("layers")) show(); });
  show();
}

/** The scale of the heat map that is shown; hidden where none is. */
export function showHeatLegend(legend: HTMLElement, heat: HeatPicture | null | undefined,
  wanted: boolean): void {
  legend.hidden = !wanted;
  if (!wanted) return;
  if (!heat) {
    legend.textContent = heat === null ? "no heat map: nothing could be compared" : "scoring …";
    return;
  }
  const bar = document.createElement("canvas");
  bar.width = 128;
  bar.height = 8;
  const context = bar.getContext("2d")!;
  for (let x = 0; x < 128; ++x) {
    context.fillStyle = css(inferno[2 * x]!);
    context.fillRect(x, 0, 1, 8);
  }
  legend.replaceChildren(`score ${fixed(heat.place.lowest, 2)} `, bar,
    ` ${fixed(heat.place.highest, 2)}`);
}

/** Marks under the scrubber: frames that could not be compared, and where the robot was lost. */
export function drawMarks(canvas: HTMLCanvasElement, frames: Frame[]): void {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
  canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  const context = canvas.getContext("2d")!;
  const step = canvas.width / Math.max(1, frames.length);
  const style = getComputedStyle(document.documentElement);
  frames.forEach((frame, i) => {
    const error = errorOf(frame);
    const colour = error && error.position > 2 ? "--lost"
      : frame.status !== "ok" ? "--doubt" : "--fine";
    context.fillStyle = style.getPropertyValue(colour).trim();
    context.fillRect(i * step, 0, Math.ceil(step), canvas.height);
  });
}
