// The data of the run, and how its numbers are read and written.

const data = JSON.parse(document.getElementById("data").textContent, unpackedColumn);
const { scenery, frames, curves, forces, network, crowd } = data;
const times = frames.t;
const start = times[0];
const end = Math.max(times[times.length - 1], start + 1e-12);
const degrees = 180 / Math.PI;

/** Reads whole numbers from text: base64 of seven bits a byte, lowest first. */
function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  let at = 0;
  const next = () => {
    let [x, factor, byte] = [0, 1, 0];
    do {
      byte = bytes[at++];
      x += (byte & 127) * factor;
      factor *= 128;
    } while (byte > 127);
    return x;
  };
  const signed = () => {
    const x = next();
    return x % 2 ? -(x + 1) / 2 : x / 2;
  };
  return { next, signed, more: () => at < bytes.length };
}

/** A column of numbers where JSON has one packed: whole multiples of a unit as differences of an order, 0 for null. */
function unpackedColumn(_, value) {
  if (typeof value?.packed !== "string") return value;
  const { unit, order, packed } = value;
  const numbers = unpacked(packed);
  const column = [];
  let [before, now] = [0, 0];
  while (numbers.more()) {
    const x = numbers.next() - 1;
    if (x < 0) {
      column.push(null);
      continue;
    }
    const difference = x % 2 ? -(x + 1) / 2 : x / 2;
    [before, now] = [now, difference + now + (order === 2 ? now - before : 0)];
    column.push(now * unit);
  }
  return column;
}

if (frames.packed) {
  const { length, angle } = frames.packed;
  frames.blocks = frames.packed.blocks.map((text) => {
    const numbers = unpacked(text);
    const column = (unit) => {
      let now = 0;
      return Float64Array.from(times, () => {
        now += numbers.signed();
        return now * unit;
      });
    };
    return { x: column(length), y: column(length), phi: column(angle) };
  });
}

for (const [k, beam] of frames.beams.entries()) {
  const { points } = scenery.beams[k];
  const numbers = unpacked(beam.w);
  beam.w = new Float64Array(points * times.length);
  for (let i = 0, before = 0, now = 0; i < beam.w.length; i++) {
    if (i % points === 0) [before, now] = [0, 0];
    [before, now] = [now, numbers.signed() + 2 * now - before];
    beam.w[i] = now;
  }
}

/** The links of the network in a picture: number of the pair, force, and place in the first body's coordinates; and whether the force goes on straight
    through the first body, and through the other. */
function linksOf(picture) {
  const numbers = unpacked(network.links[picture]);
  const links = [];
  let pair = 0;
  while (numbers.more()) {
    const first = numbers.next();
    pair += Math.floor(first / 4);
    const force = (numbers.next() / 4095) * network.largest[picture];
    const reach = scenery.blocks[network.pairs[pair][0]].reach / 1000;
    links.push({ pair, force, x: numbers.signed() * reach, y: numbers.signed() * reach, through: [first % 2 === 1, first % 4 > 1] });
  }
  return links;
}

const byId = (id) => document.getElementById(id);

/** An SVG element with attributes, appended to a parent. */
function svgElement(name, attributes, parent) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  setAll(element, attributes);
  if (parent) parent.append(element);
  return element;
}

