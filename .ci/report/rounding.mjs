// No plot of mere rounding: what each plot of a run's page draws, against the scale of its quantity.
//
// The rule and its scales are those of docs/report.md; they are worked out here anew, from the outlines of the bodies, the spans and
// the tables of the run, so that a mistake in the program's own rule is seen.

import { signed, wholeNumbers } from "./columns.mjs";
import { inSi } from "./motion.mjs";

/** The part of its scale below which a quantity is rounding. */
const rounding = 1e-8;
/** Numbers of the page have some seven digits. */
const digits = 1 - 1e-6;

const finite = (values) => values.filter((x) => x !== null && Number.isFinite(x));
/** The largest size among values. */
const largest = (values) => finite(values).reduce((most, x) => Math.max(most, Math.abs(x)), 0);
/** How far values go from the first. */
const travel = (values) => largest(values.map((x) => x - values[0]));
const all = (series, pick) => largest(series.map(pick));

const angleUnits = { "°": Math.PI / 180, rad: 1, mrad: 1e-3 };
const lengthUnits = { km: 1e3, m: 1, cm: 1e-2, mm: 1e-3, "µm": 1e-6, nm: 1e-9 };
/** SI value of a unit of a plot. */
const si = (unit) => angleUnits[unit] ?? lengthUnits[unit] ?? inSi(unit);
/** The unit in brackets at the end of the name of an axis. */
const unitOf = (label) => label.match(/\(([^()]*)\)$/)?.[1] ?? "";

/** Deflections of a beam in its pictures, in units of its own: second differences along the span; each picture begins anew. */
function deflections(text, points) {
  return wholeNumbers(text).map(signed).reduce((w, difference, i) => {
    const [one, two] = [1, 2].map((back) => (i % points < back ? 0 : w[i - back]));
    w.push(difference + 2 * one - two);
    return w;
  }, []);
}

/**
 * Plots whose content is below the rounding of its scale. `drawn`: ids of the plots on the page; `data`: what its script draws;
 * `envelopes`: rows of envelopes.csv, if there are.
 */
