// SPDX-License-Identifier: Apache-2.0
// Pictures that belong to a frame: fetched when wanted, the newest few kept.
import { fetchHeatMap, fetchLocalMap, fetchParticles } from "./api";
import { inferno } from "./colour";
import type { HeatMap, Particles, PlacedImage } from "./types";

/** Values by frame, at most `size` of them; `wanted` is told when one has come. */
export class FrameCache<T> {
  private values = new Map<number, T | null>();
  private pending = new Set<number>();

  constructor(
    private readonly fetch: (index: number) => Promise<T>,
    private readonly wanted: () => void,
    private readonly size: number,
  ) {}

  /** The value, null where there is none, undefined while it is on its way. */
  get(index: number): T | null | undefined {
    const value = this.values.get(index);
    if (value === undefined && !this.pending.has(index) && this.pending.size < 4) {
      this.pending.add(index);
      this.fetch(index)
        .then((got) => this.put(index, got), () => this.put(index, null))
        .finally(() => this.pending.delete(index));
    }
    return value;
  }

  put(index: number, value: T | null): void {
    this.values.set(index, value);
    for (const key of this.values.keys()) {
      if (this.values.size <= this.size) break;
      this.values.delete(key);
    }
    this.wanted();
  }
}

export interface Picture {
  place: PlacedImage;
  canvas: HTMLCanvasElement;
}

async function canvasOf(place: PlacedImage): Promise<HTMLCanvasElement> {
  const image = new Image();
  image.src = `data:image/png;base64,${place.png}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = place.width;
  canvas.height = place.height;
  canvas.getContext("2d")!.drawImage(image, 0, 0);
  return canvas;
}

async function localPicture(index: number): Promise<Picture> {
  const place = await fetchLocalMap(index);
  return { place, canvas: await canvasOf(place) };
}

export interface HeatPicture extends Picture {
  place: HeatMap;
}

async function heatPicture(index: number): Promise<HeatPicture> {
  const place = await fetchHeatMap(index);
  const canvas = await canvasOf(place);
  const context = canvas.getContext("2d")!;
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  for (let i = 0; i < pixels.data.length; i += 4) {
    const [red, green, blue] = inferno[pixels.data[i]!]!;
    pixels.data[i] = red;
    pixels.data[i + 1] = green;
    pixels.data[i + 2] = blue;
  }
  context.putImageData(pixels, 0, 0);
  return { place, canvas };
}

export class Pictures {
  readonly particles: FrameCache<Particles>;
  readonly local: FrameCache<Picture>;
  readonly heat: FrameCache<HeatPicture>;

  constructor(came: () => void) {
    this.particles = new FrameCache(fetchParticles, came, 400);
    this.local = new FrameCache(localPicture, came, 60);
    this.heat = new FrameCache(heatPicture, came, 30);
  }
}
