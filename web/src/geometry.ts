// SPDX-License-Identifier: Apache-2.0
import type { Frame, Pose } from "./types";

export const degrees = (radians: number): number => (radians * 180) / Math.PI;

/** The same angle in (-pi, pi]. */
export function wrapAngle(angle: number): number {
  const turns = Math.ceil((angle - Math.PI) / (2 * Math.PI));
  return angle - turns * 2 * Math.PI;
}

export interface Ellipse {
  semiMajor: number;
  semiMinor: number;
  /** Direction of the major axis, radians from east. */
  angle: number;
}

/** The n-sigma ellipse of the position: eigenvectors of the 2 x 2 covariance. */
export function ellipseOf(xx: number, xy: number, yy: number, sigmas: number): Ellipse {
  const mean = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  return {
    semiMajor: sigmas * Math.sqrt(Math.max(0, mean + spread)),
    semiMinor: sigmas * Math.sqrt(Math.max(0, mean - spread)),
    angle: 0.5 * Math.atan2(2 * xy, xx - yy),
  };
}

export interface PoseError {
  position: number;
  yaw: number;
}

/** Against the truth, without alignment; nothing where it is not known. */
export function errorOf(frame: Frame): PoseError | null {
  if (!frame.truth) return null;
  return {
    position: Math.hypot(frame.pose[0] - frame.truth[0], frame.pose[1] - frame.truth[1]),
    yaw: wrapAngle(frame.pose[2] - frame.truth[2]),
  };
}

/** Where a point of the robot frame is in the map. */
export function inMap(pose: Pose, x: number, y: number): [number, number] {
  const c = Math.cos(pose[2]);
  const s = Math.sin(pose[2]);
  return [pose[0] + c * x - s * y, pose[1] + s * x + c * y];
}

/** The frame whose stamp is nearest; stamps increase. */
export function nearestFrame(stamps: ArrayLike<number>, stamp: number): number {
  let low = 0;
  let high = stamps.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (stamps[middle]! < stamp) low = middle + 1;
    else high = middle;
  }
  const before = low > 0 ? low - 1 : low;
  return stamp - stamps[before]! < stamps[low]! - stamp ? before : low;
}

/** Longitude and latitude at a share of the map's width (from the west) and height (from the north). */
export function onEarth(corners: [number, number][], right: number, down: number): [number, number] {
  const between = (axis: 0 | 1): number => {
    const [nw, ne, sw, se] = corners.map((corner) => corner[axis]) as [number, number, number, number];
    return (1 - down) * ((1 - right) * nw + right * ne) + down * ((1 - right) * sw + right * se);
  };
  return [between(0), between(1)];
}

/** A length for people: "12 mm", "3.42 m", "1.20 km". */
export function lengthText(metres: number): string {
  if (metres < 0.1) return `${(1000 * metres).toFixed(0)} mm`;
  if (metres < 1000) return `${metres.toFixed(2)} m`;
  return `${(metres / 1000).toFixed(2)} km`;
}

export function fixed(value: number | null | undefined, digits: number): string {
  return value === null || value === undefined || !Number.isFinite(value)
    ? "–"
    : value.toFixed(digits);
}
