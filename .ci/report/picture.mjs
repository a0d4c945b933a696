// What the picture shows of forces, and what is left of it in a file.

import { readFileSync } from "node:fs";

/** Whether the picture as a file doesn't say at which time it is, and by how much deflections are exaggerated. */
export async function wrongSaved(page) {
  const problems = [];
  const hasBeams = await page.isVisible("#exaggeration");
  for (const slot of hasBeams ? [2, 0] : [0]) {
    await page.$eval("#exaggeration", (slider, value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    }, slot);
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save-picture")]);
    const svg = readFileSync(await download.path(), "utf8");
    // Not only in its name for those who can't see it.
    if (!svg.includes(`>${await page.textContent("#time-readout")}`)) problems.push("a saved picture doesn't say its time");
    if (svg.includes("deflections × 5") !== (slot === 2)) problems.push(`a saved picture says a wrong exaggeration for slot ${slot}`);
  }
  return problems;
}

/** Pairs of a block and straight ground whose arrows aren't parallel: equilibrium leaves open how their points share what is tangential. Runs in the page. */
export function leaningApart() {
  const { scenery, forces } = JSON.parse(document.getElementById("data").textContent);
  const how = document.getElementById("network");
  if (![...how.options].some(({ value }) => value === "arrows")) return [];
  const before = how.value;
  how.value = "arrows";
  how.dispatchEvent(new Event("change"));
  const slider = document.getElementById("time-slider");
  const springs = new Set(forces.compliant ?? []);
  const straight = scenery.contacts.map(({ beam, other, points }) =>
    beam === null && other === null && scenery.profile.length === 0 && points.every(({ crest }) => crest === null));
  const found = new Set();
  for (let frame = 0; frame <= Number(slider.max); frame += Math.ceil(slider.max / 20)) {
    slider.value = frame;
    slider.dispatchEvent(new Event("input"));
    const directions = new Map();
    for (const arrow of document.querySelectorAll("#scene .force")) {
      const pair = Number(arrow.dataset.contact);
      const [a, b, c, d] = arrow.getAttribute("d").match(/[-0-9.]+/g).map(Number);
      const direction = Math.atan2(d - b, c - a);
      // The ends of short ones are rounded.
      if (!straight[pair] || springs.has(pair) || Math.hypot(c - a, d - b) < 8) continue;
      if (Math.abs((directions.get(pair) ?? direction) - direction) > 0.02) found.add(`arrows of ${forces.names[pair]} lean apart`);
      directions.set(pair, direction);
    }
  }
  how.value = before;
  how.dispatchEvent(new Event("change"));
  return [...found];
}

/** Contacts with beams whose forces act where the picture has none of the beam: left or right of it. Runs in the page. */
export function besideTheirBeams() {
  const { scenery } = JSON.parse(document.getElementById("data").textContent);
  const how = document.getElementById("network");
  if (![...how.options].some(({ value }) => value === "arrows")) return [];
  const before = how.value;
  how.value = "arrows";
  how.dispatchEvent(new Event("change"));
  const root = document.getElementById("scene");
  const slider = document.getElementById("time-slider");
  const found = new Set();
  for (let frame = 0; frame <= Number(slider.max); frame += Math.ceil(slider.max / 20)) {
    slider.value = frame;
    slider.dispatchEvent(new Event("input"));
    for (const arrow of root.querySelectorAll(".force")) {
      const { name, beam } = scenery.contacts[Number(arrow.dataset.contact)];
      if (beam === null) continue;
      const { a: scale, e: left } = root.getScreenCTM();
      const end = left + scale * Number(arrow.getAttribute("d").match(/[-0-9.]+/g)[2]);
      const box = root.querySelector(`[data-body="${CSS.escape(scenery.beams[beam].name)}"] .beam`).getBoundingClientRect();
      if (end < box.left - 3 || end > box.right + 3) found.add(`a force of ${name} acts beside the beam that it acts on`);
    }
  }
  how.value = before;
  how.dispatchEvent(new Event("change"));
  return [...found];
}
