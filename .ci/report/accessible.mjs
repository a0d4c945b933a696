// What a reader needs who has no mouse, sees no page, or sees it with little contrast.

import { readFileSync } from "node:fs";

const axe = readFileSync(new URL("./node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

/** Violations of WCAG and of good practice that axe-core finds, with all that unfolds unfolded. */
export async function violations(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return found.violations.map(({ id, help, nodes }) =>
    `${id}: ${help}: ${nodes.slice(0, 3).map(({ target }) => target.join(" ")).join(", ")} (${nodes.length})`);
}

/** Goes through the page by the Tab key: every control must come, be in view, and be seen to have the focus. */
export async function keyboardWalk(page) {
  const problems = [];
  const wanted = await page.evaluate(() => {
    const all = [...document.querySelectorAll("a[href], button, input, select, textarea, summary, [tabindex='0']")];
    const usable = all.filter((one) => !one.disabled && one.getClientRects().length > 0 && getComputedStyle(one).visibility !== "hidden");
    // Of radio buttons of one name Tab stops at one.
    const stops = usable.filter((one) => one.type !== "radio" || one.checked);
    stops.forEach((one, k) => { one.dataset.stop = k; });
    document.activeElement.blur();
    window.scrollTo(0, 0);
    return stops.map((one) => one.id || one.getAttribute("aria-label") || one.textContent.trim().slice(0, 30));
  });
  const reached = new Set();
  for (let k = 0; k < wanted.length + 2; k++) {
    await page.keyboard.press("Tab");
    const stop = await page.evaluate(() => {
      const one = document.activeElement;
      if (!one || one === document.body) return null;
      const box = one.getBoundingClientRect();
      const { outlineStyle, outlineWidth } = getComputedStyle(one);
      return {
        number: one.dataset.stop,
        seen: box.bottom > 0 && box.top < window.innerHeight && box.right > 0 && box.left < window.innerWidth,
        ringed: outlineStyle !== "none" && parseFloat(outlineWidth) >= 1,
        name: one.id || one.textContent.trim().slice(0, 30),
      };
    });
    if (stop?.number === undefined) continue;
    if (reached.has(stop.number)) break;
    reached.add(stop.number);
    if (!stop.seen) problems.push(`the focus is out of view at «${stop.name}»`);
    if (!stop.ringed) problems.push(`the focus isn't seen at «${stop.name}»`);
  }
  wanted.filter((_, k) => !reached.has(String(k))).forEach((name) => problems.push(`Tab doesn't come to «${name}»`));
  return problems;
}

/** Operates the player of a run's page by keys alone. */
export async function playByKeys(page) {
  const problems = [];
  const time = async () => Number(await page.getAttribute("#time-readout", "data-t"));
  const slider = page.getByRole("slider", { name: "Time", exact: true });
  if (!(await slider.focus({ timeout: 2000 }).then(() => true, () => false))) return ["there is no slider called Time"];
  await page.keyboard.press("Home");
  const first = await time();
  await page.keyboard.press("ArrowRight");
  const second = await time();
  if (!(second > first)) problems.push(`→ on the slider stays at t = ${second}`);
  const said = await slider.getAttribute("aria-valuetext");
  if (!said?.startsWith("t = ") || Math.abs(Number.parseFloat(said.slice(4)) - second) > 1e-3) {
    problems.push(`the slider says «${said}» at t = ${second}`);
  }
  await page.keyboard.press("End");
  if (!((await time()) > second)) problems.push("End on the slider doesn't lead to the end");
  const picture = await page.getAttribute("#scene", "aria-label");
  if (!picture?.includes(`t = ${Number((await time()).toPrecision(6))} s`)) problems.push(`the picture says «${picture}»`);
  await page.keyboard.press("Home");
  const there = await page.getByRole("button", { name: "Play", exact: true }).focus({ timeout: 2000 }).then(() => true, () => false);
  if (!there) return [...problems, "there is no button called Play"];
  await page.keyboard.press("Enter");
  const pause = page.getByRole("button", { name: "Pause", exact: true });
  await pause.waitFor({ timeout: 1000 }).catch(() => problems.push("Enter on Play doesn't play"));
  await page.waitForFunction((t) => Number(document.getElementById("time-readout").dataset.t) > t, first, { timeout: 5000 })
    .catch(() => problems.push("nothing moves after Play"));
  await page.keyboard.press("Space");
  const stopped = await time();
  await page.waitForTimeout(50);
  if ((await time()) !== stopped) problems.push("Space on Pause doesn't pause");
  return problems;
}

/** Plots must have a name that says what they show, with values. */
export async function plotsWithoutWords(page) {
  const names = await page.$$eval(".plot, .paper svg, .page-drawing svg", (all) => all.filter((one) => one.getClientRects().length > 0)
    .map((one) => one.getAttribute("aria-label") ?? one.querySelector("title")?.textContent ?? ""));
  return names.filter((name) => name.trim().length < 5).map((name) => `a plot is called «${name}»`);
}
