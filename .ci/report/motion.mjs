// What the page says of the motion, against the tables of the run.

const largest = (rows, pick) => rows.reduce((most, row) => Math.max(most, Math.abs(pick(row))), 0);

/** Bodies out of the picture, in every so many of the pictures that the slider leads to. Runs in the page. */
export function outOfPicture(every) {
  const slider = document.getElementById("time-slider");
  const root = document.getElementById("scene");
  const { width, height } = root.viewBox.baseVal;
  // Beams and blocks; the ground has no end.
  const bodies = [...root.querySelectorAll("[data-body]")].filter((one) => one.dataset.body !== "ground")
    .flatMap((one) => [...one.querySelectorAll(".body, .beam")].map((shape) => [one.dataset.body, shape]));
  const crowd = [...root.querySelectorAll(".crowd")].map((shape) => ["a body", shape]);
  const found = [];
  for (let frame = 0; frame <= Number(slider.max) && found.length < 5; frame += every) {
    slider.value = frame;
    slider.dispatchEvent(new Event("input"));
    for (const [name, shape] of [...bodies, ...crowd]) {
      const box = shape.getBBox();
      if (box.width === 0 && box.height === 0) continue;
      if (box.x < 0 || box.y < 0 || box.x + box.width > width || box.y + box.height > height) {
        found.push(`${name} is out of the picture at ${document.getElementById("time-readout").textContent}`);
      }
    }
  }
  return found;
}

/** Bodies that leave a picture that opens close to a few of them, and says so: it is to widen, or to follow them. Runs in the page. */
export function outOfSightAtFirst() {
  const said = document.getElementById("scene-keys").textContent;
  if (!/widens as they leave|picture follows the bodies/.test(said)) return [];
  const slider = document.getElementById("time-slider");
  const root = document.getElementById("scene");
  const { width, height } = root.viewBox.baseVal;
  const found = new Set();
  const show = (frame) => {
    slider.value = frame;
    slider.dispatchEvent(new Event("input"));
    for (const body of root.querySelectorAll("[data-body] .body")) {
      const box = body.getBBox();
      const inside = box.x >= 0 && box.y >= 0 && box.x + box.width <= width && box.y + box.height <= height;
      if (!inside) found.add(`${body.closest("[data-body]").dataset.body} leaves the picture that opens close to it`);
    }
  };
  for (let part = 0; part <= 40; part++) show(Math.round((part / 40) * Number(slider.max)));
  show(0);
  return [...found];
}

/** The size of the bodies as the page opens, px, if they are too small to be seen; null otherwise. Runs in the page. */
export function specksAtFirst() {
  const sizes = [...document.querySelectorAll("#scene [data-body] .body")].map((shape) => shape.getBBox())
    .map(({ width, height }) => Math.max(width, height)).sort((a, b) => a - b);
  const size = sizes[Math.floor(sizes.length / 2)];
  return size < 7 ? size.toFixed(1) : null;
}

/** Whether the plots open on a flat line: on all of a run in which something moves in its first or last twentieth only. */
export async function flatAtFirst(page, trajectory) {
  const [start, end] = [trajectory[0].t, trajectory[trajectory.length - 1].t];
  const base = await page.evaluate(() => document.body.textContent.match(/relative to the (ground|supports)/)?.[1]);
  // Of supports there are none but those of the only beam.
  const bases = Object.keys(trajectory[0]).filter((key) => (base === "ground" ? /^ground\./ : /\.support\./).test(key));
  const moves = (key) => {
    // On ground or supports that move it counts what moves on them.
    const under = base && /[xy]$/.test(key) ? bases.find((one) => one.split(".").pop() === key.split(".").pop()) : undefined;
    const values = trajectory.map((row) => row[key] - (under ? row[under] : 0));
    const [low, high] = values.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
    const last = values[values.length - 1];
    // What is rounding isn't plotted.
    if (!(high - low > 1e-4)) return null;
    const differs = (from) => (x) => Math.abs(x - from) > 0.02 * (high - low);
    return [trajectory[values.findIndex(differs(values[0]))].t, trajectory[values.findLastIndex(differs(last))].t];
  };
  const spans = Object.keys(trajectory[0]).filter((key) => /\.(x|y|phi|vx|vy|omega)$/.test(key)).map(moves).filter(Boolean);
  if (!spans.length) return [];
  const part = (Math.max(...spans.map(([, to]) => to)) - Math.min(...spans.map(([from]) => from))) / (end - start);
  const opened = await page.$("#opened-on") !== null;
  if (opened && part > 0.45) return [`opens on a part of the run, though ${(100 * part).toFixed(0)} % of it moves`];
  // Curves that have the extremes of many steps would be polygons.
  const coarse = await page.evaluate((share) => {
    const { thinned, t } = JSON.parse(document.getElementById("data").textContent).curves;
    return thinned && (share * t.length) / 2 < 60;
  }, 1.5 * part);
  return !opened && !coarse && part >= 0 && part < 0.3 && trajectory.length > 1000 ? [`opens on all of a run of which ${(100 * part).toFixed(1)} % moves`] : [];
}

