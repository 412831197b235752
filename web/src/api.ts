// SPDX-License-Identifier: Apache-2.0
import type { Frame, HeatMap, Particles, PlacedImage, Pose, Run } from "./types";

async function answer(path: string, init?: RequestInit): Promise<Response> {
  const response = await fetch(path, init);
  if (response.ok) return response;
  const said = (await response.json().catch(() => null)) as { error?: string } | null;
  throw new Error(said?.error ?? `${path}: ${response.status}`);
}

export const fetchRun = async (): Promise<Run> => (await answer("api/run")).json();

export const fetchParticles = async (index: number): Promise<Particles> =>
  new Float32Array(await (await answer(`api/particles/${index}`)).arrayBuffer());

export const fetchLocalMap = async (index: number): Promise<PlacedImage> =>
  (await answer(`api/local/${index}`)).json();

export const fetchHeatMap = async (index: number): Promise<HeatMap> =>
  (await answer(`api/heat/${index}`)).json();

export async function sendInitialPose(pose: Pose, positionM: number, yawSpread: number) {
  await answer("api/initial_pose", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({
      x: pose[0], y: pose[1], yaw: pose[2], position_m: positionM, yaw_spread: yawSpread,
    }),
  });
}

export function decodeParticles(base64: string): Particles {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}

export interface LiveFrame extends Frame {
  index: number;
  particles: string;
}

export interface Watch {
  frame(frame: LiveFrame): void;
  restart(): void;
  finished(): void;
  /** The connection was lost, or is there again. The browser itself tries on and on. */
  connected(yes: boolean): void;
}

export function watch(after: number, on: Watch): EventSource {
  const source = new EventSource(`api/events?after=${after}`);
  source.addEventListener("frame", (event) => on.frame(JSON.parse(event.data) as LiveFrame));
  source.addEventListener("restart", () => on.restart());
  source.addEventListener("finished", () => {
    source.close();
    on.finished();
  });
  source.onopen = () => on.connected(true);
  source.onerror = () => on.connected(false);
  return source;
}
