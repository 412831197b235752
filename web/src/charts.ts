// SPDX-License-Identifier: Apache-2.0
import uPlot from "uplot";
import { degrees, errorOf, nearestFrame } from "./geometry";
import type { Store } from "./state";
import type { Frame } from "./types";

interface Plot {
  title: string;
  series: { label: string; colour: string; value(frame: Frame): number | null }[];
}

const sigma = (variance: number): number => 2 * Math.sqrt(Math.max(0, variance));

const ERRORS: Plot[] = [
  {
    title: "position error, m",
    series: [
      { label: "error", colour: "#d55e00", value: (f) => errorOf(f)?.position ?? null },
      { label: "2 sigma", colour: "#0072b2", value: (f) => sigma(f.covariance[0] + f.covariance[3]) },
    ],
  },
  {
    title: "yaw error, deg",
    series: [
      {
        label: "error", colour: "#d55e00",
        value: (f) => { const e = errorOf(f); return e ? Math.abs(degrees(e.yaw)) : null; },
      },
      { label: "2 sigma", colour: "#0072b2", value: (f) => degrees(sigma(f.covariance[5])) },
    ],
  },
];

const SPREADS: Plot[] = [
  {
    title: "2 sigma of the position, m",
    series: [{ label: "2 sigma", colour: "#0072b2", value: (f) => sigma(f.covariance[0] + f.covariance[3]) }],
  },
];

const HEALTH: Plot[] = [
  { title: "effective particles", series: [{ label: "N_eff", colour: "#009e73", value: (f) => f.effective_particles }] },
  { title: "best score", series: [{ label: "score", colour: "#cc79a7", value: (f) => f.best_score }] },
  { title: "localizing, ms", series: [{ label: "ms", colour: "#e69f00", value: (f) => f.update_ms }] },
];

/** Charts over time that share cursor and instant; a click goes to its frame. */
export class Charts {
  private plots: { plot: uPlot; about: Plot }[] = [];
  /** Seconds since the first frame: stamps of the wall clock are too long to read. */
  private seconds: number[] = [];

  constructor(private readonly parent: HTMLElement, private readonly store: Store) {
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(parent);
    this.build();
  }

  /** The run has other frames, or the page other colours. */
  build(): void {
    for (const { plot } of this.plots) plot.destroy();
    const frames = this.store.state.run.frames;
    const known = frames.some((frame) => frame.truth);
    this.plots = [...(known ? ERRORS : SPREADS), ...HEALTH].map((about) => ({
      about, plot: this.plotOf(about),
    }));
    this.update();
  }

  update(): void {
    const frames = this.store.state.run.frames;
    this.seconds = frames.map((frame) => this.sinceStart(frame));
    for (const { plot, about } of this.plots) {
      plot.setData([this.seconds, ...about.series.map((s) => frames.map((f) => s.value(f)))] as uPlot.AlignedData);
    }
  }

  private sinceStart(frame: Frame): number {
    return frame.stamp - (this.store.state.run.frames[0]?.stamp ?? 0);
  }

  redraw(): void {
    for (const { plot } of this.plots) plot.redraw(false, false);
  }

  private resize(): void {
    const width = Math.max(160, this.parent.clientWidth);
    for (const { plot } of this.plots) plot.setSize({ width, height: plot.height });
  }

  private plotOf(about: Plot): uPlot {
    const style = getComputedStyle(document.documentElement);
    const ink = style.getPropertyValue("--ink").trim();
    const grid = style.getPropertyValue("--line").trim();
    const axis: uPlot.Axis = {
      stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1, size: 4 },
      font: "11px system-ui, sans-serif",
    };
    return new uPlot({
      width: Math.max(160, this.parent.clientWidth), height: 118, title: about.title,
      cursor: { sync: { key: "time" }, y: false, drag: { x: false, y: false } },
      legend: { show: about.series.length > 1, live: false },
      scales: { x: { time: false }, y: { range: (_, low, high) => span(low, high) } },
      axes: [{ ...axis, size: 24, space: 60, values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { ...axis, size: 48, space: 24 }],
      series: [
        { label: "s" },
        ...about.series.map((s) => ({ label: s.label, stroke: s.colour, width: 1.5, points: { show: false } })),
      ],
      hooks: {
        draw: [(plot) => this.markInstant(plot)],
        ready: [(plot) => plot.over.addEventListener("click", () => this.seekAt(plot))],
      },
    }, [[], ...about.series.map(() => [])] as uPlot.AlignedData, this.parent);
  }

  private seekAt(plot: uPlot): void {
    const left = plot.cursor.left ?? -1;
    if (left < 0 || this.seconds.length === 0) return;
    this.store.set({ playing: false });
    this.store.seek(nearestFrame(this.seconds, plot.posToVal(left, "x")));
  }

  private markInstant(plot: uPlot): void {
    const frame = this.store.frame;
    if (!frame) return;
    const x = Math.round(plot.valToPos(this.sinceStart(frame), "x", true));
    const { ctx } = plot;
    ctx.save();
    ctx.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue("--accent").trim();
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.moveTo(x, plot.bbox.top);
    ctx.lineTo(x, plot.bbox.top + plot.bbox.height);
    ctx.stroke();
    ctx.restore();
  }
}

/** From zero where everything is positive: an error that doubles looks twice as high. */
function span(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  if (low >= 0) return [0, high > 0 ? 1.08 * high : 1];
  const room = 0.08 * (high - low || 1);
  return [low - room, high + room];
}