/** Folds that paper unfolds though they hold nothing but tables of detail. Runs in the page. */
export function unfoldedOnPaper() {
  const folds = [...document.querySelectorAll("#numbers, #settings, #rocking details")].filter((one) => !one.open);
  window.dispatchEvent(new Event("beforeprint"));
  const found = folds.filter((one) => one.open).map((one) => one.querySelector("summary").textContent);
  window.dispatchEvent(new Event("afterprint"));
  return found;
}

/** The gravity of a scene, m/s² along x and y, from the text of scene.toml as run. */
export function gravityOf(text) {
  const [, given] = text.match(/^gravity = (.*)$/m) ?? [];
  const numbers = (given ?? "9.81 m").match(/[-+.\de]+(?= m)/g).map(Number);
  return numbers.length > 1 ? numbers : [0, -numbers[0]];
}

/**
 * The slope on which a block stands in a row, rad: NaN where the ground turns, or its base reaches over more than one piece of a profile.
 */
function slopeUnder({ profile, incline }, ground, reach, x) {
  if (profile.length === 0) return incline;
  if (ground !== null) return NaN;
  const next = profile.findIndex(([at]) => at > x);
  if (next <= 0) return NaN;
  const [[x0, y0], [x1, y1]] = [profile[next - 1], profile[next]];
  return x - reach > x0 && x + reach < x1 ? Math.atan2(y1 - y0, x1 - x0) : NaN;
}

/**
 * Where the verdict isn't what the rows of trajectory.csv say, by the rules of docs/verdict.md; `data` is that of the page, of which the shapes of
 * the bodies are taken, and `pull` the gravity.
 */
