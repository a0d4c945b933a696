// Opens the reports of runs in headless Chromium and checks what a reader would see: no error, no request to anywhere, the
// block where trajectory.csv says, the numbers of summary.json, no text over another, no sideways scrolling.
//
//   node check.mjs CHROMIUM RUN_DIR...

import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [executablePath, ...runs] = process.argv.slice(2);
const widths = [1280, 390];
const problems = [];

/** The rows of a CSV file, as objects of numbers where they are numbers. */
function table(file) {
  const [header, ...rows] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(header.map((name, k) => [name, Number(row[k])])));
}

/** `a.b.c` of an object. */
const at = (object, path) => path.split(".").reduce((value, key) => value?.[key], object);

/** Texts that lie over each other, within each picture and over the whole page. Runs in the page. */
function overlaps() {
  const found = [];
  const visible = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility !== "hidden";
  const boxesOf = (elements) => elements.filter(visible).filter((e) => e.textContent.trim()).map((e) => {
    const { left, right, top, bottom } = e.getBoundingClientRect();
    return { text: e.textContent.trim().slice(0, 40), left, right, top, bottom };
  });
  const compare = (boxes, where) => {
    for (let i = 0; i < boxes.length; i++) {
      for (let j = i + 1; j < boxes.length; j++) {
        const [a, b] = [boxes[i], boxes[j]];
        const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        // A text's box is higher than its letters.
        if (wide > 1 && high > 3) found.push(`${where}: «${a.text}» and «${b.text}»`);
      }
    }
  };
  for (const svg of document.querySelectorAll("svg")) {
    compare(boxesOf([...svg.querySelectorAll("text")]), svg.id || svg.getAttribute("aria-label") || "picture");
  }
  const leaves = [...document.querySelectorAll("h1, h2, h3, dt, dd, button, label, summary, figcaption > span, p, td, th")]
    .filter((e) => !e.querySelector("p, dt, dd, td, th, button, label"));
  compare(boxesOf(leaves), "page");
  return found;
}

const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"],
});
try {
  for (const run of runs) {
    const summary = JSON.parse(readFileSync(join(run, "summary.json"), "utf8"));
    const trajectory = table(join(run, "trajectory.csv"));
    for (const width of widths) {
      const problem = (text) => problems.push(`${run} at ${width} px: ${text}`);
      const page = await browser.newPage({ viewport: { width, height: 900 } });
      page.on("console", (message) => message.type() === "error" && problem(`console: ${message.text()}`));
      page.on("pageerror", (error) => problem(`script: ${error.message}`));
      page.on("request", (request) => request.url().startsWith("file:") || problem(`asks for ${request.url()}`));
      await page.goto(pathToFileURL(resolve(run, "report.html")).href);

      const frames = Number(await page.getAttribute("#time-slider", "max")) + 1;
      for (const fraction of [0, 0.21, 0.5, 0.83, 1]) {
        await page.$eval("#time-slider", (slider, index) => {
          slider.value = index;
          slider.dispatchEvent(new Event("input"));
        }, Math.round(fraction * (frames - 1)));
        const t = Number(await page.getAttribute("#time-readout", "data-t"));
        const row = trajectory.find((one) => Math.abs(one.t - t) < 1e-9);
        if (!row) continue; // rows of the table may be further apart than frames
        for (const body of await page.$$eval("[data-body][data-x]", (all) => all.map(({ dataset }) => ({ ...dataset })))) {
          for (const key of ["x", "y", "phi"]) {
            const [shown, wanted] = [Number(body[key]), row[`${body.body}.${key}`]];
            // The page holds some seven digits.
            if (!(Math.abs(shown - wanted) <= 1e-6 * Math.max(1, Math.abs(wanted)))) {
              problem(`at t = ${t} ${body.body}.${key} is ${shown}, not ${wanted}`);
            }
          }
        }
      }
      const numbers = await page.$$eval("[data-summary]", (all) => all.map(({ dataset }) => [dataset.summary, dataset.value]));
      if (numbers.length === 0) problem("shows no number of the summary");
      for (const [path, value] of numbers) {
        const wanted = at(summary, path);
        if (String(value) !== String(wanted) && Number(value) !== Number(wanted)) {
          problem(`${path} is ${value}, not ${wanted}`);
        }
      }
      await page.evaluate(() => document.querySelectorAll("details").forEach((one) => one.setAttribute("open", "")));
      (await page.evaluate(overlaps)).forEach((text) => problem(`texts overlap in ${text}`));
      const sideways = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      if (sideways > 0) problem(`scrolls sideways by ${sideways} px`);
      await page.close();
    }
  }
} finally {
  await browser.close();
}
problems.forEach((text) => console.error(text));
console.log(`${runs.length} reports at ${widths.join(" and ")} px: ${problems.length} problems`);
process.exitCode = problems.length === 0 ? 0 : 1;
