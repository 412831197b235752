// SPDX-License-Identifier: Apache-2.0
import type { Frame, Run } from "./types";

export interface Layers {
  particles: boolean;
  ellipse: boolean;
  estimate: boolean;
  truth: boolean;
  odometry: boolean;
  local: boolean;
  heat: boolean;
  /** 0 .. 1 */
  localOpacity: number;
  /** Share of the local map that is shown, from its rear: to compare with the map beneath. */
  localSwipe: number;
  heatOpacity: number;
}

export const defaultLayers: Layers = {
  particles: true, ellipse: true, estimate: true, truth: true, odometry: false, local: false,
  heat: false, localOpacity: 0.85, localSwipe: 1, heatOpacity: 0.7,
};

export interface State {
  run: Run;
  index: number;
  playing: boolean;
  speed: number;
  follow: boolean;
  connected: boolean;
  layers: Layers;
}

export type Listener = (state: State, changed: Set<keyof State>) => void;

/** The one place that knows what is shown. Listeners run once a change, in the order they came. */
export class Store {
  private listeners: Listener[] = [];

  constructor(readonly state: State) {}

  listen(listener: Listener): void {
    this.listeners.push(listener);
  }

  set(change: Partial<State>): void {
    const changed = new Set<keyof State>();
    for (const key of Object.keys(change) as (keyof State)[]) {
      if (this.state[key] !== change[key]) changed.add(key);
    }
    Object.assign(this.state, change);
    if (changed.size > 0) for (const listener of this.listeners) listener(this.state, changed);
  }

  get frame(): Frame | undefined {
    return this.state.run.frames[this.state.index];
  }

  seek(index: number): void {
    const last = this.state.run.frames.length - 1;
    this.set({ index: Math.max(0, Math.min(last, Math.round(index))) });
  }

  setLayers(change: Partial<Layers>): void {
    this.set({ layers: { ...this.state.layers, ...change } });
  }
}

export interface View {
  x: number;
  y: number;
  resolution: number;
  rotation: number;
}

const SWITCHES = ["particles", "ellipse", "estimate", "truth", "odometry", "local", "heat"] as const;

/** Frame, layers and view as the address keeps them, after its #. */
export function toHash(number: number | undefined, layers: Layers, view: View | null): string {
  const parts: string[] = [];
  if (number !== undefined) parts.push(`frame=${number}`);
  parts.push(`layers=${SWITCHES.filter((name) => layers[name]).join(",")}`);
  if (view) {
    const numbers = [view.x.toFixed(2), view.y.toFixed(2), view.resolution.toPrecision(4),
      view.rotation.toFixed(3)];
    parts.push(`view=${numbers.join(",")}`);
  }
  return `#${parts.join("&")}`;
}

export interface FromHash {
  number?: number;
  layers?: Partial<Layers>;
  view?: View;
}

/** What an address asks for; what it does not say, or says wrongly, is left out. */
export function fromHash(hash: string): FromHash {
  const found: FromHash = {};
  const parameters = new URLSearchParams(hash.replace(/^#/, ""));
  const number = parameters.get("frame");
  if (number && /^\d+$/.test(number)) found.number = Number(number);
  const layers = parameters.get("layers");
  if (layers !== null) {
    const on = new Set(layers.split(","));
    found.layers = Object.fromEntries(SWITCHES.map((name) => [name, on.has(name)]));
  }
  const view = parameters.get("view")?.split(",").map(Number);
  if (view?.length === 4 && view.every(Number.isFinite) && view[2]! > 0) {
    found.view = { x: view[0]!, y: view[1]!, resolution: view[2]!, rotation: view[3]! };
  }
  return found;
}
