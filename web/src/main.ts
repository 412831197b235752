// SPDX-License-Identifier: Apache-2.0
import "ol/ol.css";
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { decodeParticles, fetchRun, sendInitialPose, watch } from "./api";
import { Charts } from "./charts";
import { geoJsonOf, save, tumOf } from "./export";
import { fixed } from "./geometry";
import { MapPane } from "./map";
import { buildLayers, drawMarks, fillFrameTable, showHeatLegend } from "./panels";
import { Pictures } from "./pictures";
import { defaultLayers, fromHash, Store, toHash } from "./state";
import type { Pose, Run } from "./types";

const element = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

function notice(text: string | null, kind: "error" | "info" = "info"): void {
  const box = element("notice");
  box.hidden = text === null;
  box.textContent = text ?? "";
  box.dataset.kind = kind;
}

/** How widely a pose that was set by hand is believed. */
const POSE_SPREAD_M = 2;
const YAW_SPREAD = (15 * Math.PI) / 180;

class Viewer {
  private readonly store: Store;
  private readonly pictures: Pictures;
  private readonly map: MapPane;
  private readonly charts: Charts;
  private played = 0;

  constructor(run: Run) {
    const asked = fromHash(location.hash);
    const first = run.frames.findIndex((frame) => frame.number === asked.number);
    this.store = new Store({
      run, index: first >= 0 ? first : run.live ? Math.max(0, run.frames.length - 1) : 0,
      playing: run.live, speed: 5, follow: asked.view === undefined, connected: true,
      layers: { ...defaultLayers, ...asked.layers },
    });
    this.pictures = new Pictures(() => this.redrawSoon());
    this.map = new MapPane(element("map"), this.store, this.pictures, element("readout"), {
      pose: (pose) => void this.setPose(pose),
      toolLeft: () => this.use(null),
      moved: () => this.keepAddress(),
    });
    this.charts = new Charts(element("charts"), this.store);
    buildLayers(element("layers"), this.store);
    this.bindControls();
    this.bindKeys();
    this.store.listen((_, changed) => this.show(changed));
    if (asked.view) this.map.show(asked.view);
    else this.map.showRun();
    this.show(new Set(["run", "index", "follow", "playing", "layers"]));
    if (run.live) this.follow(run);
    requestAnimationFrame((now) => this.tick(now));
  }

