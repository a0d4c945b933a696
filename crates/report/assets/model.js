// The data of the run, and how its numbers are read and written.

const data = JSON.parse(document.getElementById("data").textContent);
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

/** The links of the network in a picture: number of the pair, force, and place in the first body's coordinates. */
function linksOf(picture) {
  const numbers = unpacked(network.links[picture]);
  const links = [];
  let pair = 0;
  while (numbers.more()) {
    pair += numbers.next();
    const force = (numbers.next() / 4095) * network.largest[picture];
    const reach = scenery.blocks[network.pairs[pair][0]].reach / 1000;
    links.push({ pair, force, x: numbers.signed() * reach, y: numbers.signed() * reach });
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
  const text = size < 1e-4 || size >= 1e6 ? x.toExponential(digits - 1) : plain;
  return text.replace(/-/g, "−");
}

/** A number of an axis: with as many decimals as its step asks for, with a power of ten where those are too many. */
function fixed(x, step) {
  if (Math.abs(x) < 1e-9 * step) return "0";
  if (step < 1e-4 || step >= 1e5) {
    return x.toExponential(Math.max(0, Math.floor(Math.log10(Math.abs(x) / step) + 1e-9))).replace("e+", "e").replace(/-/g, "−");
  }
  const decimals = Math.min(12, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  const text = x.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text.replace("-", "−");
}

/** Multiples of 1, 2 or 5 · 10ⁿ in a range, about `count` of them, with their labels. */
function ticks(low, high, count) {
  const raw = (high - low) / count;
  if (!(raw > 0) || !Number.isFinite(raw)) return [];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= 0.7 * raw);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
    found.push({ at: k * step, label: fixed(k * step, step) });
  }
  return found;
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

const colour = (index) => `var(--c${index % 7})`;
const dash = (index) => ["none", "6 3", "2 2.5"][Math.floor(index / 7) % 3];
