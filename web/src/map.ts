// SPDX-License-Identifier: Apache-2.0
import OlMap from "ol/Map";
import View from "ol/View";
import Rotate from "ol/control/Rotate";
import ScaleLine from "ol/control/ScaleLine";
import Zoom from "ol/control/Zoom";
import PointerInteraction from "ol/interaction/Pointer";
import TileLayer from "ol/layer/Tile";
import Projection from "ol/proj/Projection";
import XYZ from "ol/source/XYZ";
import TileGrid from "ol/tilegrid/TileGrid";
import { lengthText, onEarth } from "./geometry";
import { Overlay } from "./overlay";
import type { Pictures } from "./pictures";
import type { Store, View as MapView } from "./state";
import type { Pose } from "./types";

export type Tool = "pose" | "measure" | null;

export class MapPane {
  private readonly map: OlMap;
  private readonly overlay: Overlay;
  private readonly view: View;
  private tool: Tool = null;

  constructor(
    private readonly target: HTMLElement,
    private readonly store: Store,
    pictures: Pictures,
    private readonly readout: HTMLElement,
    private readonly on: { pose(pose: Pose): void; toolLeft(): void; moved(): void },
  ) {
    const { west, north, width, height, resolution, levels, tile_size } = store.state.run.map;
    const extent = [west, north - height * resolution, west + width * resolution, north];
    const projection = new Projection({ code: "map", units: "m", extent, metersPerUnit: 1 });
    const resolutions = Array.from({ length: levels }, (_, z) => resolution * 2 ** (levels - 1 - z));
    const tiles = new TileLayer({
      source: new XYZ({
        projection,
        url: "api/tiles/{z}/{x}/{y}",
        tileGrid: new TileGrid({ extent, origin: [west, north], resolutions, tileSize: tile_size }),
        transition: 0,
        interpolate: true,
      }),
    });
    this.overlay = new Overlay(store, pictures);
    this.view = new View({
      projection,
      center: [(extent[0]! + extent[2]!) / 2, (extent[1]! + extent[3]!) / 2],
      resolution: Math.max(width / 800, height / 600) * resolution,
      maxResolution: 4 * Math.max(width / 400, height / 400) * resolution,
      minResolution: resolution / 40,
      constrainOnlyCenter: true,
    });
    this.map = new OlMap({
      target,
      view: this.view,
      layers: [tiles, this.overlay],
      controls: [new Zoom(), new Rotate({ tipLabel: "North up" }), new ScaleLine({ minWidth: 90 })],
    });
    this.map.addInteraction(this.toolInteraction());
    this.map.on("pointermove", (event) => this.tell(event.coordinate as [number, number]));
    this.map.on("moveend", () => on.moved());
    this.map.on("pointerdrag", () => {
      if (!this.tool) store.set({ follow: false });
    });
  }

  redraw(): void {
    this.overlay.changed();
  }

  get current(): MapView {
    const [x, y] = this.view.getCenter() as [number, number];
    return { x, y, resolution: this.view.getResolution()!, rotation: this.view.getRotation() };
  }

  show(view: MapView): void {
    this.view.setCenter([view.x, view.y]);
    this.view.setResolution(view.resolution);
    this.view.setRotation(view.rotation);
  }

  centre(pose: Pose): void {
    this.view.setCenter([pose[0], pose[1]]);
  }

  /** All poses, with some room around them. */
  showRun(): void {
    const frames = this.store.state.run.frames;
    if (frames.length === 0) return;
    const xs = frames.map((frame) => frame.pose[0]);
    const ys = frames.map((frame) => frame.pose[1]);
    const room = 12;
    this.view.fit([Math.min(...xs) - room, Math.min(...ys) - room, Math.max(...xs) + room,
      Math.max(...ys) + room], { size: this.map.getSize()! });
  }

  use(tool: Tool): void {
    this.tool = tool;
    this.overlay.drag = null;
    this.target.classList.toggle("tool", tool !== null);
    this.redraw();
  }

  /** Map with everything on it, as one picture. */
  async picture(): Promise<Blob> {
    const [width, height] = this.map.getSize() as [number, number];
    const picture = document.createElement("canvas");
    picture.width = width;
    picture.height = height;
    const context = picture.getContext("2d")!;
    for (const canvas of this.target.querySelectorAll("canvas")) {
      context.setTransform(1, 0, 0, 1, 0, 0);
      const numbers = /matrix\(([^)]+)\)/.exec(canvas.style.transform)?.[1];
      const matrix = numbers?.split(",").map(Number);
      if (matrix?.length === 6) context.setTransform(new DOMMatrix(matrix));
      else context.scale(width / canvas.width, height / canvas.height);
      context.drawImage(canvas, 0, 0);
    }
    return new Promise((resolve, reject) => {
      picture.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png");
    });
  }

  private tell([x, y]: [number, number]): void {
    const { west, north, width, height, resolution, corners } = this.store.state.run.map;
    const column = Math.floor((x - west) / resolution);
    const row = Math.floor((north - y) / resolution);
    let text = `x ${x.toFixed(2)}  y ${y.toFixed(2)} m   pixel ${column}, ${row}`;
    if (corners) {
      const right = (x - west) / (width * resolution);
      const down = (north - y) / (height * resolution);
      const [longitude, latitude] = onEarth(corners, right, down);
      text += `   ${latitude.toFixed(7)}, ${longitude.toFixed(7)}`;
    }
    this.readout.textContent = text;
  }

  private toolInteraction(): PointerInteraction {
    return new PointerInteraction({
      handleDownEvent: (event) => {
        if (!this.tool) return false;
        const at = event.coordinate as [number, number];
        this.overlay.drag = { kind: this.tool, from: at, to: at };
        return true;
      },
      handleDragEvent: (event) => {
        const drag = this.overlay.drag;
        if (!drag) return;
        drag.to = event.coordinate as [number, number];
        const length = Math.hypot(drag.to[0] - drag.from[0], drag.to[1] - drag.from[1]);
        if (drag.kind === "measure") this.readout.textContent = lengthText(length);
        this.redraw();
      },
      handleUpEvent: () => {
        const drag = this.overlay.drag;
        if (drag?.kind === "pose") {
          const [dx, dy] = [drag.to[0] - drag.from[0], drag.to[1] - drag.from[1]];
          // A click without a drag keeps the heading that the filter has.
          const yaw = Math.hypot(dx, dy) > 5 * this.view.getResolution()!
            ? Math.atan2(dy, dx) : (this.store.frame?.pose[2] ?? 0);
          this.on.pose([drag.from[0], drag.from[1], yaw]);
          this.use(null);
          this.on.toolLeft();
        }
        return false;
      },
    });
  }
}