/** An HTML element with a class and text, appended to a parent. */
function htmlElement(name, className, text, parent) {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

function setAll(element, attributes) {
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
}

/** A number with few digits; powers of ten only where it must be. */
function number(x, digits = 4) {
  if (x === null || !Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  const plain = size >= 10 ** digits ? x.toFixed(0) : x.toPrecision(digits);
  if (size >= 1e-4 && size < 1e6) return plain.replace("-", "−");
  const [factor, power] = x.toExponential(digits - 1).split("e");
  return `${factor.replace("-", "−")} × ${powerOfTen(Number(power))}`;
}

/** A number beside a plot whose largest value is `most`: with few digits, and no more decimals than tell a hundred-thousandth of that. */
function readout(x, most, digits = 4) {
  if (x === null || !Number.isFinite(x) || !(most >= 1e-3) || Math.abs(x) >= 1e6) return number(x, digits);
  const decimals = Math.max(0, 5 - Math.ceil(Math.log10(most)));
  const size = Math.abs(x);
  const own = size > 0 ? digits - 1 - Math.floor(Math.log10(size)) : 0;
  const text = x.toFixed(Math.min(12, Math.max(0, Math.min(own, decimals))));
  return Number(text) === 0 ? "0" : text.replace("-", "−");
}

/** A quantity with three digits and the prefix that suits. */
function withPrefix(x, unit) {
  const prefixes = [["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12]];
  const [prefix, size] = prefixes.find(([, least]) => Math.abs(Number(x.toPrecision(3))) >= least) ?? ["", 1];
  return `${number(Number((x / size).toPrecision(3)), 3).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "")} ${prefix}${unit}`;
}

/** A number of an axis: with as many decimals as its step asks for. */
function fixed(x, step) {
  if (Math.abs(x) < 1e-9 * step) return "0";
  const decimals = Math.min(12, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  const text = x.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text.replace("-", "−");
}

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";
/** 10ⁿ. */
const powerOfTen = (n) => `10${String(n).replace(/\d/g, (digit) => superscripts[digit]).replace("-", "⁻")}`;

/** About how wide the label of an axis is, px. */
const labelWidth = (label) => 7 * label.replace(/[.  ]/g, "").length + 3.5 * (label.match(/[.  ]/g) ?? []).length;

/** Labels of a y axis that aren't wider than this stand beside it, px. */
const widestLabel = 46;

/**
 * Multiples of 1, 2 or 5 · 10ⁿ in a range, about `count` of them, with their labels. Digits that the values share and powers of
 * ten are left out where labels would be wider than `widest`: the value is `offset` plus the label times `power` of ten. As in
 * the figures, whose rule is that of teeter-plot.
 */
function ticks(low, high, count, widest = widestLabel) {
  const found = Object.assign([], { offset: "", power: 0 });
  const raw = (high - low) / count;
  if (!(raw > 0) || !Number.isFinite(raw)) return found;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const step = decade * [1, 2, 5, 10].find((factor) => factor * decade >= 0.7 * raw);
  const [first, last] = [Math.ceil(low / step - 1e-9), Math.floor(high / step + 1e-9)];
  const labels = (from, power) => Array.from({ length: last - first + 1 }, (_, k) => fixed((first + k - from) * step / 10 ** power, step / 10 ** power));
  const fit = (texts) => step >= 1e-4 && step < 1e5 && texts.every((text) => labelWidth(text) <= widest);
  let texts = labels(0, 0);
  if (!fit(texts)) {
    let from = 0;
    if (Math.max(Math.abs(low), Math.abs(high)) > 100 * (high - low)) {
      const round = 10 ** Math.ceil(Math.log10(high - low));
      const digits = Math.round((low + high) / 2 / round);
      from = Math.round((digits * round) / step);
      found.offset = `${digits < 0 ? "+" : "−"} ${shared(Math.abs(digits), round)}`;
      texts = labels(from, 0);
    }
    if (!fit(texts)) {
      const most = Math.max(1, Math.abs(first - from), Math.abs(last - from)) * step;
      found.power = 3 * Math.floor(Math.log10(most) / 3 + 1e-9);
      texts = labels(from, found.power);
    }
  }
  texts.forEach((label, k) => found.push({ at: (first + k) * step, label }));
  return found;
}

/** Digits that the values of an axis share, times the power of ten that they are counted in. */
function shared(digits, round) {
  const value = digits * round;
  if (value >= 1e-4 && value < 1e7) return fixed(value, round);
  const [mantissa, power] = value.toExponential(Math.max(0, Math.floor(Math.log10(digits) + 1e-9))).split("e");
  return `${mantissa} · ${powerOfTen(Number(power))}`;
}

/** The unit of an axis, with the power of ten that its labels leave out. */
const unitWith = (power, unit) => [power ? powerOfTen(power) : "", unit].filter(Boolean).join(" ");

/** The unit of times over the whole run, and what seconds are multiplied by: as in the figures. */
const timeUnit = [["s", 1], ["ms", 1e3], ["µs", 1e6]].find(([, factor]) => (end - start) * factor >= 0.099) ?? ["ns", 1e9];

/** A constant curve varies by less than this part of its size, and then has this part of it as room above and below. */
const [constantPart, constantRoom] = [1e-9, 0.1];

/** Least range of an axis: what varies by less than `least` is still, and what is constant is seen as that. */
function leastRange(low, high, least) {
  const largest = Math.max(Math.abs(low), Math.abs(high));
  return high - low > constantPart * largest ? least : Math.max(least, 2 * constantRoom * largest);
}

/** The last index whose value is at most `x`, 0 before the first. */
function indexAt(values, x) {
  let low = 0;
  let high = values.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle;
    else high = middle;
  }
  return low;
}

/** The frame nearest to a time. */
function frameAt(t) {
  const i = indexAt(times, t);
  return i + 1 < times.length && times[i + 1] - t < t - times[i] ? i + 1 : i;
}

/** The value of a series at a time: of a stepped one in its bucket, of any other linear between points. */
function valueAt(series, t) {
  if (series.stepped) {
    // A border belongs to the bucket that ends there: the frame shows what led to it.
    let i = indexAt(series.t, t);
    if (i > 0 && series.t[i] >= t) i--;
    return series.y[Math.min(i, series.y.length - 1)];
  }
  const i = indexAt(series.t, t);
  if (i + 1 >= series.t.length || series.t[i + 1] <= series.t[i]) return series.y[i];
  const part = Math.min(1, Math.max(0, (t - series.t[i]) / (series.t[i + 1] - series.t[i])));
  return series.y[i] + part * (series.y[i + 1] - series.y[i]);
}

/** The deflection of a beam at a place of its own, in a frame. */
function deflection(beam, frame, x) {
  const { points, span } = scenery.beams[beam];
  const { unit, w } = frames.beams[beam];
  const position = Math.min(points - 1, Math.max(0, (x / span) * (points - 1)));
  const i = Math.min(points - 2, Math.floor(position));
  const first = frame * points + i;
  return unit * (w[first] + (position - i) * (w[first + 1] - w[first]));
}

/** So many curves have a colour each; beyond, they also have dashes. */
const colours = 7;
const colour = (index) => `var(--c${index % colours})`;
const dash = (index) => ["none", "6 3", "2 2.5"][Math.floor(index / colours) % 3];
