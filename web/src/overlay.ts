// SPDX-License-Identifier: Apache-2.0
// What lies over the map: drawn on one canvas, which software rendering does fast.
import Layer from "ol/layer/Layer";
import type { FrameState } from "ol/Map";
import { css, ESTIMATE, ODOMETRY, TRUTH, viridis, weightClass } from "./colour";
import { ellipseOf, inMap } from "./geometry";
import type { Picture, Pictures } from "./pictures";
import type { Store } from "./state";
import type { Particles, Pose } from "./types";

const CLASSES = 12;
/** Pixels a metre from which on particles show where they look. */
const HEADINGS_FROM = 40;
const HEADINGS_AT_MOST = 4000;

/** A drag of the pose or measure tool. */
export interface Drag {
  kind: "pose" | "measure";
  from: [number, number];
  to: [number, number];
}

type Point = [number, number];
type ToPixel = (x: number, y: number) => Point;

export class Overlay extends Layer {
  drag: Drag | null = null;
  private readonly canvas = document.createElement("canvas");
  private readonly palette = Array.from({ length: CLASSES }, (_, i) =>
    css(viridis[Math.round((255 * i) / (CLASSES - 1))]!));

  constructor(private readonly store: Store, private readonly pictures: Pictures) {
    super({});
    this.canvas.className = "overlay";
  }

  override render(state: FrameState): HTMLElement {
    const [width, height] = state.size as [number, number];
    const ratio = state.pixelRatio;
    if (this.canvas.width !== width * ratio || this.canvas.height !== height * ratio) {
      this.canvas.width = width * ratio;
      this.canvas.height = height * ratio;
      this.canvas.style.width = `${width}px`;
      this.canvas.style.height = `${height}px`;
    }
    const context = this.canvas.getContext("2d")!;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const [a, b, c, d, e, f] = state.coordinateToPixelTransform.map((v) => v * ratio) as
      [number, number, number, number, number, number];
    const toPixel: ToPixel = (x, y) => [a * x + c * y + e, b * x + d * y + f];
    this.draw(context, toPixel, ratio / state.viewState.resolution, ratio);
    return this.canvas;
  }

  private draw(context: CanvasRenderingContext2D, toPixel: ToPixel, scale: number, ratio: number) {
    const { run, index, layers } = this.store.state;
    const frame = this.store.frame;
    if (frame && layers.heat) {
      const heat = this.pictures.heat.get(index);
      if (heat) place(context, heat, ([x, y]) => toPixel(x, y), layers.heatOpacity, 1);
    }
    if (frame && layers.local) {
      const local = this.pictures.local.get(index);
      if (local) {
        place(context, local, ([x, y]) => toPixel(...inMap(frame.pose, x, y)),
          layers.localOpacity, layers.localSwipe);
      }
    }
    if (layers.odometry) this.track(context, toPixel, run.odometry, ODOMETRY, ratio, [6, 5]);
    if (layers.truth) {
      const truth = run.frames.flatMap((f) => (f.truth ? [[f.truth[0], f.truth[1]] as Point] : []));
      this.track(context, toPixel, truth, TRUTH, ratio);
    }
    if (layers.estimate) {
      const past = run.frames.slice(0, index + 1).map((f): Point => [f.pose[0], f.pose[1]]);
      this.track(context, toPixel, past, ESTIMATE, ratio);
    }
    if (frame && layers.particles) {
      const particles = this.pictures.particles.get(index);
      if (particles) this.cloud(context, toPixel, particles, scale, ratio);
    }
    if (frame && layers.ellipse) {
      const [xx, xy, , yy] = frame.covariance;
      this.ellipse(context, toPixel, frame.pose, xx, xy, yy, ratio);
    }
    if (frame?.truth && layers.truth) robot(context, toPixel, frame.truth, TRUTH, ratio);
    if (frame && layers.estimate) robot(context, toPixel, frame.pose, ESTIMATE, ratio);
    if (this.drag) this.tool(context, toPixel, this.drag, ratio);
  }

  private track(context: CanvasRenderingContext2D, toPixel: ToPixel, points: Point[],
    colour: string, ratio: number, dash: number[] = []) {
    if (points.length < 2) return;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.beginPath();
    for (const [x, y] of points) context.lineTo(...toPixel(x, y));
    context.lineJoin = "round";
    context.setLineDash(dash.map((d) => d * ratio));
    context.strokeStyle = "rgba(255,255,255,0.75)";
    context.lineWidth = 5 * ratio;
    context.stroke();
    context.strokeStyle = colour;
    context.lineWidth = 2.5 * ratio;
    context.stroke();
    context.setLineDash([]);
  }

