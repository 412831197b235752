// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { decodeParticles } from "../src/api";
import { viridis, weightClass } from "../src/colour";
import { ellipseOf, errorOf, inMap, lengthText, nearestFrame, onEarth, wrapAngle } from "../src/geometry";
import { defaultLayers, fromHash, Store, toHash } from "../src/state";
import type { Frame, Run } from "../src/types";

const frame = (number: number, stamp: number): Frame => ({
  number, stamp, status: "ok", pose: [1, 2, 3], covariance: [1, 0, 0, 1, 0, 1],
  effective_particles: 1, best_score: null, valid_weight: 1, cluster_mass: 1, clusters: 1,
  resampled: false, decode_ms: 1, update_ms: 1, truth: null,
});

test("angles are wrapped to (-pi, pi]", () => {
  for (const angle of [-10, -Math.PI, 0, 1, Math.PI, 3.5, 100]) {
    const wrapped = wrapAngle(angle);
    expect(wrapped).toBeGreaterThan(-Math.PI);
    expect(wrapped).toBeLessThanOrEqual(Math.PI + 1e-12);
    expect(Math.cos(wrapped)).toBeCloseTo(Math.cos(angle), 9);
    expect(Math.sin(wrapped)).toBeCloseTo(Math.sin(angle), 9);
  }
  expect(wrapAngle(-Math.PI)).toBeCloseTo(Math.PI, 12);
});

test("longitude and latitude are interpolated between the corners", () => {
  const corners: [number, number][] = [[9, 48.1], [9.2, 48.1], [9, 48], [9.2, 48]];
  expect(onEarth(corners, 0, 0)).toEqual([9, 48.1]);
  expect(onEarth(corners, 1, 1)).toEqual([9.2, 48]);
  const [longitude, latitude] = onEarth(corners, 0.25, 0.5);
  expect(longitude).toBeCloseTo(9.05, 9);
  expect(latitude).toBeCloseTo(48.05, 9);
});

test("the ellipse has the covariance's axes", () => {
  const along = ellipseOf(4, 0, 1, 2);
  expect(along.semiMajor).toBeCloseTo(4);
  expect(along.semiMinor).toBeCloseTo(2);
  expect(along.angle).toBeCloseTo(0);
  // (4, 1) turned by 30 degrees
  const [c, s] = [Math.cos(Math.PI / 6), Math.sin(Math.PI / 6)];
  const turned = ellipseOf(4 * c * c + s * s, 3 * s * c, 4 * s * s + c * c, 1);
  expect(turned.semiMajor).toBeCloseTo(2);
  expect(turned.semiMinor).toBeCloseTo(1);
  expect(turned.angle).toBeCloseTo(Math.PI / 6);
  expect(ellipseOf(0, 0, 0, 2).semiMinor).toBe(0);
});

test("errors are counted without alignment, yaw over the seam", () => {
  const wrong = { ...frame(1, 0), pose: [3, 4, 3.1] as [number, number, number],
    truth: [0, 0, -3.1] as [number, number, number] };
  expect(errorOf(wrong)!.position).toBeCloseTo(5);
  expect(errorOf(wrong)!.yaw).toBeCloseTo(6.2 - 2 * Math.PI);
  expect(errorOf(frame(1, 0))).toBeNull();
});

test("points of the robot go to the map", () => {
  const [x, y] = inMap([10, 20, Math.PI / 2], 1, 2);
  expect(x).toBeCloseTo(8);
  expect(y).toBeCloseTo(21);
});

test("the nearest frame is found", () => {
  const stamps = [1, 2, 4, 8];
  for (const at of [-5, 1.4, 1.6, 2.9, 3.1, 7, 100]) {
    const distances = stamps.map((stamp) => Math.abs(stamp - at));
    expect(distances[nearestFrame(stamps, at)]).toBe(Math.min(...distances));
  }
});

test("lengths are written for people", () => {
  expect(lengthText(0.0123)).toBe("12 mm");
  expect(lengthText(3.416)).toBe("3.42 m");
  expect(lengthText(1200)).toBe("1.20 km");
});

test("particles come as little-endian floats", () => {
  const bytes = new Uint8Array(new Float32Array([1.5, -2, 0.25, 1]).buffer);
  expect(Array.from(decodeParticles(btoa(String.fromCharCode(...bytes))))).toEqual([1.5, -2, 0.25, 1]);
});

test("weights fall into classes", () => {
  expect(weightClass(0, 1, 8)).toBe(0);
  expect(weightClass(1, 1, 8)).toBe(7);
  expect(weightClass(0.5, 1, 8)).toBe(4);
  expect(weightClass(1, 0, 8)).toBe(0);
  expect(viridis).toHaveLength(256);
});

test("the address keeps frame, layers and view", () => {
  const layers = { ...defaultLayers, heat: true, truth: false };
  const view = { x: 431000.25, y: -12.5, resolution: 0.05, rotation: 0.1 };
  const back = fromHash(toHash(17, layers, view));
  expect(back.number).toBe(17);
  expect(back.layers!.heat).toBe(true);
  expect(back.layers!.truth).toBe(false);
  expect(back.view).toEqual(view);
});

test("an address that says nonsense is passed over", () => {
  expect(fromHash("#frame=x&view=1,2,-1,0")).toEqual({});
  expect(fromHash("")).toEqual({});
  expect(fromHash("#view=1,2")).toEqual({});
});

test("the store stays within the run and tells what changed", () => {
  const run = { frames: [frame(1, 0), frame(2, 1), frame(3, 2)] } as unknown as Run;
  const store = new Store({ run, index: 0, playing: false, speed: 1, follow: true, connected: true,
    layers: defaultLayers });
  const seen: string[][] = [];
  store.listen((_, changed) => seen.push([...changed]));
  store.seek(99);
  expect(store.state.index).toBe(2);
  store.seek(2);
  store.seek(-4);
  expect(store.frame!.number).toBe(1);
  store.setLayers({ heat: true });
  expect(seen).toEqual([["index"], ["index"], ["layers"]]);
});
