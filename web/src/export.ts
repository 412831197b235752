// SPDX-License-Identifier: Apache-2.0
import type { Run } from "./types";

export function geoJsonOf(run: Run): string {
  return JSON.stringify({
    type: "FeatureCollection",
    features: [
      {
        type: "Feature",
        properties: { name: run.name, frame: "map, metres" },
        geometry: {
          type: "LineString",
          coordinates: run.frames.map((frame) => [frame.pose[0], frame.pose[1]]),
        },
      },
    ],
  });
}

/** TUM: stamp, x, y, z, and the quaternion of the heading. */
export function tumOf(run: Run): string {
  const lines = run.frames.map(({ stamp, pose: [x, y, yaw] }) => {
    const numbers = [x, y, 0, 0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
    return `${stamp.toFixed(9)} ${numbers.map((n) => n.toFixed(9)).join(" ")}`;
  });
  return `# timestamp tx ty tz qx qy qz qw\n${lines.join("\n")}\n`;
}

export function save(name: string, content: Blob): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
