// SPDX-License-Identifier: Apache-2.0
// The viewer in a real browser: a finished run is looked at, a live one is sent to another pose.
//
//   node e2e/viewer.mjs NADIR SITE RUN [SHOTS]
//
// NADIR is the program, SITE a sequence folder with truth, RUN a run of it. CHROMIUM names the
// browser (default: /usr/bin/chromium). Screenshots go to SHOTS where it is given. Exit code 1
// where anything is not as it should be.
import assert from "node:assert/strict";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, open, serve } from "./browser.mjs";

const [program, site, run, shots] = process.argv.slice(2);
assert(run, "usage: node e2e/viewer.mjs NADIR SITE RUN [SHOTS]");

const shot = async (page, name) => {
  if (shots) await page.screenshot({ path: join(shots, `${name}.png`) });
};
const cell = (row) => `#frame tr:nth-child(${row}) td`;
const frameNumber = (page) => page.textContent(cell(1)).then(Number);

async function finishedRun(browser) {
  const { child, ready } = serve(program, ["view", run, "--site", site, "--port", "0"]);
  try {
    const url = await ready;
    const page = await open(browser, url);
    const first = await frameNumber(page);
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.inputValue("#scrubber"), "1");
    assert.ok((await frameNumber(page)) > first);
    await page.keyboard.press("End");
    const count = Number((await page.textContent("#position")).split(/[ /]+/)[1]);
    assert.equal(Number(await page.inputValue("#scrubber")), count - 1);

    await page.fill("#scrubber", "0");
    assert.equal(await frameNumber(page), first);
    await page.selectOption("#speed", "10");
    await page.click("#play");
    await page.waitForFunction(() => Number(document.getElementById("scrubber").value) > 0);
    await page.click("#play");

    await page.click("#layers-toggle");
    await page.check("[data-layer=local]");
    await page.check("[data-layer=heat]");
    await page.waitForSelector("#heat-legend canvas");
    assert.match(await page.textContent(cell(2)), /^-?\d+\.\d\d s$/);
    await page.mouse.move(400, 400);
    assert.match(await page.textContent("#readout"), /x -?[\d.]+\s+y -?[\d.]+ m/);
    assert.match(new URL(page.url()).hash, /frame=\d+&layers=.*heat/);
    await shot(page, "desktop-light");

    const again = await open(browser, page.url(), { colorScheme: "dark" });
    assert.equal(await frameNumber(again), await frameNumber(page));  // the address keeps it
    await again.waitForSelector("#heat-legend canvas");
    await shot(again, "desktop-dark");
    const small = await open(browser, url, { viewport: { width: 400, height: 800 } });
    const wide = await small.evaluate(() => document.documentElement.scrollWidth > innerWidth);
    assert.equal(wide, false, "the small page is wider than its window");
    await shot(small, "small");
    assert.deepEqual([...page.faults, ...again.faults, ...small.faults], []);
    console.log("finished run: loads, steps, plays, scrubs, shows its layers, keeps its address");
  } finally {
    child.kill("SIGKILL");
  }
}

async function liveRun(browser) {
  const out = join(mkdtempSync(join(tmpdir(), "nadir-e2e-")), "run");
  const { child, ready } = serve(program, ["localize", site, "-o", out, "--prior", "truth",
    "--serve", "--port", "0", "--rate", "1.5"]);
  try {
    const page = await open(browser, await ready);
    await page.waitForSelector("#live.on");
    await page.waitForFunction(() => Number(document.getElementById("scrubber").max) >= 2);
    const before = Number((await page.textContent(cell(4))).split(",")[0]);

    // Press some metres away from the robot, which is in the middle, and drag.
    await page.keyboard.press("p");
    const box = await page.locator("#map").boundingBox();
    const at = { x: box.x + box.width / 2 + 120, y: box.y + box.height / 2 };
    await page.mouse.move(at.x, at.y);
    const target = Number(/x (-?[\d.]+)/.exec(await page.textContent("#readout"))[1]);
    await page.mouse.down();
    await page.mouse.move(at.x + 60, at.y, { steps: 4 });
    await page.mouse.up();
    await page.waitForFunction(
      ([place, old, where]) => {
        const now = Number(document.querySelector(where).textContent.split(",")[0]);
        return Math.abs(now - place) < 2.5 && Math.abs(now - old) > 1;
      }, [target, before, cell(4)], { timeout: 20000 });
    await shot(page, "live");
    assert.deepEqual(page.faults, []);
    console.log(`live run: watched; sent from x ${before} to ${target}, and it went there`);
  } finally {
    child.kill("SIGKILL");
  }
}

const browser = await launch();
try {
  await finishedRun(browser);
  await liveRun(browser);
} finally {
  await browser.close();
}
