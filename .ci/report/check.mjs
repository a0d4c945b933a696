// Opens the pages of runs and studies in headless Chromium and checks what a reader would see: no error, no request to anywhere, the
// blocks where trajectory.csv says and inside the picture, what was recorded in a plot and no plot of mere rounding, the verdict and the numbers of summary.json, no
// text over another, no sideways scrolling; and what one would meet who uses the keyboard, or hears the page.
//
//   node check.mjs CHROMIUM RUN_DIR...

import { existsSync, readFileSync, statSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { keyboardWalk, playByKeys, plotsWithoutWords, violations } from "./accessible.mjs";
import { pageData } from "./columns.mjs";
import { flatAtFirst, gravityOf, outOfPicture, outOfSightAtFirst, specksAtFirst, unfoldedOnPaper, unplotted, wrongVerdicts } from "./motion.mjs";
import { wrongAxes, wrongPowers } from "./axes.mjs";
import { idleOnPaper, otherAngles, otherLegends, otherPairOpened, plotsPointedAt, statesThatNeverOccur } from "./legends.mjs";
import { besideTheirBeams, leaningApart, wrongSaved } from "./picture.mjs";
import { overlaps } from "./overlaps.mjs";
import { plotsDrawn, plotsOfRounding } from "./rounding.mjs";

const [executablePath, ...folders] = process.argv.slice(2);
/** Widths of the window, px, each in one of the two colour schemes. */
const windows = [[1280, "light"], [390, "dark"]];
/** What the pages of runs and studies are called. */
const pages = ["report.html", "tradeoff.html", "study.html", "compare.html", "fit.html", "record.html"];
/** Largest pages, bytes: of few bodies, and of any run. */
const largest = { few: 1.2e6, any: 5e6 };
const problems = [];

/** The rows of a CSV file, as objects of numbers where they are numbers. */
function table(file) {
  const [header, ...rows] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(header.map((name, k) => [name, Number(row[k])])));
}

/** `a.b.c` of an object. */
const at = (object, path) => path.split(".").reduce((value, key) => value?.[key], object);

/** What holds of every page. */
async function anyPage(page, problem) {
  (await violations(page)).forEach((text) => problem(`axe: ${text}`));
  (await keyboardWalk(page)).forEach(problem);
  (await plotsWithoutWords(page)).forEach(problem);
  (await page.evaluate(overlaps)).forEach((text) => problem(`texts overlap in ${text}`));
  // Tables that fit a telephone, and those of records and half cycles: numbers that one doesn't see without scrolling.
  const cut = await page.$$eval(".fit, #model .scroll, #records .scroll, #reactions .scroll, #rocking .scroll", (all) => all.filter((one) => one.scrollWidth > one.clientWidth)
    .map((one) => one.querySelector("tr").textContent.trim()));
  cut.forEach((text) => problem(`numbers of a table are out of view: ${text}`));
  const wide = await page.$$eval("#tiles dd", (all) => all.filter((one) => one.scrollWidth > one.clientWidth || one.getClientRects().length > 1
    || one.offsetHeight > 1.9 * parseFloat(getComputedStyle(one).fontSize)).map((one) => one.textContent));
  wide.forEach((text) => problem(`a number doesn't fit the line of its tile: ${text}`));
  const sideways = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  if (sideways > 0) problem(`scrolls sideways by ${sideways} px`);
}

