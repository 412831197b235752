// SPDX-License-Identifier: Apache-2.0
// What the programs beside this one share: nadir as a server, and a page of it in Chromium.
import { spawn } from "node:child_process";
import { chromium } from "playwright-core";

/** Starts nadir; `ready` is where it serves. */
export function serve(program, args) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"] });
  const ready = new Promise((resolve, reject) => {
    let said = "";
    const hear = (data) => {
      said += data;
      const url = /http:\/\/[\d.:]+\//.exec(said)?.[0];
      if (url) resolve(url);
    };
    child.stdout.on("data", hear);
    child.stderr.on("data", hear);
    child.on("exit", () => reject(new Error(`nadir ended: ${said}`)));
  });
  return { child, ready };
}

export function launch() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"],
  });
}

/** A page that shows a run; what it complains about is kept in `faults`. */
export async function open(browser, url, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, ...options });
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") page.faults.push(message.text());
  });
  await page.goto(url);
  await page.waitForSelector("#frame tr");
  return page;
}
