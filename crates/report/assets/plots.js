// The plots: panels over one shared span of time, and the phase portrait.

const plots = (() => {
  const host = byId("plots");
  const margin = { left: 58, right: 22, top: 8, bottom: 22 };
  const panels = [];
  let view = [start, end];
  let now = start;
  let onSeek = () => {};
  let onZoom = () => {};

  /** A legend of more entries than this has columns, and is folded if an earlier one has its entries. */
  const many = 5;
  const legends = [];

  /** Where a legend of many entries belongs: into a fold with their values where an earlier plot has the same names for curves of the same colours
      and dashes. */
  function folded(keys, { title, portrait }, row) {
    const earlier = legends.find(({ strokes }) => keys.every((key) => strokes.get(key.label) === stroke(key)));
    if (!earlier) {
      legends.push({ title, strokes: new Map(keys.map((key) => [key.label, stroke(key)])) });
      return row;
    }
    const fold = htmlElement("details", "again", undefined, row);
    const summary = htmlElement("summary", "", `Curves as in “${earlier.title}”`, fold);
    htmlElement("span", "unfolds", `: ${portrait ? "names" : "values"}`, summary);
    return fold;
  }

  function head(panel, parent) {
    const row = htmlElement("div", "head", undefined, parent);
    const title = htmlElement("h3", "", `${panel.title} `, row);
    panel.offset = htmlElement("span", "offset", "", title);
    panel.unitText = htmlElement("span", "unit", panel.unit ? `(${panel.unit})` : "", title);
    const keys = panel.portrait && panel.series.length === 1 ? [] : panel.series.filter(({ raw }) => !raw);
    const isMany = keys.length > many && keys.every(({ upper }) => !upper);
    const legend = htmlElement("div", isMany ? "legend many" : "legend", undefined, isMany ? folded(keys, panel, row) : row);
    // Columns as wide as the longest name, which would break in a narrower one.
    if (isMany) legend.style.setProperty("--names", String(Math.min(30, Math.max(...keys.map(({ label }) => label.length)))));
    for (const series of keys) {
      const key = htmlElement("span", series.label ? "key" : "key bare", undefined, legend);
      const swatch = svgElement("svg", { viewBox: "0 0 18 8", "aria-hidden": "true" }, key);
      if (series.bars) svgElement("path", { d: "M5 0h8v8h-8z", style: `fill: ${colour(series.index)}` }, swatch);
      else if (series.upper) svgElement("path", { d: "M0 0h18v8h-18z", class: "area", style: `fill: ${colour(series.index)}; fill-opacity: ${series.inner ? 0.45 : 0.2}` }, swatch);
      else svgElement("path", { d: "M0 4h18", style: `${series.alone?.includes(true) ? solidStroke(series) : stroke(series) + offset(series)}`, "stroke-width": 2 }, swatch);
      if (series.label) key.append(series.label);
      series.readout = htmlElement("b", "", "", key);
    }
    if (panel.guides?.length) {
      // In the sight of all, as the other plot need not have it.
      panel.guideKey = htmlElement("span", "key", undefined, legend.closest(".again") ? row : legend);
      const swatch = svgElement("svg", { viewBox: "0 0 18 8", "aria-hidden": "true" }, panel.guideKey);
      svgElement("path", { d: "M0 4h18", class: "guide" }, swatch);
      panel.guideKey.append("critical angle");
    }
    for (const [letter, className, word] of panel.bands ? [["k", "stick", "stick"], ["l", "slip", "slip"], ["b", "briefly", "presses briefly"], ["o", "open", "open"]] : []) {
      // What never occurs needs no name.
      if (!panel.bands.some(({ state }) => state.includes(letter))) continue;
      const key = htmlElement("span", "key", undefined, legend);
      htmlElement("i", className, undefined, key);
      key.append(word);
    }
    // What the letters beside the bands stand for.
    for (const { short, name } of panel.bands?.filter((band) => band.name && band.name !== band.short) ?? []) {
      htmlElement("span", "key", `${short}: ${name}`, legend);
    }
    if (panel.tooMany) htmlElement("span", "coincide", `${panel.tooMany} curves coincide, wholly or in part`, row);
    // An enlarged plot stands below one that shows all.
    if (panel.cut && !panel.enlarged) {
      const toggle = htmlElement("button", "link", "", row);
      toggle.type = "button";
      // Of what rings the pale band is cut, not single peaks.
      const what = panel.series.some(({ raw }) => raw) ? "pale curves" : "peaks";
      const cut = `${what} cut, ${panel.cut.reach}`;
      // Paper has no buttons, but the same axis.
      const printed = htmlElement("span", "on-paper", "", row);
      const say = () => {
        toggle.textContent = panel.whole ? `cut the ${what}` : `${cut}: show all`;
        printed.textContent = panel.whole ? "" : cut;
      };
      toggle.addEventListener("click", () => {
        panel.whole = !panel.whole;
        say();
        drawPanel(panel);
      });
      say();
    }
  }

  /** Says beside the title what the labels of its axis leave out. */
  function sayReading(panel, { offset, power }) {
    panel.offset.textContent = offset ? `${offset} ` : "";
    const unit = unitWith(power, panel.unit);
    panel.unitText.textContent = unit ? `(${unit})` : "";
  }

  /** The dashes of a line on others, as in the figures: all have the same period, each half the dashes of the one below. */
  const over = (lines) => [10 / 2 ** lines, 10 - 10 / 2 ** lines];
  const stroke = (series) => `stroke: ${colour(series.index)}; stroke-dasharray: ${series.over ? over(series.over).join(" ") : series.inPart ? "4 3" : dash(series.index)}; fill: none`;
  const solidStroke = (series) => `stroke: ${colour(series.index)}; stroke-dasharray: ${dash(series.index)}; fill: none`;
  /** Of the sample of a line on others in a legend: from the middle of a dash on, as its gap would not be seen at an end. */
  const offset = (series) => (series.over ? `; stroke-dashoffset: ${over(series.over)[0] / 2}` : "");

  /** The largest value of a panel, by which its readouts have their decimals. */
  const largestOf = ({ series, cut }) => Math.min(cut?.limit ?? Infinity, series.reduce((most, { y, upper }) => [y, upper ?? []].reduce((largest, values) =>
    values.reduce((size, x) => Math.max(size, Math.abs(x ?? 0) || 0), largest), most), 0));

  /** On more others than this a line isn't dashed: its dashes would be too short to be seen; on none where some numbers are told apart by dashes, which would
      then mean either. */
  const mostOver = (series) => (series.some(({ index }) => index >= colours) ? 0 : 3);

  /** Of a dashed line, its values where it lies on none of the others, or is no other quantity, and beside that: there it is solid. */
  const alone = (series, values) => (series.over || series.inPart ? values.map((x, i) => (series.alone[i - 1] || series.alone[i] || series.alone[i + 1] ? x : null)) : null);

  /** Dashes a line that lies on earlier ones where it does, which then show in the gaps: within 1 % of what the panel shows, all along or for half of its length away from 0.
      Where too many lie on each other none is dashed, and the panel says how many they are. */
  function tellApart(panel) {
    const { series, cut } = panel;
    const finite = series.flatMap(({ y }) => y.filter((x) => x !== null && Number.isFinite(x)));
    const [low, high] = [...finite, ...(panel.floor === undefined ? [] : [panel.floor])]
      .reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
    const within = 0.01 * Math.min(Math.max(high - low, leastRange(low, high, panel.least ?? 0)), 2 * (cut?.limit ?? Infinity));
    const near = (a, b) => {
      if (a.t !== b.t || a.inPart || a.bars || a.upper || b.upper || a.raw !== b.raw || a.y.length !== b.y.length) return false;
      const same = a.y.map((x, i) => Math.abs(x - b.y[i]) <= within);
      const away = same.filter((_, i) => Math.abs(a.y[i]) > within);
      return same.every(Boolean) || (20 * away.length > same.length && 2 * away.filter(Boolean).length > away.length);
    };
    const group = series.map((_, k) => k);
    series.forEach((line, k) => {
      line.over = 0;
      series.slice(0, k).forEach((earlier, i) => {
        if (!near(line, earlier)) return;
        line.over = Math.max(line.over, earlier.over + 1);
        const [from, to] = [Math.max(group[k], group[i]), Math.min(group[k], group[i])];
        group.forEach((number, j) => { if (number === from) group[j] = to; });
      });
    });
    panel.tooMany = 0;
    for (const number of new Set(group)) {
      const own = series.filter((_, k) => group[k] === number);
      if (!own.some((line) => line.over > mostOver(series))) continue;
      panel.tooMany = Math.max(panel.tooMany, own.length);
      own.forEach((line) => { line.over = 0; });
    }
    series.forEach((line, k) => {
      const below = line.over ? series.slice(0, k).filter((earlier) => near(line, earlier)) : [];
      line.alone = line.over ? line.y.map((x, i) => x !== null && !below.some(({ y }) => Math.abs(x - y[i]) <= within)) : [];
    });
  }

  function add(panel) {
    panel.element = htmlElement("section", "panel", undefined, host);
    panel.element.id = `panel-${panel.id}`;
    panel.element.dataset.unit = panel.unit ?? "";
    // Of a line that is of two quantities the parts are known.
    for (const series of panel.series) series.inPart = !panel.portrait && series.turns !== undefined;
    if (!panel.portrait) tellApart(panel);
    for (const series of panel.series.filter(({ inPart }) => inPart || panel.portrait)) {
      series.alone = series.t.map((_, i) => (series.turns ?? []).filter((turn) => turn <= i).length % 2 === 1);
    }
    for (const series of panel.series.filter(({ stepped }) => stepped)) series.jumps = jumpsOf(series.y);
    panel.most = largestOf(panel);
    head(panel, panel.element);
    panel.svg = svgElement("svg", { class: "plot", role: "img", tabindex: 0, "aria-label": spoken.plot(panel) }, panel.element);
    panels.push(panel);
    if (!panel.portrait) listen(panel);
  }

  let paper = null;
  // Measured when all is drawn anew: to ask for it at each picture would cost a layout each time.
  let measured = 0;
  const width = () => paper ?? measured;
  const px = (t) => margin.left + ((t - view[0]) / (view[1] - view[0])) * (width() - margin.left - margin.right);
  const timeAt = (panel, event) => {
    const box = panel.svg.getBoundingClientRect();
    const part = ((event.clientX - box.left) * (width() / box.width) - margin.left) / (width() - margin.left - margin.right);
    return view[0] + Math.min(1, Math.max(0, part)) * (view[1] - view[0]);
  };

  /** Guides right beyond these ends, which would lie on the frame, or hardly outside of it. */
  const nearGuides = ({ guides = [] }, low, high) =>
    guides.filter((at) => (at < low && at > low - 0.1 * (high - low)) || (at > high && at < high + 0.1 * (high - low)));

  /** Lowest and highest of what is in view, with some room. */
  function range(panel) {
    let [low, high] = [Infinity, -Infinity];
    const see = (x) => {
      if (x === null || !Number.isFinite(x)) return;
      low = Math.min(low, x);
      high = Math.max(high, x);
    };
    for (const series of panel.series) {
      const from = indexAt(series.t, view[0]);
      for (let i = from; i < series.y.length && (i === from || series.t[i] <= view[1]); i++) {
        see(series.y[i]);
        if (series.upper) see(series.upper[i]);
      }
    }
    if (panel.floor !== undefined) see(panel.floor);
    nearGuides(panel, low, high).forEach(see);
    if (panel.cut && !panel.whole) [low, high] = [Math.max(low, -panel.cut.limit), Math.min(high, panel.cut.limit)];
    if (!(low <= high)) return [-1, 1];
    // What varies by less than that is still: its rounding is not for the eye.
    const lacking = Math.max(0, leastRange(low, high, panel.least) - (high - low)) / 2;
    const room = 0.07 * (high - low) + lacking;
    return [low - room, high + room];
  }

  /** Whether each mean jumps to the next one: by far more than the means beside them do. As figures draw them. */
  function jumpsOf(means) {
    const [low, high] = means.filter(Number.isFinite).reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    const change = (k) => (k < 0 || k + 1 >= means.length ? 0 : Math.abs(means[k + 1] - means[k]));
    return means.map((value, i) => value === null || means[i + 1] === null
      || (change(i) > 0.02 * (high - low) && change(i) > 4 * Math.max(change(i - 1), change(i + 1))));
  }

  function path(series, x, y) {
    let d = "";
    let pen = "M";
    const put = (a, b) => {
      if (!Number.isFinite(b)) {
        pen = "M";
        return;
      }
      d += `${pen}${a.toFixed(1)} ${Math.min(1e4, Math.max(-1e4, b)).toFixed(1)}`;
      pen = "L";
    };
    const from = Math.max(0, indexAt(series.t, view[0]) - 1);
    for (let i = from; i < series.y.length; i++) {
      const value = series.y[i] === null ? NaN : y(series.y[i]);
      if (series.stepped) {
        // Through the middles of the stretches: what changes slowly has no steps.
        const [left, right] = [x(series.t[i]), x(series.t[i + 1])];
        if (i === 0 || series.jumps[i - 1]) put(left, value);
        put((left + right) / 2, value);
        if (i + 1 === series.y.length || series.jumps[i]) put(right, value);
      } else {
        put(x(series.t[i]), value);
      }
      if (series.t[i] > view[1]) break;
    }
    return d;
  }

  /** The area between two lines. */
  function area(series, x, y) {
    const [from, to] = [Math.max(0, indexAt(series.t, view[0]) - 1), Math.min(series.t.length, indexAt(series.t, view[1]) + 2)];
    const points = (values) => values.slice(from, to).map((value, k) => `${x(series.t[from + k]).toFixed(1)} ${y(value).toFixed(1)}`);
    return `M${points(series.y).concat(points(series.upper).reverse()).join("L")}Z`;
  }

  /** Whether a curve goes up and down more often than once a pixel, by more than its width: it fills its range, as vibrations of a long run do. */
  function isDense(series, y) {
    const [from, to] = [indexAt(series.t, view[0]), indexAt(series.t, view[1])];
    let [turns, before] = [0, 0];
    for (let i = from + 1; i <= to; i++) {
      const step = y(series.y[i] ?? NaN) - y(series.y[i - 1] ?? NaN);
      if (!(Math.abs(step) > 2)) continue;
      if (step * before < 0) turns++;
      before = step;
    }
    return turns > width() - margin.left - margin.right;
  }

  /** Width of a bar of a stretch too short to be seen, px. */
  const thinnest = 2;

  /** Of what isn't but in some stretches of time, as impulses: a bar for each of these; those of several series over the same one stand beside each other. */
  function bars(series, all, x, y) {
    let d = "";
    for (let i = Math.max(0, indexAt(series.t, view[0])); i < series.y.length && series.t[i] <= view[1]; i++) {
      if (!(series.y[i] > 0)) continue;
      const sharing = all.filter((other) => other.y[i] > 0);
      const [from, to] = [x(series.t[i]), x(series.t[i + 1])];
      const wide = Math.max(thinnest, (to - from) / sharing.length);
      const left = (from + to) / 2 + (sharing.indexOf(series) - sharing.length / 2) * wide;
      d += `M${left.toFixed(1)} ${y(0).toFixed(1)}V${y(series.y[i]).toFixed(1)}h${wide.toFixed(1)}V${y(0).toFixed(1)}Z`;
    }
    return `<path class="bars" style="fill: ${colour(series.index)}" d="${d}"/>`;
  }

  function curve(series, x, y, all) {
    if (series.bars) return bars(series, all, x, y);
    if (series.upper) return `<path class="area" style="fill: ${colour(series.index)}" d="${area(series, x, y)}"/>`;
    const kind = `curve${series.raw ? " raw" : all.length > 1 && isDense(series, y) ? " dense" : ""}`;
    const solid = (series.over || series.inPart) && series.alone.includes(true)
      ? `<path class="${kind}" style="${solidStroke(series)}" d="${path({ ...series, y: alone(series, series.y) }, x, y)}"/>` : "";
    return `<path class="${kind}" style="${stroke(series)}" d="${path(series, x, y)}"/>${solid}`;
  }

  function axes(svg, size, xTicks, yTicks, x, y) {
    const [right, bottom] = [size.width - margin.right, size.height - margin.bottom];
    let grid = "";
    for (const { at, label } of yTicks) {
      const a = y(at).toFixed(1);
      grid += `<path class="gridline${at === 0 ? " zero" : ""}" d="M${margin.left} ${a}H${right}"/>`
        + `<text x="${margin.left - 7}" y="${(+a + 4).toFixed(1)}" text-anchor="end">${label}</text>`;
    }
    for (const { at, label } of xTicks) {
      const a = x(at).toFixed(1);
      // A wide label at the end of the axis stays in the plot.
      const middle = Math.min(+a, size.width - labelWidth(label) / 2).toFixed(1);
      grid += `<path class="axis" d="M${a} ${bottom}v4"/>`
        + `<text x="${middle}" y="${bottom + 16}" text-anchor="middle">${label}</text>`;
    }
    return grid + `<path class="axis" d="M${margin.left} ${margin.top}V${bottom}H${right}"/>`;
  }

  const timeTicks = () => {
    const [unit, factor] = timeUnit;
    const found = ticks(view[0] * factor, view[1] * factor, Math.max(3, Math.floor(width() / 90)), Infinity);
    for (const tick of found) tick.at /= factor;
    if (found.length) found[found.length - 1].label += ` ${unit}`;
    return found;
  };

  /** Impacts at the top of a panel: one by one, or where they are many how many about each time, by the length of a tick. */
  function impactMarks(panel) {
    const mark = (t, length) => `M${px(t).toFixed(1)} ${margin.top}v${length.toFixed(1)}`;
    const shown = data.impacts
      .filter(({ t, contact }) => t >= view[0] && t <= view[1] && (panel.contact ?? contact) === contact);
    const last = data.impacts.length ? data.impacts[data.impacts.length - 1].t : 0;
    const listed = data.impact_count <= data.impacts.length || view[1] <= last;
    if (!data.density || (listed && shown.length <= 60)) return shown.map(({ t }) => mark(t, 7)).join("");
    const { end, all, contacts } = data.density;
    const counts = panel.contact === undefined ? all : contacts[panel.contact] ?? [];
    const most = Math.max(1, ...counts);
    return counts
      .map((count, part) => ({ count, t: (part + 0.5) * end / counts.length }))
      .filter(({ count, t }) => count > 0 && t >= view[0] && t <= view[1])
      .map(({ count, t }) => mark(t, 9 * Math.sqrt(count / most))).join("");
  }

  /** Bands keep the height of their rows; of plots paper has five to a page, A4 or letter. */
  function heightOf(panel) {
    return paper && !panel.bands ? 0.78 * panel.height : panel.height;
  }

  function drawPanel(panel) {
    if (panel.portrait) {
      drawPortrait(panel);
      return;
    }
    const size = { width: width(), height: heightOf(panel) };
    const bottom = size.height - margin.bottom;
    const clip = `clip-${panel.id}`;
    setAll(panel.svg, { viewBox: `0 0 ${size.width} ${size.height}` });
    const inside = `<clipPath id="${clip}"><rect x="${margin.left}" y="${margin.top}" `
      + `width="${size.width - margin.left - margin.right}" height="${bottom - margin.top}"/></clipPath>`;
    const impacts = impactMarks(panel);
    let body;
    if (panel.bands) {
      body = bands(panel, size, clip);
    } else {
      const [low, most] = range(panel);
      // Curves stay below the ticks of impacts.
      const room = impacts ? 5 : 0;
      const high = most + (room / (bottom - margin.top - room)) * (most - low);
      const y = (value) => margin.top + ((high - value) / (high - low)) * (bottom - margin.top);
      const yTicks = ticks(low, high, Math.floor((bottom - margin.top) / 28));
      if (panel.guideKey) panel.guideKey.hidden = !panel.guides.some((at) => at >= low && at <= high);
      sayReading(panel, yTicks);
      body = axes(panel.svg, size, timeTicks(), yTicks, px, y)
        + `<g clip-path="url(#${clip})">`
        + (panel.guides ?? []).map((at) => `<path class="guide" d="M${margin.left} ${y(at).toFixed(1)}H${size.width}"/>`).join("")
        + panel.series.map((series) => curve(series, px, y, panel.series)).join("")
        + `<path class="impacts" d="${impacts}"/></g>`;
    }
    panel.svg.innerHTML = `${inside}${body}<path class="hover"/><text class="hover-time" text-anchor="middle"/><path class="cursor"/><rect class="selection"/>`;
    [panel.hover, panel.hoverTime, panel.cursor, panel.selection] = [".hover", ".hover-time", ".cursor", ".selection"].map((s) => panel.svg.querySelector(s));
    moveCursor(panel);
  }

  const rowHeight = 17;

  function bands(panel, size, clip) {
    let body = axes(panel.svg, size, timeTicks(), [], px, () => 0);
    panel.bands.forEach((band, row) => {
      const y = margin.top + rowHeight * row;
      // A name too long for the margin is smaller.
      const fits = Math.min(1, (margin.left - 9) / labelWidth(band.short));
      body += `<text x="${margin.left - 7}" y="${y + 10}" text-anchor="end"${fits < 1 ? ` style="font-size: ${(11.5 * fits).toFixed(1)}px"` : ""}>${band.short}</text><g clip-path="url(#${clip})">`;
      let from = 0;
      for (let i = 1; i <= band.state.length; i++) {
        if (i < band.state.length && band.state[i] === band.state[from]) continue;
        const [a, b] = [px(forces.borders[from]), px(forces.borders[i])];
        const name = { k: "stick", l: "slip", b: "briefly" }[band.state[from]];
        if (name && b >= margin.left && a <= size.width) {
          body += `<rect class="${name}" x="${a.toFixed(2)}" y="${y}" width="${Math.max(b - a, 1.2).toFixed(2)}" height="12"/>`;
        }
        from = i;
      }
      body += `</g><rect class="band" x="${margin.left}" y="${y}" width="${size.width - margin.left - margin.right}" height="12"/>`;
    });
    return body;
  }

  const portraitBottom = 38;

  function drawPortrait(panel) {
    const size = { width: width(), height: heightOf(panel) };
    const extent = (values, least) => {
      const finite = values.filter(Number.isFinite);
      const [low, high] = finite.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
      const room = 0.06 * (high - low) + Math.max(0, leastRange(low, high, least) - (high - low)) / 2;
      return low <= high ? [low - room, high + room] : [-1, 1];
    };
    const ofX = panel.series.flatMap((series) => series.x);
    const ends = ofX.filter(Number.isFinite).reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
    const [x0, x1] = extent(ofX.concat(nearGuides(panel, ...ends)), panel.leastX);
    const [y0, y1] = extent(panel.series.flatMap((series) => series.y), panel.least);
    const [right, bottom] = [size.width - margin.right, size.height - portraitBottom];
    const x = (value) => margin.left + ((value - x0) / (x1 - x0)) * (right - margin.left);
    const y = (value) => margin.top + ((y1 - value) / (y1 - y0)) * (bottom - margin.top);
    const curve = (series, from, to, values = series.y) => {
      let [d, pen] = ["", "M"];
      for (let i = from; i < to; i++) {
        if (values[i] !== null) d += `${pen}${x(series.x[i]).toFixed(1)} ${y(values[i]).toFixed(1)}`;
        pen = values[i] === null ? "M" : "L";
      }
      return d;
    };
    const curves = (series, from, to, faint = "") => {
      const solid = series.over ? `<path class="curve${faint}" style="${solidStroke(series)}" d="${curve(series, from, to, alone(series, series.y))}"/>` : "";
      return `<path class="curve${faint}" style="${stroke(series)}" d="${curve(series, from, to)}"/>${solid}`;
    };
    const whole = view[0] <= start && view[1] >= end;
    setAll(panel.svg, { viewBox: `0 0 ${size.width} ${size.height}` });
    const frameless = { width: size.width, height: size.height - portraitBottom + margin.bottom };
    const [xTicks, yTicks] = [ticks(x0, x1, Math.max(4, Math.floor(size.width / 90))), ticks(y0, y1, 6)];
    sayReading(panel, yTicks);
    if (panel.guideKey) panel.guideKey.hidden = !panel.guides.some((at) => at > x0 && at < x1);
    const xLabel = `${panel.xName}${xTicks.offset ? ` ${xTicks.offset}` : ""} (${unitWith(xTicks.power, panel.xUnit)})`;
    panel.svg.innerHTML = axes(panel.svg, frameless, xTicks, yTicks, x, y)
      + `<text x="${(margin.left + right) / 2}" y="${size.height - 5}" text-anchor="middle">${xLabel}</text>`
      + panel.guides.filter((at) => at > x0 && at < x1)
        .map((at) => `<path class="guide" d="M${x(at).toFixed(1)} ${margin.top}V${bottom}"/>`).join("")
      + panel.series.map((series) => {
        const [from, to] = [indexAt(series.t, view[0]), indexAt(series.t, view[1]) + 1];
        const faint = whole ? "" : curves(series, 0, series.t.length, " faint");
        // Of hundreds of turns a few are strong; zoomed in, all that is in view.
        const [first, last] = whole ? series.strong ?? [from, to] : [from, to];
        const pale = [[from, first + 1], [last - 1, to]].filter(([a, b]) => b - a > 1 && b - a < to - from)
          .map(([a, b]) => curves(series, a, b, " faint")).join("");
        return `${faint}${pale}${curves(series, first, last)}`;
      }).join("");
    panel.dots = panel.series.map((series) => svgElement("circle", { r: 4.5, style: `fill: ${colour(series.index)}` }, panel.svg));
    panel.place = (series, t) => [x(valueAt({ t: series.t, y: series.x }, t)), y(valueAt(series, t))];
    moveCursor(panel);
  }

  function moveCursor(panel) {
    if (panel.portrait) {
      panel.series.forEach((series, k) => {
        const [cx, cy] = panel.place(series, now);
        if (Number.isFinite(cx + cy)) setAll(panel.dots[k], { cx: cx.toFixed(1), cy: cy.toFixed(1) });
      });
      return;
    }
    const inView = now >= view[0] && now <= view[1];
    const at = px(now).toFixed(1);
    panel.cursor.setAttribute("d", inView ? `M${at} ${margin.top}V${heightOf(panel) - margin.bottom}` : "M0 0");
  }

  /** The value of a series at a time: at that of a picture the one that is known there. Where a curve shows the extremes of many steps, `t` is that of one. */
  function read(series, t) {
    const nearest = frameAt(t);
    const picture = curves.thinned || times[nearest] === t ? nearest : -1;
    return series.known?.has(picture) ? series.known.get(picture) : valueAt(series, t);
  }

  function readOut(t) {
    for (const panel of panels.filter((one) => !one.portrait)) {
      for (const series of panel.series.filter(({ raw }) => !raw)) {
        const shown = (value) => readout(value !== null && Math.abs(value) < 1e-2 * panel.least ? 0 : value, panel.most, series.upper ? 3 : 4);
        // The value itself is that of the pale curve: a mean at the start is not what the run starts with.
        const pale = panel.series.find(({ raw, index }) => raw && index === series.index);
        const own = shown(read(series, t));
        const value = pale ? `${shown(read(pale, t))} (${own})` : own;
        series.readout.textContent = series.upper ? `${value} … ${shown(valueAt({ t: series.t, y: series.upper }, t))}` : value;
      }
    }
  }

  /** Shows values at a time in all plots, and that time at its line in the one under the pointer. */
  function hoverAt(pointed, under) {
    const t = pointed !== null && curves.thinned ? times[frameAt(pointed)] : pointed;
    for (const panel of panels.filter((one) => !one.portrait)) {
      panel.hoverTime.textContent = panel === under && t !== null ? pointedTime(t) : "";
      if (panel === under && t !== null) {
        const half = labelWidth(panel.hoverTime.textContent) / 2 + 3;
        const middle = Math.min(width() - margin.right - half, Math.max(margin.left + half, px(t)));
        setAll(panel.hoverTime, { x: middle.toFixed(1), y: heightOf(panel) - margin.bottom - 5 });
      }
      const d = t === null ? "M0 0" : `M${px(t).toFixed(1)} ${margin.top}V${heightOf(panel) - margin.bottom}`;
      panel.hover.setAttribute("d", d);
    }
    readOut(t ?? now);
  }

  /** A time under the pointer, as fine as a pixel shows it, or as steps are long. */
  function pointedTime(t) {
    const [unit, factor] = timeUnit;
    const finest = Math.max(data.dt, (view[1] - view[0]) / width()) * factor;
    return `${t === start ? "0" : (t * factor).toFixed(Math.min(9, Math.max(0, Math.ceil(-Math.log10(finest)))))} ${unit}`;
  }

  function listen(panel) {
    let from = null;
    const select = (a, b) => {
      const [left, right] = [px(Math.min(a, b)), px(Math.max(a, b))];
      setAll(panel.selection, {
        x: left, y: margin.top, width: Math.max(0, right - left), height: heightOf(panel) - margin.top - margin.bottom,
      });
    };
    panel.svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      from = { t: timeAt(panel, event), x: event.clientX };
      panel.svg.setPointerCapture(event.pointerId);
    });
    panel.svg.addEventListener("pointermove", (event) => {
      const t = timeAt(panel, event);
      hoverAt(t, panel);
      if (from && Math.abs(event.clientX - from.x) > 4) select(from.t, t);
    });
    panel.svg.addEventListener("pointerup", (event) => {
      if (!from) return;
      const [a, b] = [from.t, timeAt(panel, event)];
      const dragged = Math.abs(event.clientX - from.x) > 4;
      from = null;
      select(a, a);
      if (dragged) zoom(Math.min(a, b), Math.max(a, b));
      else onSeek(b);
    });
    panel.svg.addEventListener("pointercancel", () => {
      from = null;
      select(view[0], view[0]);
    });
    panel.svg.addEventListener("pointerleave", () => hoverAt(null));
    panel.svg.addEventListener("dblclick", () => zoom(start, end));
  }

  function zoom(a, b) {
    // Closer than a few steps there is nothing more to see.
    const least = Math.min(end - start, 5 * data.dt);
    const middle = (a + b) / 2;
    const half = Math.max(b - a, least) / 2;
    view = [Math.max(start, middle - half), Math.min(end, middle + half)];
    redraw();
    onZoom(view[0] > start || view[1] < end);
  }

  function redraw() {
    measured = Math.max(200, host.clientWidth);
    panels.forEach(drawPanel);
    readOut(now);
  }

  /** Marks the legends that paper doesn't need, where names have no values: those whose curves, or states, legends above them name. */
  function foldLegends() {
    let above = new Map();
    for (const { element, series, bands, guideKey } of panels.filter((panel) => !panel.element.hidden)) {
      const legend = element.querySelector(".legend");
      if (!legend) continue;
      const keys = bands ? [...legend.querySelectorAll(".key")].map((key) => [key.textContent, key.querySelector("i")?.className ?? ""])
        : series.filter(({ raw, label }) => !raw && label).map(({ label, index }) => [label, index]);
      if (guideKey) keys.push(["critical angle", guideKey.hidden ? "" : "guide"]);
      if (!keys.length) continue;
      const isSaid = keys.every(([name, how]) => above.get(name) === how);
      legend.classList.toggle("said", isSaid);
      if (isSaid) continue;
      // What gets another name here is no longer known by its old one.
      above = new Map([...above].filter(([, how]) => !keys.some(([, own]) => own === how)).concat(keys));
    }
  }

  /** Shows the panels of these contacts, hides those of the others. */
  function choose(...contacts) {
    for (const panel of panels) panel.element.hidden = panel.contact !== undefined && !contacts.includes(panel.contact);
  }

  return {
    drawFor(wanted) {
      paper = wanted;
      foldLegends();
      redraw();
    },
    choose, add, redraw, rowHeight, margin, zoom,
    zoomBy(factor) {
      const half = ((view[1] - view[0]) * factor) / 2;
      const centre = Math.min(end - half, Math.max(start + half, now));
      if (half * 2 >= end - start) zoom(start, end);
      else zoom(centre - half, centre + half);
    },
    showTime(t) {
      now = t;
      panels.forEach(moveCursor);
      readOut(t);
    },
    onSeek(f) { onSeek = f; },
    onZoom(f) { onZoom = f; },
  };
})();