/** The page of a run beside its tables. */
async function ofRun(page, run, problem, isFirst) {
  const summary = JSON.parse(readFileSync(join(run, "summary.json"), "utf8"));
  const trajectory = table(join(run, "trajectory.csv"));
  const frames = Number(await page.getAttribute("#time-slider", "max")) + 1;
  const specks = await page.evaluate(specksAtFirst);
  if (specks !== null) problem(`the picture opens on bodies of ${specks} px`);
  for (const fraction of [0, 0.21, 0.5, 0.83, 1]) {
    await page.$eval("#time-slider", (slider, index) => {
      slider.value = index;
      slider.dispatchEvent(new Event("input"));
    }, Math.round(fraction * (frames - 1)));
    const t = Number(await page.getAttribute("#time-readout", "data-t"));
    // Of contacts at the start: later they may touch nothing.
    const told = fraction > 0 ? "#panel-phi .key b, #panel-x .key b, #panel-y .key b" : "#plots .key b";
    const unread = await page.$$eval(told, (all) => all.filter((one) => one.textContent.includes("–")).length);
    if (unread > 0) problem(`at t = ${t} ${unread} values are not told`);
    (await page.evaluate(otherAngles)).forEach((text) => problem(`at t = ${t} ${text}`));
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
  (await page.evaluate(outOfSightAtFirst)).forEach(problem);
  // Of many small bodies, and of a few that go far, the picture opens on a part.
  await page.$eval("#view-all", (button) => button.click());
  // In the first window at every time there is, in the others at fewer, to save time: their pictures differ in scale only.
  (await page.evaluate(outOfPicture, isFirst ? 1 : 20)).forEach(problem);
  (await playByKeys(page)).forEach(problem);
  if (!isFirst) return;
  // What doesn't depend on the window.
  (await wrongSaved(page)).forEach(problem);
  (await page.evaluate(leaningApart)).forEach(problem);
  (await page.evaluate(besideTheirBeams)).forEach(problem);
  (await flatAtFirst(page, trajectory)).forEach(problem);
  (await page.evaluate(otherLegends)).forEach((text) => problem(`refers to another legend: ${text}`));
  (await plotsPointedAt(page)).forEach(problem);
  (await page.evaluate(unfoldedOnPaper)).forEach((text) => problem(`unfolds on paper: ${text}`));
  (await page.evaluate(statesThatNeverOccur)).forEach((text) => problem(`a legend has a state that never occurs: ${text}`));
  wrongPowers(await page.$eval("body > script:last-of-type", (script) => script.textContent)).forEach(problem);
  const data = pageData(await page.$eval("#data", (element) => element.textContent));
  (await wrongAxes(page, data)).forEach(problem);
  (await otherPairOpened(page, data)).forEach(problem);
  wrongVerdicts(summary, trajectory, data, gravityOf(readFileSync(join(run, "scene.toml"), "utf8"))).forEach(problem);
  (await unplotted(page, trajectory)).forEach(problem);
  (await idleOnPaper(page)).forEach((text) => problem(`on paper ${text}`));
  const envelopes = join(run, "envelopes.csv");
  plotsOfRounding(await plotsDrawn(page), data, summary, existsSync(envelopes) ? table(envelopes) : []).forEach(problem);
  const [size, bodies] = [statSync(join(run, "report.html")).size, data.scenery.blocks.length + data.scenery.beams.length];
  const limit = bodies <= 10 && summary.steps <= 2e5 ? largest.few : largest.any;
  if (size > limit) problem(`has ${size} bytes, more than ${limit}`);
}

const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"],
});
try {
  for (const folder of folders) {
    const file = pages.find((name) => existsSync(join(folder, name)));
    if (!file) {
      problems.push(`${folder} has no page`);
      continue;
    }
    for (const [width, colorScheme] of windows) {
      const problem = (text) => problems.push(`${join(folder, file)} at ${width} px, ${colorScheme}: ${text}`);
      const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme });
      page.on("console", (message) => message.type() === "error" && problem(`console: ${message.text()}`));
      page.on("pageerror", (error) => problem(`script: ${error.message}`));
      page.on("request", (request) => request.url().startsWith("file:") || problem(`asks for ${request.url()}`));
      await page.goto(pathToFileURL(resolve(folder, file)).href);
      if (file === "report.html") await ofRun(page, folder, problem, width === windows[0][0]);
      await page.evaluate(() => document.querySelectorAll("details").forEach((one) => one.setAttribute("open", "")));
      await anyPage(page, problem);
      await page.close();
    }
  }
} finally {
  await browser.close();
}
problems.forEach((text) => console.error(text));
console.log(`${folders.length} pages at ${windows.map(([width]) => width).join(" and ")} px: ${problems.length} problems`);
process.exitCode = problems.length === 0 ? 0 : 1;
