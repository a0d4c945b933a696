// Legends that stand for those of other plots.

/** Angles beside the plot of φ that aren't those below the picture, to half of their last digit. Runs in the page. */
export function otherAngles() {
  const bodies = [...document.querySelectorAll("[data-body][data-phi]")].map(({ dataset }) => dataset);
  const panel = document.getElementById("panel-phi");
  const unit = { "°": 180 / Math.PI, rad: 1, mrad: 1e3 }[panel?.dataset.unit];
  if (!unit) return [];
  const keys = [...panel.querySelectorAll(".key")].filter((key) => key.querySelector("b"));
  return keys.flatMap((key) => {
    const name = [...key.childNodes].find((node) => node.nodeType === Node.TEXT_NODE)?.textContent;
    const [body, text] = [bodies.find((one) => one.body === name) ?? bodies[0], key.querySelector("b").textContent.replace("−", "-")];
    if (!body || (!name && keys.length > 1) || text.includes("×")) return [];
    const half = 0.5 * 10 ** -(text.split(".")[1] ?? "").length;
    // What is at rest is 0.
    const off = Math.abs(Number(text) - unit * Number(body.phi));
    return off > half * (1 + 1e-6) + 1e-9 && text !== "0" ? [`φ of ${body.body} is ${text} in the plot, ${unit * Number(body.phi)} in the picture`] : [];
  });
}

/** Plots that say "Curves as in" another one, in which a curve of the same name has another colour or other dashes. Runs in the page. */
export function otherLegends() {
  const strokes = (panel) => new Map([...panel.querySelectorAll(".key")].map((key) => {
    const { stroke, strokeDasharray } = getComputedStyle(key.querySelector("svg path"));
    const name = [...key.childNodes].find((node) => node.nodeType === Node.TEXT_NODE)?.textContent ?? "";
    // Samples are drawn to their own scale.
    const dashes = strokeDasharray.split(/[ ,]+/).map(parseFloat);
    return [name, `${stroke} ${dashes.length > 1 ? (dashes[0] / (dashes[0] + dashes[1])).toFixed(3) : "none"}`];
  }));
  const titled = (title) => [...document.querySelectorAll("#plots .panel")].find((panel) => {
    const words = panel.querySelector("h3").cloneNode(true);
    words.querySelectorAll("span").forEach((span) => span.remove());
    return words.textContent.trim() === title;
  });
  return [...document.querySelectorAll("#plots .again")].flatMap((fold) => {
    const [, title] = fold.querySelector("summary").textContent.match(/“(.*)”/);
    const meant = strokes(titled(title));
    return [...strokes(fold)].filter(([name, stroke]) => meant.get(name) !== stroke)
      .map(([name, stroke]) => `${fold.closest(".panel").id}: ${name} is ${stroke}, in ${title} ${meant.get(name)}`);
  });
}

/** What plots lack that are pointed at: the time under the pointer; impulses as bars. */
export async function plotsPointedAt(page) {
  const problems = [];
  const plot = await page.$("#plots .panel:not([hidden]) svg.plot:has(.hover-time)") ?? await page.$("#plots .panel:not([hidden]) svg.plot:has(.hover)");
  if (plot) {
    await plot.scrollIntoViewIfNeeded();
    const { x, y, width } = await plot.boundingBox();
    await page.mouse.move(x + 0.5 * width, y + 30);
    const told = await plot.evaluate((svg) => svg.querySelector(".hover-time")?.textContent ?? "");
    if (!/^[0-9.]+ (s|ms|µs|ns)$/.test(told)) problems.push(`a plot that is pointed at tells the time "${told}"`);
    await page.mouse.move(0, 0);
    if (await plot.evaluate((svg) => svg.querySelector(".hover-time")?.textContent)) problems.push("a plot tells a time that isn't pointed at");
  }
  const lines = await page.$$eval('[id^="panel-impacts-"] .curve', (all) => all.length);
  if (lines > 0) problems.push("impulses are drawn as lines, not as bars");
  const outlined = await page.$$eval(".bars", (all) => all.filter((one) => getComputedStyle(one).stroke !== "none").length);
  if (outlined > 0) problems.push("bars have outlines");
  // Those of several feet over one stretch stand beside each other.
  const hidden = await page.$$eval('[id^="panel-impacts-"]', (all) => all.filter((panel) => {
    const lefts = [...panel.querySelectorAll(".bars")].map((one) => new Set((one.getAttribute("d").match(/M[-0-9.]+/g) ?? [])));
    const shared = lefts.slice(1).flatMap((own) => [...own].filter((left) => lefts[0].has(left)));
    return shared.length > 0.5 * Math.min(...lefts.map((own) => own.size)) && shared.length > 2;
  }).map((panel) => panel.id));
  hidden.forEach((id) => problems.push(`${id}: bars hide each other`));
  return problems;
}