export function wrongVerdicts(summary, trajectory, { scenery, frames }, pull) {
  const problems = [];
  const gravity = Math.hypot(...pull);
  // By how much gravity leans from the vertical: what it leans to is downhill.
  const leans = gravity > 0 ? Math.atan2(pull[0], -pull[1]) : 0;
  const [first, last] = [trajectory[0], trajectory[trajectory.length - 1]];
  const still = frames.ground === null;
  const turns = !still && frames.ground.slope.some((slope) => slope !== 0);
  for (const verdict of summary.verdict) {
    const { body } = verdict;
    const block = scenery.blocks.find(({ name }) => name === body);
    const at = (row, key) => row[`${body}.${key}`];
    const say = (text) => problems.push(`${body} ${verdict.what}: ${text}`);
    if (at(last, "phi") === undefined) {
      say("there are no columns of it");
      continue;
    }
    // From standing flat on what is below it, in parts of the way to the point of no return on that side, which is α from gravity.
    const slope = (row) => slopeUnder(scenery, frames.ground, block.reach, at(row, "x"));
    const share = (row, phi = at(row, "phi")) => {
      const [turned, uphill] = [phi - slope(row), slope(row) - leans];
      return turned > 0 ? turned / (block.alpha - uphill) : -turned / (block.alpha + uphill);
    };
    const stands = block.alpha !== null && share(trajectory[0]) < 1;
    // As far as can be known from the table: not where its base lies over a kink.
    const even = trajectory.every((row) => Number.isFinite(slope(row)));
    // What begins in free fall has a stance only from when it has settled, by which the rows before aren't measured.
    const [start, next] = trajectory;
    const falls = next !== undefined && at(next, "vy") - at(start, "vy") < -0.9 * gravity * (next.t - start.t);
    // What can touch nothing has no stance.
    const touches = summary.model.contacts.length > 0;
    if (!touches && verdict.max_phi_over_alpha !== null) say("it touches nothing, but has a largest φ/α");
    // On a beam it is measured from that, of which the table has no slope.
    const bends = summary.model.beams.length > 0;
    const level = touches && block.upright && stands && even && !falls && !turns;
    const beyond = (row) => share(row) > 1;
    if (level && !bends) {
      const most = largest(trajectory, (row) => share(row));
      // The table may lack the row of the largest angle.
      if (most > verdict.max_phi_over_alpha * (1 + 1e-9) + 1e-9) say(`rows reach ${most} α, it says ${verdict.max_phi_over_alpha}`);
      if (most < 0.98 * verdict.max_phi_over_alpha - 1e-3) say(`rows reach only ${most} α, it says ${verdict.max_phi_over_alpha}`);
    }
    if (level && verdict.what === "overturned") {
      if (!beyond(last)) say(`φ is within α at the end`);
      const way = at(last, "phi") > 0 ? "left" : "right";
      if (way !== verdict.way) say(`to the ${verdict.way}, but φ at the end is ${at(last, "phi")}`);
      const within = trajectory.findLastIndex((row) => !beyond(row));
      const [from, to] = [trajectory[within]?.t ?? first.t, trajectory[within + 1]?.t ?? last.t];
      const step = summary.dt.max ?? summary.dt;
      if (verdict.overturned_at < from - step || verdict.overturned_at > to + step) {
        say(`at ${verdict.overturned_at}, but the rows pass α between ${from} and ${to}`);
      }
    } else if (touches && block.upright && block.alpha !== null && Number.isFinite(slope(last)) && !turns && ["rests", "slid", "rocks"].includes(verdict.what)) {
      // What turned over in flight may be back on its base by whole turns, or lie on another side, as it then says.
      const around = at(last, "phi") - 2 * Math.PI * Math.round((at(last, "phi") - slope(last)) / (2 * Math.PI));
      const onBase = verdict.lies_on === "base" || (level && verdict.lies_on === null);
      if (onBase && share(last, around) > 1) say(`φ is beyond α at the end: ${at(last, "phi")}`);
    }
    // A rectangle as drawn, at rest: which side faces down.
    if (block.alpha !== null && block.upright && !turns) {
      const quarter = (at(last, "phi") - slope(last)) / (Math.PI / 2);
      const off = Math.abs(quarter - Math.round(quarter)) * 90;
      const side = ["base", "left side", "top", "right side"][((Math.round(quarter) % 4) + 4) % 4];
      if (verdict.rests_from === null ? verdict.lies_on !== null : off < 5 && verdict.lies_on !== side) {
        say(`lies on ${verdict.lies_on}, but φ at the end is ${at(last, "phi")}`);
      }
    }
    // Relative to ground that stands still, and to a beam or block only where nothing moves at all.
    const speed = (row) => Math.hypot(at(row, "vx"), at(row, "vy")) + block.reach * Math.abs(at(row, "omega"));
    const bound = Math.sqrt(gravity * block.reach) / 1000;
    if (still && verdict.rests_from !== null) {
      const moving = trajectory.find((row) => row.t > verdict.rests_from + 1e-12 && speed(row) > 1.01 * bound);
      if (moving && scenery.beams.length === 0 && !carried(scenery)) say(`rests from ${verdict.rests_from}, but moves at ${moving.t}`);
      if (last.t - verdict.rests_from < Math.sqrt(block.reach / gravity) * 0.99) say(`rests only from ${verdict.rests_from}`);
    }
    if (still && verdict.what === "rocks") {
      const window = trajectory.filter((row) => row.t >= last.t - 1.01 * Math.sqrt(block.reach / gravity));
      if (scenery.beams.length === 0 && !carried(scenery) && window.every((row) => speed(row) < 0.99 * bound)) say("but it rests at the end");
    }
  }
  return problems;
}

/** Whether blocks are prescribed, so that what stands on them rests in motion. */
const carried = (scenery) => scenery.blocks.some(({ driven }) => driven);