  /** Everything on the screen that depends on what changed. */
  private show(changed: Set<string>): void {
    const { run, index, playing, follow, layers } = this.store.state;
    const frame = this.store.frame;
    if (changed.has("run")) {
      element("run-name").textContent = run.name;
      document.title = `${run.name} – nadir`;
      const scrubber = element<HTMLInputElement>("scrubber");
      scrubber.max = String(Math.max(0, run.frames.length - 1));
      drawMarks(element("marks"), run.frames);
      element("set-pose").hidden = !(run.live && run.can_restart);
      const live = element("live");
      live.hidden = !run.live && !live.dataset.was;
      live.textContent = run.live ? "live" : "finished";
      live.classList.toggle("on", run.live);
      if (run.frames.length === 0) notice("No frame yet: the run has just begun.");
      else if (element("notice").textContent?.startsWith("No frame yet")) notice(null);
    }
    if (changed.has("index") || changed.has("run")) {
      element<HTMLInputElement>("scrubber").value = String(index);
      element("position").textContent = frame
        ? `${index + 1} / ${run.frames.length}  ${fixed(frame.stamp, 2)} s` : "–";
      fillFrameTable(element("frame"), frame);
      if (frame && follow) this.map.centre(frame.pose);
      this.charts.redraw();
    }
    if (changed.has("playing")) {
      element("play").textContent = playing ? "❚❚" : "▶";
      element("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    }
    if (changed.has("follow")) {
      element<HTMLInputElement>("follow").checked = follow;
      if (frame && follow) this.map.centre(frame.pose);
    }
    const heat = layers.heat ? this.pictures.heat.get(index) : null;
    showHeatLegend(element("heat-legend"), heat, layers.heat);
    this.map.redraw();
    if (!playing) this.keepAddress();
  }

  private redrawSoon(): void {
    const { layers, index } = this.store.state;
    showHeatLegend(element("heat-legend"), layers.heat ? this.pictures.heat.get(index) : null,
      layers.heat);
    this.map.redraw();
  }

  private tick(now: number): void {
    const { run, index, playing, speed } = this.store.state;
    if (playing && !run.live && run.frames.length > 1) {
      const here = run.frames[index]!;
      const next = run.frames[index + 1];
      if (!next) this.store.set({ playing: false });
      else if (now - this.played >= (1000 * (next.stamp - here.stamp)) / speed) {
        this.played = now;
        this.store.seek(index + 1);
        this.pictures.particles.get(Math.min(index + 2, run.frames.length - 1));
      }
    }
    requestAnimationFrame((later) => this.tick(later));
  }

  private follow(run: Run): void {
    let newest = run.frames.length;
    const refetch = async () => {
      const fresh = await fetchRun();
      newest = fresh.frames.length;
      this.replace(fresh);
    };
    element("live").dataset.was = "1";
    watch(run.newest_event, {
      frame: (frame) => {
        if (frame.index > newest) {
          void refetch();  // frames were missed: this page was slower than the run
          return;
        }
        if (frame.index < newest) return;
        newest = frame.index + 1;
        this.pictures.particles.put(frame.index, decodeParticles(frame.particles));
        const { particles: _, index: __, ...plain } = frame;
        const state = this.store.state;
        const atEnd = state.index >= state.run.frames.length - 1;
        const frames = [...state.run.frames, plain];
        this.store.set({ run: { ...state.run, frames } });
        if (state.playing && atEnd) this.store.seek(frames.length - 1);
        this.charts.update();
      },
      restart: () => {
        notice("The filter starts anew there.");
        setTimeout(() => notice(null), 2500);
      },
      finished: () => {
        void refetch();
        this.store.set({ playing: false });
        notice(null);
      },
      connected: (yes) => {
        this.store.set({ connected: yes });
        notice(yes ? null : "The connection to nadir is lost; trying again …", "error");
        if (yes) void refetch();
      },
    });
  }

  private replace(run: Run): void {
    const { state } = this.store;
    const atEnd = state.index >= state.run.frames.length - 1;
    this.store.set({ run });
    this.charts.update();
    if (state.playing && run.live && atEnd) this.store.seek(run.frames.length - 1);
  }

  private async setPose(pose: Pose): Promise<void> {
    try {
      await sendInitialPose(pose, POSE_SPREAD_M, YAW_SPREAD);
    } catch (error) {
      notice(error instanceof Error ? error.message : String(error), "error");
    }
  }

  private use(tool: "pose" | "measure" | null): void {
    this.map.use(tool);
    element("set-pose").classList.toggle("on", tool === "pose");
    element("measure").classList.toggle("on", tool === "measure");
    if (tool === "pose") notice("Press where the robot is and drag where it looks. Esc leaves.");
    else if (tool === "measure") notice("Press and drag to measure. Esc leaves.");
    else notice(null);
  }

  private toggleTool(tool: "pose" | "measure"): void {
    if (tool === "pose" && element("set-pose").hidden) return;
    this.use(element(tool === "pose" ? "set-pose" : "measure").classList.contains("on") ? null : tool);
  }

  private toggleLayers(): void {
    const popup = element("layers");
    popup.hidden = !popup.hidden;
    element("layers-toggle").setAttribute("aria-expanded", String(!popup.hidden));
  }

  private toggleTheme(): void {
    const root = document.documentElement;
    const dark = root.dataset.theme
      ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
    this.charts.build();
    drawMarks(element("marks"), this.store.state.run.frames);
  }

  private step(by: number): void {
    this.store.set({ playing: false });
    this.store.seek(this.store.state.index + by);
  }

  private playOrPause(): void {
    const { run, index, playing } = this.store.state;
    if (!playing && !run.live && index >= run.frames.length - 1) this.store.seek(0);
    if (!playing && run.live) this.store.seek(run.frames.length - 1);
    this.store.set({ playing: !playing });
  }

  private bindControls(): void {
    const click = (id: string, action: () => void) => element(id).addEventListener("click", action);
    click("play", () => this.playOrPause());
    click("previous", () => this.step(-1));
    click("next", () => this.step(1));
    click("first", () => this.step(-Infinity));
    click("last", () => this.step(Infinity));
    click("measure", () => this.toggleTool("measure"));
    click("set-pose", () => this.toggleTool("pose"));
    click("layers-toggle", () => this.toggleLayers());
    click("theme", () => this.toggleTheme());
    click("help-toggle", () => element<HTMLDialogElement>("help").showModal());
    const scrubber = element<HTMLInputElement>("scrubber");
    scrubber.addEventListener("input", () => {
      this.store.set({ playing: false });
      this.store.seek(Number(scrubber.value));
    });
    const speed = element<HTMLSelectElement>("speed");
    speed.addEventListener("change", () => this.store.set({ speed: Number(speed.value) }));
    const follow = element<HTMLInputElement>("follow");
    follow.addEventListener("change", () => this.store.set({ follow: follow.checked }));
    for (const button of document.querySelectorAll<HTMLElement>("[data-export]")) {
      button.addEventListener("click", () => {
        element<HTMLDetailsElement>("export").open = false;
        void this.export(button.dataset.export!);
      });
    }
    new ResizeObserver(() => drawMarks(element("marks"), this.store.state.run.frames))
      .observe(element("marks"));
  }

  private async export(kind: string): Promise<void> {
    const { run } = this.store.state;
    if (kind === "png") save("nadir.png", await this.map.picture());
    if (kind === "geojson") save("trajectory.geojson", new Blob([geoJsonOf(run)]));
    if (kind === "tum") save("trajectory.tum", new Blob([tumOf(run)]));
  }

  private bindKeys(): void {
    const actions: Record<string, (event: KeyboardEvent) => void> = {
      " ": () => this.playOrPause(),
      ArrowLeft: (event) => this.step(event.shiftKey ? -10 : -1),
      ArrowRight: (event) => this.step(event.shiftKey ? 10 : 1),
      Home: () => this.step(-Infinity),
      End: () => this.step(Infinity),
      f: () => this.store.set({ follow: !this.store.state.follow }),
      p: () => this.toggleTool("pose"),
      m: () => this.toggleTool("measure"),
      l: () => this.toggleLayers(),
      h: () => this.store.setLayers({ heat: !this.store.state.layers.heat }),
      t: () => this.toggleTheme(),
      "?": () => element<HTMLDialogElement>("help").showModal(),
      Escape: () => this.use(null),
    };
    document.addEventListener("keydown", (event) => {
      const target = event.target as HTMLElement;
      if (event.ctrlKey || event.metaKey || event.altKey || target.closest("dialog, select")) return;
      if (event.key === " " && target.closest("button, summary, input[type=checkbox]")) return;
      const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!action) return;
      event.preventDefault();
      action(event);
    });
  }

  private keepAddress(): void {
    const { layers, follow } = this.store.state;
    const hash = toHash(this.store.frame?.number, layers, follow ? null : this.map.current);
    if (hash !== location.hash) history.replaceState(null, "", hash);
  }
}

fetchRun().then(
  (run) => new Viewer(run),
  (error: unknown) => {
    document.body.classList.add("failed");
    notice(`The run could not be loaded: ${error instanceof Error ? error.message : error}`, "error");
  },
);
