// SPDX-License-Identifier: Apache-2.0
// What ten viewers and a stalled client cost a live localizer.
//
//   node e2e/load.mjs NADIR SITE [RUNS]
//
// SITE has truth. RUNS (default 5) times, one after the other: served with nobody watching, and
// served with ten clients that read its events (particles among them), and one that asks for them and
// never reads. Ends with 1 where the median rate falls by 5 % or more.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import http from "node:http";
import net from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

const VIEWERS = 10;
const [program, site, runs = "5"] = process.argv.slice(2);
const work = mkdtempSync(join(tmpdir(), "nadir-load-"));

function follow(url, seen) {
  const get = http.get(new URL("api/events?after=0", url), (answer) => {
    answer.on("data", (data) => { seen.bytes += data.length; });
    answer.on("error", () => {});
  });
  get.on("error", () => {});
}

function stall(url) {
  const socket = net.connect(Number(url.port), url.hostname, () => {
    socket.write(`GET /api/events?after=0 HTTP/1.1\r\nHost: ${url.host}\r\n\r\n`);
    socket.pause();
  });
  socket.on("error", () => {});
}

/** Local maps a second of a whole run. */
function rate(watched) {
  return new Promise((resolve, reject) => {
    const child = spawn(program, ["localize", site, "-o", join(work, "run"), "--overwrite", "--prior", "truth",
      "--serve", "--port", "0", "--json"], { stdio: ["ignore", "pipe", "pipe"] });
    let json = "";
    let said = "";
    let begun = false;
    const seen = { bytes: 0 };
    child.stdout.on("data", (data) => { json += data; });
    child.stderr.on("data", (data) => {
      said += data;
      const url = /http:\/\/[\d.:]+\//.exec(said)?.[0];
      if (url && !begun) {
        begun = true;
        if (watched) {
          for (let i = 0; i < VIEWERS; ++i) follow(new URL(url), seen);
          stall(new URL(url));
        }
      }
      if (said.includes("finished; still at")) child.kill("SIGINT");
    });
    child.on("exit", () => {
      if (!json) return reject(new Error(said));
      if (watched && seen.bytes === 0) return reject(new Error("no viewer was told anything"));
      resolve(JSON.parse(json).localize_frames_per_s);
    });
  });
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const alone = [];
const watched = [];
try {
  for (let i = 0; i < Number(runs); ++i) {
    alone.push(await rate(false));
    watched.push(await rate(true));
  }
} finally {
  rmSync(work, { recursive: true });
}
const cost = 1 - median(watched) / median(alone);
console.log(`local maps a second, medians of ${runs} runs: ${median(alone).toFixed(1)} alone, `
  + `${median(watched).toFixed(1)} with ${VIEWERS} viewers and one stalled: ${(100 * cost).toFixed(1)} % less`);
process.exit(cost < 0.05 ? 0 : 1);