  private cloud(context: CanvasRenderingContext2D, toPixel: ToPixel, particles: Particles,
    scale: number, ratio: number) {
    const { west, north } = this.store.state.run.map;
    const count = particles.length / 4;
    let heaviest = 0;
    for (let i = 0; i < count; ++i) heaviest = Math.max(heaviest, particles[4 * i + 3]!);
    const classes: number[][] = Array.from({ length: CLASSES }, () => []);
    for (let i = 0; i < count; ++i) {
      classes[weightClass(particles[4 * i + 3]!, heaviest, CLASSES)]!.push(i);
    }
    const headings = scale / ratio >= HEADINGS_FROM && count <= HEADINGS_AT_MOST;
    const side = (headings ? 4 : 3) * ratio;
    const length = 11 * ratio;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.globalAlpha = 0.85;
    context.lineWidth = ratio;
    classes.forEach((members, k) => {
      context.fillStyle = this.palette[k]!;
      context.strokeStyle = this.palette[k]!;
      context.beginPath();
      for (const i of members) {
        const [u, v] = toPixel(west + particles[4 * i]!, north + particles[4 * i + 1]!);
        context.fillRect(u - side / 2, v - side / 2, side, side);
        if (!headings) continue;
        const yaw = particles[4 * i + 2]!;
        const [u1, v1] = toPixel(west + particles[4 * i]! + Math.cos(yaw),
          north + particles[4 * i + 1]! + Math.sin(yaw));
        context.moveTo(u, v);
        context.lineTo(u + (length * (u1 - u)) / scale, v + (length * (v1 - v)) / scale);
      }
      if (headings) context.stroke();
    });
    context.globalAlpha = 1;
  }

  private ellipse(context: CanvasRenderingContext2D, toPixel: ToPixel, pose: Pose, xx: number,
    xy: number, yy: number, ratio: number) {
    const shape = ellipseOf(xx, xy, yy, 2);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.beginPath();
    for (let k = 0; k <= 48; ++k) {
      const angle = (2 * Math.PI * k) / 48;
      context.lineTo(...toPixel(...inMap([pose[0], pose[1], shape.angle],
        shape.semiMajor * Math.cos(angle), shape.semiMinor * Math.sin(angle))));
    }
    context.closePath();
    context.fillStyle = "rgba(213,94,0,0.12)";
    context.fill();
    context.strokeStyle = "#fff";
    context.lineWidth = 3.5 * ratio;
    context.stroke();
    context.strokeStyle = ESTIMATE;
    context.lineWidth = 1.5 * ratio;
    context.stroke();
  }

  private tool(context: CanvasRenderingContext2D, toPixel: ToPixel, drag: Drag, ratio: number) {
    const from = toPixel(...drag.from);
    const to = toPixel(...drag.to);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...to);
    if (drag.kind === "pose") {
      const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
      for (const side of [-0.5, 0.5]) {
        context.moveTo(...to);
        context.lineTo(to[0] - 14 * ratio * Math.cos(angle + side),
          to[1] - 14 * ratio * Math.sin(angle + side));
      }
    }
    for (const [colour, width] of [["#fff", 6], ["#0072b2", 3]] as const) {
      context.strokeStyle = colour;
      context.lineWidth = width * ratio;
      context.stroke();
    }
  }
}

/** Draws an image where it lies in the plane; `share` of its width, from the left. */
function place(context: CanvasRenderingContext2D, picture: Picture,
  toPixel: (point: Point) => Point, opacity: number, share: number) {
  const { west, north, resolution, width, height } = picture.place;
  const origin = toPixel([west, north]);
  const right = toPixel([west + resolution * width, north]);
  const down = toPixel([west, north - resolution * height]);
  context.setTransform((right[0] - origin[0]) / width, (right[1] - origin[1]) / width,
    (down[0] - origin[0]) / height, (down[1] - origin[1]) / height, origin[0], origin[1]);
  context.globalAlpha = opacity;
  context.imageSmoothingEnabled = false;
  const columns = Math.max(0, Math.round(share * width));
  if (columns > 0) context.drawImage(picture.canvas, 0, 0, columns, height, 0, 0, columns, height);
  context.globalAlpha = 1;
}

/** An arrow head at a pose. */
function robot(context: CanvasRenderingContext2D, toPixel: ToPixel, pose: Pose, colour: string,
  ratio: number) {
  const [u, v] = toPixel(pose[0], pose[1]);
  const ahead = toPixel(...inMap(pose, 1, 0));
  const angle = Math.atan2(ahead[1] - v, ahead[0] - u);
  context.setTransform(Math.cos(angle) * ratio, Math.sin(angle) * ratio, -Math.sin(angle) * ratio,
    Math.cos(angle) * ratio, u, v);
  context.beginPath();
  context.moveTo(12, 0);
  context.lineTo(-8, 7);
  context.lineTo(-4, 0);
  context.lineTo(-8, -7);
  context.closePath();
  context.fillStyle = colour;
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = 1.5;
  context.stroke();
}
