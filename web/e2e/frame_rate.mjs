// SPDX-License-Identifier: Apache-2.0
// How fluent the viewer is on a map of 100 megapixels, in a headless Chromium that renders in
// software.
//
//   node e2e/frame_rate.mjs NADIR DEMO [PARTICLES ...]
//
// NADIR is the program, DEMO the folder of a demo of it. Its map, repeated to 10 000 x 10 000 pixels
// at 10 cm, is localized in with each number of particles (default: 2000 10000); then frames are
// counted while the page plays and is dragged about. Needs gdalinfo (gdal-bin).
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { launch, open, serve } from "./browser.mjs";

const SIDE = 10_000;  // pixels
const SECONDS = 6;

const [program, demo, ...counts] = process.argv.slice(2);
const work = mkdtempSync(join(tmpdir(), "nadir-frame-rate-"));

/** The map, side by side with itself. */
function largeMap() {
  const source = resolve(demo, "campus.tif");
  const info = JSON.parse(execFileSync("gdalinfo", ["-json", source]));
  const [width, height] = info.size;
  const band = (number) => {
    const parts = [];
    for (let y = 0; y < SIDE; y += height) {
      for (let x = 0; x < SIDE; x += width) {
        const [w, h] = [Math.min(width, SIDE - x), Math.min(height, SIDE - y)];
        parts.push(`<SimpleSource><SourceFilename>${source}</SourceFilename><SourceBand>${number}</SourceBand>`
          + `<SrcRect xOff="0" yOff="0" xSize="${w}" ySize="${h}"/>`
          + `<DstRect xOff="${x}" yOff="${y}" xSize="${w}" ySize="${h}"/></SimpleSource>`);
      }
    }
    return `<VRTRasterBand dataType="Byte" band="${number}">${parts.join("")}</VRTRasterBand>`;
  };
  const wkt = info.coordinateSystem?.wkt.replaceAll("&", "&amp;").replaceAll("<", "&lt;") ?? "";
  const vrt = join(work, "large.vrt");
  writeFileSync(vrt, `<VRTDataset rasterXSize="${SIDE}" rasterYSize="${SIDE}"><SRS>${wkt}</SRS>`
    + `<GeoTransform>${info.geoTransform.join(",")}</GeoTransform>${[1, 2, 3].map(band).join("")}</VRTDataset>`);
  const map = join(work, "large.tif");
  execFileSync(program, ["convert", "map", vrt, "-o", map, "--quiet"]);
  return map;
}

/** Frames a second that the page draws while `act` goes on. */
async function rateWhile(page, act) {
  await page.evaluate(() => {
    window.counted = 0;
    window.longest = 0;
    let last = performance.now();
    const count = (now) => {
      window.counted += 1;
      window.longest = Math.max(window.longest, now - last);
      last = now;
      window.counting = requestAnimationFrame(count);
    };
    window.counting = requestAnimationFrame(count);
  });
  const started = Date.now();
  while (Date.now() - started < 1000 * SECONDS) await act((Date.now() - started) / 1000);
  return page.evaluate((seconds) => {
    cancelAnimationFrame(window.counting);
    return { rate: window.counted / seconds, longest_ms: window.longest };
  }, (Date.now() - started) / 1000);
}

async function measure(browser, url) {
  const page = await open(browser, url);
  const paint = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  await page.waitForTimeout(1500);  // the tiles of the first view
  await page.selectOption("#speed", "10");
  await page.click("#play");
  const playing = await rateWhile(page, () => page.waitForTimeout(200));
  await page.fill("#scrubber", "0");
  if (await page.getAttribute("#play", "aria-label") === "Play") await page.click("#play");
  const box = await page.locator("#map").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  const dragged = await rateWhile(page, (t) => page.mouse.move(x + 250 * Math.sin(2 * t), y + 200 * Math.sin(3 * t)));
  await page.mouse.up();
  if (page.faults.length) throw new Error(page.faults.join("\n"));
  return { paint, playing, dragged };
}

const browser = await launch();
try {
  const map = largeMap();
  console.log("particles  first paint, ms  playing, frames/s  dragged while playing, frames/s (longest, ms)");
  for (const count of counts.length ? counts : ["2000", "10000"]) {
    const run = join(work, `run_${count}`);
    execFileSync(program, ["localize", join(demo, "drive"), "--map", map, "-o", run, "--prior", "truth", "--quiet",
      "--layers", "colour", "--particles", count, "--set", `localization.start_particles=${count}`]);
    const { child, ready } = serve(program, ["view", run, "--site", join(demo, "drive"), "--port", "0"]);
    try {
      const { paint, playing, dragged } = await measure(browser, await ready);
      console.log(`${count.padStart(9)}  ${paint.toFixed(0).padStart(15)}  ${playing.rate.toFixed(1).padStart(17)}  `
        + `${dragged.rate.toFixed(1)} (${dragged.longest_ms.toFixed(0)})`);
    } finally {
      child.kill("SIGKILL");
    }
  }
} finally {
  await browser.close();
  rmSync(work, { recursive: true });
}
