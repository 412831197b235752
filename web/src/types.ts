// SPDX-License-Identifier: Apache-2.0
// What the server says; docs/viewer.md is the reference. Metres and radians in the map frame.

/** x, y, yaw. */
export type Pose = [number, number, number];

export interface Frame {
  number: number;
  stamp: number;
  status: string;
  pose: Pose;
  /** xx, xy, x yaw, yy, y yaw, yaw yaw. */
  covariance: [number, number, number, number, number, number];
  effective_particles: number | null;
  best_score: number | null;
  valid_weight: number | null;
  cluster_mass: number | null;
  clusters: number;
  resampled: boolean;
  decode_ms: number;
  update_ms: number;
  truth: Pose | null;
}

export interface MapInfo {
  width: number;
  height: number;
  west: number;
  north: number;
  resolution: number;
  levels: number;
  tile_size: number;
  /** Longitude and latitude of the corners NW, NE, SW, SE; null where the map is not on the Earth. */
  corners: [number, number][] | null;
}

export interface Run {
  name: string;
  live: boolean;
  can_restart: boolean;
  newest_event: number;
  map: MapInfo;
  odometry: [number, number][];
  frames: Frame[];
}

/** An image that lies in the plane: its north-west outer corner and metres per pixel. */
export interface PlacedImage {
  west: number;
  north: number;
  resolution: number;
  width: number;
  height: number;
  png: string;
}

export interface HeatMap extends PlacedImage {
  lowest: number;
  highest: number;
}

/** x, y from the map's north-west corner, yaw, weight: four floats a particle. */
export type Particles = Float32Array;