/** States in the legend of a contact that never occur in it. Runs in the page. */
export function statesThatNeverOccur() {
  const letters = { stick: "k", slip: "l", briefly: "b", open: "o" };
  const { points } = JSON.parse(document.getElementById("data").textContent).forces;
  return [...document.querySelectorAll('[id^="panel-state-"]')].flatMap((panel) => {
    const own = points.filter(({ contact }) => panel.id === `panel-state-${contact}`);
    return [...panel.querySelectorAll(".legend i")].map((swatch) => swatch.className)
      .filter((name) => !own.some(({ state }) => state.includes(letters[name]))).map((name) => `${panel.id}: ${name}`);
  });
}

/** What paper shows that tells nothing there: lists of a few of many bodies, or of angles that are all 0; the legend of the plot above once more; pictures
    that leave half of a page empty beside them. */
export async function idleOnPaper(page) {
  await page.emulateMedia({ media: "print" });
  const found = await page.evaluate(() => {
    window.dispatchEvent(new Event("beforeprint"));
    const problems = [];
    const isSeen = (one) => one.getClientRects().length > 0;
    for (const caption of document.querySelectorAll("#stage figcaption")) {
      const text = [...caption.childNodes].filter((one) => one.nodeType === Node.TEXT_NODE || isSeen(one)).map((one) => one.textContent).join("");
      if (/ more/.test(text) || (text.includes("φ") && !/[1-9]/.test(text.replace(/^.*?φ/, "φ")))) problems.push(`a caption says "${text}"`);
    }
    let above = "";
    for (const panel of [...document.querySelectorAll("#plots .panel")].filter(isSeen)) {
      const legend = panel.querySelector(".head > .legend");
      const colours = legend ? [...legend.querySelectorAll("path")].filter(isSeen).map((one) => one.style.stroke || one.style.fill) : [];
      const text = legend && isSeen(legend) ? `${legend.innerText.trim().split(/\s*\n\s*/).join(", ")} ${colours.join(" ")}`.trim() : "";
      if (text && text === above) problems.push(`${panel.id} repeats the legend ${text}`);
      if (text) above = text;
    }
    const pictures = [...document.querySelectorAll("#stage figure")].map((one) => one.getBoundingClientRect());
    if (pictures.length > 1 && Math.abs(pictures[0].top - pictures[1].top) > 2) problems.push("pictures stand below each other");
    window.dispatchEvent(new Event("afterprint"));
    return problems;
  });
  await page.emulateMedia({ media: null });
  return found;
}

/** Whether plots open on a pair whose forces are small beside those of another that are drawn, for a blow that is small beside them, too; `data` is that of the page,
    unpacked. */
export async function otherPairOpened(page, { forces, scenery }) {
  const chosen = await page.$eval("#choice select", (select) => Number(select.value)).catch(() => null);
  if (chosen === null) return [];
  const most = (contact, of) => Math.max(0, ...forces.points.filter((point) => point.contact === contact)
    .map((point) => [...of(point) ?? []].reduce((largest, x) => Math.max(largest, x ?? 0), 0)));
  const drawn = (contact) => (forces.forceless?.includes(contact) ? 0 : most(contact, ({ normal, course }) => course?.[0].y ?? normal));
  const largest = Math.max(...forces.names.map((_, contact) => drawn(contact)));
  const fall = Math.sqrt(scenery.blocks[scenery.contacts[chosen].block].reach / 9.81);
  const own = Math.max(drawn(chosen), most(chosen, ({ impacts }) => impacts) / fall);
  return own < 0.999 * largest ? [`opens on ${forces.names[chosen]} with ${own} N, where another pair has ${largest} N`] : [];
}