export function plotsOfRounding(drawn, data, summary, envelopes) {
  const { scenery, forces } = data;
  const problems = [];
  const require = (id, what, content, scale) => {
    if (!(content >= rounding * scale * digits && content > 0)) problems.push(`plot ${id}: ${what} of ${content}, which is rounding beside ${scale}`);
  };
  const reach = ({ corners, reach: round }) => corners.reduce((most, [x, y]) => Math.max(most, Math.hypot(x, y)), 0) || round;
  const span = all(scenery.beams, (beam) => beam.span);
  const points = (key) => all(forces.points, (point) => largest(point[key]));
  const contactForce = Math.max(points("normal"), points("tangential"));
  const section = Object.fromEntries(data.panels.filter(({ id }) => id.startsWith("section-"))
    .map(({ id, unit, series }) => [id, inSi(unit) * all(series, ({ y }) => largest(y))]));
  const beamForce = Math.max(...["shear", "axial_force", "reaction"].map((what) => section[`section-${what}`] ?? 0));
  const beamMoment = Math.max(...["moment", "reaction_couple"].map((what) => section[`section-${what}`] ?? 0));
  const force = Math.max(beamForce, span > 0 ? beamMoment / span : 0);
  const moment = Math.max(beamMoment, force * span);
  const bodies = Object.fromEntries(data.panels.filter(({ id }) => ["x", "y", "phi", "phi_rolling"].includes(id))
    .map(({ id, series }) => [id, series.map(({ index }) => index).join()]));

  const overTime = (panel) => {
    const { id, series } = panel;
    const unit = si(panel.unit);
    const each = (what, scale, measure = largest) =>
      series.forEach(({ label, index, y }) => require(id, `${what} ${label}`, unit * measure(y), scale(index)));
    if (id === "phi" || id === "phi_rolling") each("turn", () => 1, travel);
    else if (id === "x" || id === "y") each("travel", (block) => reach(scenery.blocks[block]), travel);
    else if (["vx", "vy", "omega", "omega_rolling"].includes(id)) {
      // Drawn with its coordinate, of the same bodies.
      const coordinate = { vx: "x", vy: "y", omega: "phi", omega_rolling: "phi_rolling" }[id];
      if (bodies[coordinate] !== series.map(({ index }) => index).join()) problems.push(`plot ${id} is of bodies that the plot ${coordinate} doesn't have`);
    } else if (id === "w_mid") each("deflection", () => 1e-3 * Math.min(...scenery.beams.map((beam) => beam.span)));
    else if (/^ground(_v|_a)?(_phi)?$/.test(id)) each("prescribed motion", () => 0);
    else if (id.startsWith("slip-")) each("slip", () => reach(scenery.blocks[scenery.contacts[panel.contact].block]));
    else if (["section-moment", "section-reaction_couple"].includes(id)) each("moment", () => moment);
    else if (["section-shear", "section-axial_force", "section-reaction"].includes(id)) each("force", () => force);
    else if (id === "section-stress") each("stress", () => section[id]);
    // The scale of the summary adds up what the rule takes the largest of: three energies.
    else if (/^(energy|works)(-\d+)?$/.test(id)) each("energy", () => summary.energy.scale / 3);
    else problems.push(`plot ${id}: no scale is known for it`);
  };
  const impulses = (points) => all(points, (point) => largest(point.impacts ?? []));
  const ofContact = (id, contact, what) => {
    const key = what === "tangential" ? "tangential" : "normal";
    const own = forces.points.filter((point) => point.contact === contact);
    const impulse = impulses(own);
    if (what === "impacts") return require(id, "normal impulse", impulse, impulses(forces.points));
    // The state of a contact without forces between its impacts is told by these.
    if (what === "state" && impulse > 0 && forces.forceless?.includes(contact)) return undefined;
    return require(id, `${key} force`, all(own, (point) => largest(point[key])), contactForce);
  };
  const portrait = ({ id, x_label: label, series }) => series.forEach(({ label: name, index, x }) =>
    require(id, `motion ${name}`, si(unitOf(label)) * travel(x), id === "phase" ? 1 : reach(scenery.blocks[index])));
  const crowd = (id) => {
    const far = data.crowd[id === "distance" ? "distances" : "turns"].bands.reduce((most, band) => Math.max(most, largest(band)), 0);
    require(id, "largest motion", far, id === "distance" ? Math.max(...scenery.blocks.map(reach)) : 1);
  };
  const overSpan = {
    shapes: () => require("shapes", "deflection", all(data.frames.beams.map(({ unit, w }, k) => unit * largest(deflections(w, scenery.beams[k].points))), (w) => w), 1e-3 * Math.min(...scenery.beams.map((beam) => beam.span))),
    envelopes: () => {
      const most = (what) => all(envelopes, (row) => all(Object.keys(row).filter((name) => name.startsWith(what)), (name) => row[name]));
      require("envelopes", "moment or force", Math.max(most("moment"), most("shear") * span), 0);
    },
  };

  for (const id of drawn) {
    const panel = data.panels.find((one) => one.id === id);
    const [, what, number] = id.match(/^(normal|enlarged|tangential|state|impacts)-(\d+)$/) ?? [];
    if (panel) overTime(panel);
    else if (data.portraits.some((one) => one.id === id)) portrait(data.portraits.find((one) => one.id === id));
    else if (what) ofContact(id, Number(number), what);
    else if (data.crowd && ["distance", "phi", "omega"].includes(id)) crowd(id);
    else if (id in overSpan) overSpan[id]();
    else problems.push(`plot ${id}: no scale is known for it`);
  }
  return problems;
}

/** Ids of the plots that the page shows of the motion, but records and drawings of the scene. */
export async function plotsDrawn(page) {
  return page.evaluate(() => [...document.querySelectorAll("#plots .panel")].map(({ id }) => id.replace(/^panel-/, ""))
    .concat(["shapes", "envelopes"].filter((id) => document.getElementById(id)?.querySelector("svg"))));
}