const factors = { k: 1e3, M: 1e6, G: 1e9, m: 1e-3, "µ": 1e-6, n: 1e-9, p: 1e-12, f: 1e-15, a: 1e-18, z: 1e-21 };
/** SI value of a unit as written on the page, such as mm or kN m. */
export function inSi(unit) {
  const first = unit.split(" ")[0];
  return first.length > 1 && factors[first[0]] && /^(m|N|J|Pa|s)$/.test(first.slice(1)) ? factors[first[0]] : 1;
}

/** Words of titles of plots for each quantity that a beam may record. */
const titles = {
  w: /deflection/i, moment: /moment/i, shear: /transverse|shear/i, stress: /stress/i,
  axial_force: /axial/i, reaction: /reaction/i, reaction_couple: /couple/i,
};

/** The value of a column at a time, linear between the rows. */
function valueAt(rows, name, t) {
  const k = Math.max(1, rows.findIndex((row) => row.t >= t - 1e-12));
  const [a, b] = [rows[k - 1], rows[k] ?? rows[k - 1]];
  const part = b.t > a.t ? Math.min(1, Math.max(0, (t - a.t) / (b.t - a.t))) : 0;
  return a[name] + part * (b[name] - a[name]);
}

/** What a column such as `table.moment@0.09` is of, and where; a body's name has no dot. */
const quantity = (name) => name.slice(name.indexOf(".") + 1).split("@");

/** Where in the run values are compared. */
const looks = [0.13, 0.4, 0.7, 1];

/** Columns of probes and supports that no plot shows: a plot of that quantity must have the column's values in its legend. */
export async function unplotted(page, trajectory) {
  const shown = [];
  for (const part of looks) {
    const [t, panels] = await page.evaluate(([fraction, rows]) => {
      const slider = document.getElementById("time-slider");
      const readout = document.getElementById("time-readout");
      // At a picture at which the table has a row, if one is near: what rings can't be had from its neighbours.
      const known = new Set(rows);
      const frame = Math.round(fraction * slider.max);
      for (let back = 0; back <= Math.min(50, frame); back++) {
        slider.value = frame - back;
        slider.dispatchEvent(new Event("input"));
        if (known.has(Number(readout.dataset.t).toPrecision(9))) break;
      }
      return [Number(document.getElementById("time-readout").dataset.t), [...document.querySelectorAll("#plots .panel")].map((panel) => ({
        title: panel.querySelector("h2, h3")?.textContent ?? "",
        unit: panel.dataset.unit ?? "",
        // Of a beam that nothing holds, which the table has as a whole.
        fromLine: panel.querySelector(".note")?.textContent.includes("from the line through the ends") ?? false,
        // Of what is pale behind a mean the value itself stands first.
        values: [...panel.querySelectorAll(".key b")].map((value) => Number(value.textContent.split(" (")[0].replace(/−/g, "-"))),
      }))];
    }, [part, trajectory.map((row) => row.t.toPrecision(9))]);
    shown.push({ t, panels });
  }
  const missing = [];
  for (const name of Object.keys(trajectory[0])) {
    const [what, place] = quantity(name);
    if (!(what in titles) || place === undefined) continue;
    if (what === "w" && shown[0].panels.some(({ fromLine }) => fromLine)) continue;
    const most = largest(trajectory, (row) => row[name]);
    // Rounding isn't drawn: also that of the largest of its kind, as of the moment at a free end.
    const kind = Object.keys(trajectory[0]).filter((other) => quantity(other)[0] === what);
    const greatest = Math.max(...kind.map((other) => largest(trajectory, (row) => row[other])));
    if (!(most > Math.max(1e-9, 1e-8 * greatest))) continue;
    // One curve, the same at all times; how its points are thinned may move it by little.
    const fits = (value, unit, t) => {
      const wanted = valueAt(trajectory, name, t);
      return Math.abs(value * inSi(unit) - wanted) <= 1e-2 * Math.abs(wanted) + 2e-3 * most;
    };
    const curves = shown[0].panels.flatMap(({ title, values }, panel) => (titles[what].test(title) ? values.map((_, curve) => [panel, curve]) : []));
    const found = curves.some(([panel, curve]) => shown.every(({ t, panels }) => fits(panels[panel].values[curve], panels[panel].unit, t)));
    if (!found) missing.push(`${name} is in no plot`);
  }
  return missing;
}
