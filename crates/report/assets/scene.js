// The moving picture. An exaggerated deflection takes the blocks with it: each bottom corner keeps its true distance from
// the beam, so that what touches is seen to touch.

const scene = (() => {
  const root = byId("scene");
  const padding = { left: 26, right: 26, top: 16, bottom: 78 };
  const layers = {};
  let width = 0;
  let height = 0;
  let exaggeration = 1;
  let view = { x: 0, y: 0, scale: 1 };
  let frame = 0;
  let onView = () => {};
  let remembered = 0;
  const crowded = crowd !== undefined;
  /** How contact forces are drawn: not at all, by arrows or as a network. */
  let drawn = "arrows";

  /** The blocks that the plots name, with the numbers of their colours. */
  function colouredBlocks() {
    const named = new Map();
    [...crowd.distances.chosen, ...crowd.turns.chosen].forEach((k) => named.has(k) || named.set(k, named.size + 1));
    return named;
  }

  /** The beam that a block may stand on: of several, the one below it. */
  const beamsOf = scenery.blocks.map((_, block) =>
    scenery.contacts.filter((contact) => contact.block === block && contact.beam !== null && !contact.lower)
      .map((contact) => contact.beam));

  /** How far a beam has moved as a whole. */
  function moved(beam, at) {
    const way = frames.beams[beam].moved;
    return way ? [way[0][at], way[1][at]] : [0, 0];
  }

  /** The left end of a beam. */
  const leftOf = (beam, at) => scenery.beams[beam].x + moved(beam, at)[0];

  /** The ground: a point of it, and its slope. */
  function groundAt(at) {
    const { ground } = frames;
    return ground ? { x: ground.x[at], y: ground.y[at], slope: ground.slope[at] } : { x: 0, y: 0, slope: scenery.incline };
  }

  function lift(block, at, x) {
    const under = beamsOf[block].find((k) => x >= leftOf(k, at) && x <= leftOf(k, at) + scenery.beams[k].span);
    const beam = under ?? beamsOf[block][0];
    return beam === undefined ? 0 : (exaggeration - 1) * deflection(beam, at, x - leftOf(beam, at));
  }

  /** The height of the ground's profile, in its own coordinates, and its slope there. */
  function profileAt(x) {
    const { profile } = scenery;
    const next = profile.findIndex((point) => point[0] > x);
    if (next < 0) return { y: profile[profile.length - 1][1], slope: 0 };
    if (next === 0) return { y: profile[0][1], slope: 0 };
    const [[x0, y0], [x1, y1]] = [profile[next - 1], profile[next]];
    const slope = (y1 - y0) / (x1 - x0);
    return { y: y0 + slope * (x - x0), slope };
  }

  /** A place in the ground's coordinates, in the world. */
  function onGround([x, y], at) {
    const ground = groundAt(at);
    const [cos, sin] = [Math.cos(ground.slope), Math.sin(ground.slope)];
    return [ground.x + cos * x - sin * y, ground.y + sin * x + cos * y];
  }

  function corners(pose, { corners: own }) {
    const [sin, cos] = [Math.sin(pose.phi), Math.cos(pose.phi)];
    return own.map(([x, y]) => [pose.x + cos * x - sin * y, pose.y + sin * x + cos * y]);
  }

  /** The number of the side that is below: that from the corner of this number. */
  function sideBelow({ upright }, pose, all) {
    if (upright) return (((-Math.round(pose.phi / (Math.PI / 2))) % 4) + 4) % 4;
    const heights = all.map(([, y], k) => y + all[(k + 1) % all.length][1]);
    return heights.indexOf(Math.min(...heights));
  }

  function truePose(block, at) {
    const { x, y, phi } = frames.blocks[block];
    if (Number.isInteger(at)) return { x: x[at], y: y[at], phi: phi[at] };
    // Between the pictures of many bodies, which are few.
    const before = Math.floor(at);
    const part = at - before;
    const between = (values) => values[before] + part * (values[before + 1] - values[before]);
    return { x: between(x), y: between(y), phi: between(phi) };
  }

  /** Where a block is drawn: the corners of the side that is below ride on the exaggerated beam. */
  function drawnPose(block, at) {
    const pose = truePose(block, at);
    if (exaggeration === 1 || beamsOf[block].length === 0) return pose;
    const all = corners(pose, scenery.blocks[block]);
    const below = sideBelow(scenery.blocks[block], pose, all);
    const [a, b] = [all[below], all[(below + 1) % all.length]];
    const [up, down] = [lift(block, at, a[0]), lift(block, at, b[0])];
    const turn = Math.atan2(b[1] + down - a[1] - up, b[0] - a[0]) - Math.atan2(b[1] - a[1], b[0] - a[0]);
    const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const [x, y] = [pose.x - middle[0], pose.y - middle[1]];
    return {
      x: middle[0] + Math.cos(turn) * x - Math.sin(turn) * y,
      y: middle[1] + (up + down) / 2 + Math.sin(turn) * x + Math.cos(turn) * y,
      phi: pose.phi + turn,
    };
  }

  /** The box around everything at all times. */
  function bounds() {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    const see = (x, y, radius = 0) => {
      if (!Number.isFinite(x) || !Number.isFinite(y)) return;
      box[0] = Math.min(box[0], x - radius);
      box[1] = Math.min(box[1], y - radius);
      box[2] = Math.max(box[2], x + radius);
      box[3] = Math.max(box[3], y + radius);
    };
    scenery.blocks.forEach((block, k) => {
      const radii = block.parts.flatMap(([count, radius]) => Array(count).fill(radius));
      const rides = exaggeration !== 1 && beamsOf[k].length > 0;
      for (let at = 0; at < times.length; at++) {
        const pose = rides ? drawnPose(k, at) : truePose(k, at);
        const [sin, cos] = [Math.sin(pose.phi), Math.cos(pose.phi)];
        block.corners.forEach(([x, y], i) => see(pose.x + cos * x - sin * y, pose.y + sin * x + cos * y, radii[i]));
      }
    });
    scenery.beams.forEach((beam, k) => {
      for (let at = 0; at < times.length; at++) {
        const [across, up] = moved(k, at);
        for (let i = 0; i <= 8; i++) {
          const x = (i / 8) * beam.span;
          see(beam.x + across + x, beam.y + up + exaggeration * deflection(k, at, x));
        }
      }
    });
    if (!(box[2] >= box[0])) return [-1, -1, 1, 1];
    if (scenery.ground) {
      const [left, right] = [box[0], box[2]];
      const { x, y, slope } = groundAt(0);
      if (scenery.profile.length > 0) {
        const near = scenery.profile.filter((point) => point[0] > left - x && point[0] < right - x);
        const ends = [left - x, right - x].map((place) => [place, profileAt(place).y]);
        [...near, ...ends].forEach((point) => see(left, onGround(point, 0)[1]));
      } else {
        [left, right].forEach((place) => see(place, y + (place - x) * Math.tan(slope)));
      }
    }
    return box;
  }

  const px = (x) => width / 2 + (x - view.x) * view.scale;
  const py = (y) => height - padding.bottom - (y - view.y) * view.scale;
  const place = (x, y) => `${px(x).toFixed(2)} ${py(y).toFixed(2)}`;

  /** The view that shows everything at all times. */
  let whole = view;
  let followed = null;
  /** How closely the picture looks at bodies that it keeps in sight: it widens while they leave it. None where the reader chose what to look at. */
  let closest = null;
  /** Whether the picture goes up and down with what it follows, too. */
  let followsUp = true;

  /** The width on paper, and the height there of pictures that are taller than wide, px. */
  let paper = null;
  const tallestOnPaper = 215;

  function layout() {
    width = paper ?? root.parentElement.clientWidth;
    const box = bounds();
    const [across, up] = [Math.max(box[2] - box[0], 1e-9), Math.max(box[3] - box[1], 1e-9)];
    const [inner, tallest] = [width - padding.left - padding.right, paper ? tallestOnPaper : Math.max(260, Math.min(420, 0.62 * window.innerHeight + 60))];
    const scale = Math.min(inner / across, (tallest - padding.top - padding.bottom) / up);
    const least = isFarFlung(scale) ? 320 : 230;
    height = Math.max(paper ? Math.min(least, tallestOnPaper) : least, Math.ceil(padding.top + padding.bottom + up * scale));
    whole = { x: (box[0] + box[2]) / 2, y: box[1], scale };
    view = { ...whole };
    closest = null;
    setAll(root, { viewBox: `0 0 ${width} ${height}`, width, height });
    build();
  }

  /** Lays the picture out anew for a width on paper, or again for that of the screen, and looks where it looked before. */
  function layoutFor(wanted) {
    const [before, looked, near, all] = [width, { ...view }, closest, isWhole()];
    paper = wanted;
    layout();
    if (all) return;
    const scale = looked.scale * (width / before);
    closest = near && { ...near, scale: near.scale * (width / before) };
    view = { ...looked, scale };
    build();
  }

  /** Cuts off what is empty above and below all that is drawn, for which paper has no room, or shows it again; returns how tall the picture is to its width. */
  function crop(on) {
    const all = [0, height];
    const { d: scale, f: top } = root.getScreenCTM();
    const heights = [...root.querySelectorAll("path, circle, text")].map((one) => one.getBoundingClientRect())
      .filter((box) => box.width > 0 || box.height > 0).map((box) => [box.top, box.bottom].map((y) => (y - top) / scale))
      .filter(([low, high]) => high > 0 && low < height);
    const edge = 8;
    const [from, to] = on && heights.length
      ? [Math.max(0, Math.min(...heights.map(([y]) => y)) - edge), Math.min(height, Math.max(...heights.map(([, y]) => y)) + edge)] : all;
    setAll(root, { viewBox: `0 ${from.toFixed(1)} ${width} ${(to - from).toFixed(1)}`, height: (to - from).toFixed(1) });
    return (to - from) / width;
  }

  const isWhole = () => view.scale === whole.scale && view.x === whole.x && view.y === whole.y;

  function look(x, y, scale) {
    view = { x, y, scale };
    build();
    onView(isWhole());
  }

  /** Zooms about a point of the picture, by default its middle; never further out than all. */
  function zoomBy(factor, at = [width / 2, height / 2]) {
    closest = null;
    const scale = Math.max(whole.scale, Math.min(1e4 * whole.scale, view.scale * factor));
    if (scale === whole.scale && !followed) return look(whole.x, whole.y, whole.scale);
    const [x, y] = [view.x + (at[0] - width / 2) / view.scale, view.y + (height - padding.bottom - at[1]) / view.scale];
    return look(x - (at[0] - width / 2) / scale, y - (height - padding.bottom - at[1]) / scale, scale);
  }

  function panBy(across, down) {
    closest = null;
    look(view.x - across / view.scale, view.y + down / view.scale, view.scale);
  }

  /** The mean place of the bodies. */
  function middleOf(at) {
    const poses = scenery.blocks.map((_, k) => truePose(k, at)).filter(({ x, y }) => Number.isFinite(x + y));
    const sum = poses.reduce(([x, y], pose) => [x + pose.x, y + pose.y], [0, 0]);
    return sum.map((s) => s / Math.max(1, poses.length));
  }

  /** Keeps the bodies where they are in the picture, or lets them move through it. */
  function follow(on) {
    [followed, closest] = [on ? middleOf(frame) : null, null];
    followsUp = true;
    if (!on) return look(whole.x, whole.y, whole.scale);
    // As large as they are, with as much around them again.
    const box = boxOf(scenery.blocks.keys(), frame);
    const [inner, tall] = [width - padding.left - padding.right, height - padding.top - padding.bottom];
    const scale = Math.max(whole.scale, Math.min(inner / (2 * (box[2] - box[0])), tall / (1.4 * (box[3] - box[1]))));
    return look((box[0] + box[2]) / 2, box[1] - 0.05 * (box[3] - box[1]), scale);
  }

  /** The box around some blocks in a picture: left, bottom, right, top. */
  function boxOf(blocks, at) {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (const k of blocks) {
      const { reach } = scenery.blocks[k];
      const { x, y } = truePose(k, at);
      if (!Number.isFinite(x + y)) continue;
      box[0] = Math.min(box[0], x - reach);
      box[1] = Math.min(box[1], y - reach);
      box[2] = Math.max(box[2], x + reach);
      box[3] = Math.max(box[3], y + reach);
    }
    return box;
  }

  /** The view of a picture that keeps its bodies in sight: as close as it began, or so much wider, by steps for it to stand still between them, that all of
      them are in it. */
  function inSight(at) {
    const box = boxOf(free, at);
    const [inner, tall] = [width - padding.left - padding.right, height - padding.top - padding.bottom];
    const has = ({ x, y, scale }) => box[0] >= x - inner / 2 / scale && box[2] <= x + inner / 2 / scale && box[1] >= y - 0.5 * size && box[3] <= y + tall / scale;
    const by = followed ? middleOf(at).map((now, k) => now - closest.middle[k]) : [0, 0];
    const near = { x: closest.x + by[0], y: closest.y + (followsUp ? by[1] : 0), scale: closest.scale };
    if (has(near)) return near;
    for (let scale = near.scale / 1.25; scale > whole.scale; scale /= 1.25) {
      const wide = { x: (box[0] + box[2]) / 2, y: followsUp ? (box[1] + box[3]) / 2 - 0.5 * tall / scale : whole.y, scale };
      if (has(wide)) return wide;
    }
    return whole;
  }

  /** Bodies of fewer pixels are hardly seen, those of a few bodies that go far not to turn; the picture then opens closer, with bodies of this many. */
  const [smallest, smallestOfFew, seen] = [7, 20, 40];

  const free = scenery.blocks.map((_, k) => k).filter((k) => !scenery.blocks[k].driven);
  const middle = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
  const size = free.length ? 2 * middle(free.map((k) => scenery.blocks[k].reach)) : 0;

  /** Whether a few bodies go so far that a picture of all shows them as specks. */
  const isFarFlung = (scale) => free.length > 0 && free.length <= 4 && size * scale < smallestOfFew
    && Math.max(...free.map((k) => range(frames.blocks[k].x))) * scale > 0.4 * width;
  const range = (values) => values.reduce((most, x) => Math.max(most, x), -Infinity) - values.reduce((least, x) => Math.min(least, x), Infinity);

  /** Opens the picture closer where one of all would show specks, and returns what to say of it; null where it shows all. */
  function closeUp() {
    if (isFarFlung(whole.scale)) return nearFew();
    const fall = nearFall();
    if (fall !== null) return fall;
    if (free.length < 3) return null;
    const places = free.map((k) => truePose(k, 0).x);
    const apart = Math.max(...places) - Math.min(...places);
    // What has only one body fly off isn't seen better from near.
    if (size * whole.scale >= smallest || apart * whole.scale < 0.5 * width) return null;
    const chosen = crowd ? crowd.distances.chosen[0] : free.reduce((best, k) => (wayOf(k) > wayOf(best) ? k : best));
    const { x, y } = truePose(chosen, 0);
    look(x, y - 0.6 * size, seen / size);
    return `Opened close to ${scenery.blocks[chosen].name}; “Show all” shows all ${scenery.blocks.length} bodies. `;
  }

  /** Of what falls off a beam, with no ground that would catch it: opens on all but the fall, which would leave most of the picture empty. */
  function nearFall() {
    if (scenery.ground || !scenery.beams.length) return null;
    const lowest = Math.min(...scenery.beams.map((beam, k) => beam.y + moved(k, 0)[1]));
    const isBelow = (k, at) => truePose(k, at).y < lowest - 2 * scenery.blocks[k].reach;
    const falling = free.filter((k) => isBelow(k, times.length - 1));
    if (!falling.length) return null;
    const ends = scenery.beams.flatMap((beam, k) => [leftOf(k, 0), leftOf(k, 0) + beam.span]);
    const box = [Math.min(...ends), lowest, Math.max(...ends), lowest];
    scenery.blocks.forEach(({ reach }, k) => {
      for (let at = 0; at < times.length; at++) {
        if (isBelow(k, at)) continue;
        const { x, y } = truePose(k, at);
        [box[0], box[1]] = [Math.min(box[0], x - reach), Math.min(box[1], y - reach)];
        [box[2], box[3]] = [Math.max(box[2], x + reach), Math.max(box[3], y + reach)];
      }
    });
    const [inner, tall] = [width - padding.left - padding.right, height - padding.top - padding.bottom];
    const scale = Math.min(inner / (box[2] - box[0]), tall / (box[3] - box[1]));
    if (!(scale > 1.3 * whole.scale)) return null;
    look((box[0] + box[2]) / 2, box[1], scale);
    const who = falling.length > 1 ? `${falling.length} bodies fall` : `${scenery.blocks[falling[0]].name} falls`;
    return `Opened close to where ${who} off; “Show all” shows the whole way. `;
  }

  /** How far a body is at the end from where it began. */
  function wayOf(k) {
    const { x, y } = frames.blocks[k];
    return Math.hypot(x[x.length - 1] - x[0], y[y.length - 1] - y[0]);
  }

  /** Of a few bodies that go far: follows them if they go together, or opens where they start. */
  function nearFew() {
    const [inner, tall] = [width - padding.left - padding.right, height - padding.top - padding.bottom];
    const poses = free.map((k) => truePose(k, 0));
    const box = ["x", "y"].map((axis) => poses.map((pose) => pose[axis])).map((all) => [Math.min(...all), Math.max(...all)]);
    const [across, up] = box.map(([low, high]) => high - low + 2 * size);
    const ways = free.map(wayOf);
    const together = Math.min(...ways) > 0.5 * Math.max(...ways);
    const near = Math.min(seen / size, inner / across);
    // With all heights in the picture, so that the ground stays in view, if the bodies are still seen.
    const all = bounds();
    const level = Math.min(near, tall / (all[3] - all[1]));
    const upright = level * size >= smallestOfFew;
    const scale = upright ? level : Math.min(near, tall / up);
    const x = together ? middleOf(0)[0] : (box[0][0] + box[0][1]) / 2;
    followed = together ? middleOf(frame) : null;
    followsUp = !upright;
    // From where it looks at them at the start, whichever picture is shown now.
    closest = { x, y: upright ? whole.y : (together ? middleOf(0)[1] : box[1][0]) - 0.5 * tall / scale, scale, middle: middleOf(0) };
    const opens = inSight(frame);
    look(opens.x, opens.y, opens.scale);
    return together ? "The picture follows the bodies; “Show all” shows the whole way. "
      : "Opened where the bodies start, and widens as they leave; “Show all” shows the whole way. ";
  }

  /** Where the picture is in all of it: a line at its top. */
  function locator() {
    if (isWhole()) return;
    const [left, length] = [width - 132, 120];
    const all = (width - padding.left - padding.right) / whole.scale;
    const part = (x) => left + length * Math.min(1, Math.max(0, (x - whole.x) / all + 0.5));
    const [a, b] = [part(view.x - 0.5 * width / view.scale), part(view.x + 0.5 * width / view.scale)];
    svgElement("path", { d: `M${left} ${height - 12}h${length}`, class: "scale", "data-locator": "" }, root);
    svgElement("path", { d: `M${a.toFixed(1)} ${height - 12}H${Math.max(b, a + 3).toFixed(1)}`, class: "scale here" }, root);
  }

  function hatch(x, y, length, step, down) {
    let path = "";
    for (let k = 0; k <= length / step; k++) path += `M${(x + k * step).toFixed(1)} ${y.toFixed(1)}l-5 ${down}`;
    return path;
  }

  /** A spring down from (x, y). */
  const spring = (x, y) => `M${x.toFixed(1)} ${y.toFixed(1)}v3l-5 2l10 4l-10 4l10 4l-5 2v3`;

  /** A row of springs under a part of a beam, on hatched ground. */
  function drawFoundation(parent, [from, to], y) {
    const [left, length] = [from, to - from];
    const count = Math.max(2, Math.round(length / 22));
    let path = "";
    for (let k = 0; k < count; k++) path += spring(left + ((k + 0.5) / count) * length, y);
    const group = svgElement("g", { "data-foundation": "" }, parent);
    svgElement("title", {}, group).textContent = "elastic foundation";
    svgElement("path", { d: `${path}M${left.toFixed(1)} ${(y + 22).toFixed(1)}h${length.toFixed(1)}`, class: "support springs" }, group);
    svgElement("path", { d: hatch(left + 5, y + 22, length - 5, 6, 5), class: "hatch" }, group);
  }

  /** A dashpot beside the spring of a support. */
  function drawDashpot(parent, x, y) {
    const d = `M${x} ${y}m14 0h-14m14 0v9m-4 0h8m-10 -3v10h12v-10m-6 10v6`;
    svgElement("path", { d, class: "support springs", "data-dashpot": "" }, parent);
  }

  function drawSupport(parent, kind, x, y, right, roller) {
    if (kind === "pinned") {
      svgElement("path", { d: `M${x} ${y}l-7 12h14z`, class: "support" }, parent);
      // Where axial motion is free, one of the two ends is a roller.
      if (roller) svgElement("path", { d: `M${x - 9} ${y + 16}h18`, class: "support" }, parent);
      svgElement("path", { d: hatch(x - 6, y + (roller ? 16 : 12), 16, 4, 5), class: "hatch" }, parent);
    } else if (kind === "clamped") {
      svgElement("path", { d: `M${x} ${y - 16}v32`, class: "support" }, parent);
      let path = "";
      for (let k = 0; k < 8; k++) path += `M${x} ${y - 16 + 4 * k}l${right ? 6 : -6} 5`;
      svgElement("path", { d: path, class: "hatch" }, parent);
    } else if (kind === "guided") {
      // A wall with rollers: no rotation, free to move across the axis.
      const side = right ? 1 : -1;
      svgElement("path", { d: `M${x} ${y - 16}v32m${5 * side} 0v-32`, class: "support" }, parent);
    } else if (kind === "elastic") {
      svgElement("path", { d: `${spring(x, y)}m-9 0h18`, class: "support" }, parent);
      svgElement("path", { d: hatch(x - 6, y + 22, 16, 4, 5), class: "hatch" }, parent);
    }
  }

  /** The profile of the ground around its own origin, with rays of this length (px) at its ends. */
  function drawProfile(ray) {
    const line = scenery.profile.map(([x, y]) => [x * view.scale, -y * view.scale]);
    const [first, last] = [line[0], line[line.length - 1]];
    const middle = view.x * view.scale;
    line.unshift([Math.min(first[0], middle) - ray, first[1]]);
    line.push([Math.max(last[0], middle) + ray, last[1]]);
    let strokes = "";
    // Only what the picture may show is hatched.
    for (let k = 1; k < line.length; k++) {
      const [[x0, y0], [x1, y1]] = [line[k - 1], line[k]];
      const [from, to] = [Math.max(x0, middle - ray), Math.min(x1, middle + ray)];
      // Evenly along the line, also where it is steep; at whole steps from its left end, so that they don't move with the picture.
      const length = Math.hypot(x1 - x0, y1 - y0);
      const [across, down] = [(x1 - x0) / length, (y1 - y0) / length];
      const step = 8 * across;
      const [back, into] = [(-5 * across - 7 * down).toFixed(1), (-5 * down + 7 * across).toFixed(1)];
      for (let x = x0 + step * Math.ceil((from - x0) / step); x < to; x += step) {
        strokes += `M${x.toFixed(1)} ${(y0 + ((x - x0) / across) * down).toFixed(1)}l${back} ${into}`;
      }
    }
    svgElement("path", { d: strokes, class: "hatch" }, layers.ground);
    const path = line.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join("L");
    svgElement("path", { d: `M${path}`, class: "ground-line", "data-profile": scenery.profile.length }, layers.ground);
  }

  function build() {
    root.replaceChildren();
    const marker = svgElement("marker", {
      id: "head", viewBox: "0 0 10 10", refX: 9, refY: 5, markerWidth: 5, markerHeight: 5, orient: "auto",
    }, svgElement("defs", {}, root));
    svgElement("path", { d: "M0 0L10 5L0 10z", style: "fill: var(--force)" }, marker);
    const ofLoad = marker.cloneNode(true);
    ofLoad.id = "load-head";
    ofLoad.firstChild.setAttribute("style", "fill: var(--load)");
    marker.after(ofLoad);
    if (scenery.ground) {
      // Long enough to cross the picture wherever it moves and turns.
      const reach = 8 * Math.ceil((width + height) / 4);
      layers.ground = svgElement("g", { "data-body": "ground" }, root);
      if (scenery.profile.length > 0) {
        drawProfile(2 * reach);
      } else {
        svgElement("path", { d: hatch(4 - reach, 0, 2 * reach, 8, 7), class: "hatch" }, layers.ground);
        svgElement("path", { d: `M${-reach} 0H${reach}`, class: "ground-line" }, layers.ground);
      }
    }
    layers.beams = scenery.beams.map((beam) => {
      const group = svgElement("g", { "data-body": beam.name }, root);
      svgElement("title", {}, group).textContent = beam.name;
      svgElement("path", { d: `M${place(beam.x, beam.y)}H${px(beam.x + beam.span)}`, class: "chord" }, group);
      // Contact is with the axis or the top fibre; the line hangs below it, never thinner than the eye sees.
      const thickness = Math.max(3, beam.thickness * view.scale);
      const edge = beam.top ? (beam.thickness / 2) * view.scale : 0;
      const line = svgElement("path", { class: "beam" }, group);
      const low = py(beam.y) - edge + thickness;
      beam.supports.forEach((kind, end) =>
        drawSupport(group, kind, px(beam.x + end * beam.span), low, end === 1, !beam.held[end]));
      for (const [x, kind] of beam.inner) drawSupport(group, kind, px(beam.x + x), low, true, true);
      for (const [from, to] of beam.foundations) drawFoundation(group, [px(beam.x + from), px(beam.x + to)], low);
      const held = [0, beam.span, ...beam.inner.map(([x]) => x)];
      held.forEach((x, k) => { if (beam.dashpots[k]) drawDashpot(group, px(beam.x + x), low); });
      const masses = beam.masses.map((x) => {
        const mass = svgElement("circle", { r: 6, cx: px(beam.x + x).toFixed(2), class: "mass", "data-mass": x }, group);
        svgElement("title", {}, mass).textContent = "mass that the beam carries";
        return mass;
      });
      return { group, line, thickness, edge, masses };
    });
    layers.crowd = [];
    if (crowded) {
      // One path for all, as an element for each would be too slow; those that the plots name have the plots' colours.
      const named = colouredBlocks();
      const groups = [scenery.blocks.map((_, k) => k).filter((k) => !named.has(k)), ...[...named.keys()].map((k) => [k])];
      layers.crowd = groups.map((blocks, k) => {
        const group = svgElement("g", k > 0 ? { "data-body": scenery.blocks[blocks[0]].name } : {}, root);
        if (k > 0) svgElement("title", {}, group).textContent = scenery.blocks[blocks[0]].name;
        const paint = k > 0 ? colour(named.get(blocks[0])) : "var(--muted)";
        const path = svgElement("path", { class: k > 0 ? "body named" : "body crowd", style: `stroke: ${paint}; fill: ${paint}` }, group);
        return { blocks, path };
      });
    }
    layers.blocks = (crowded ? [] : scenery.blocks).map((block, k) => {
      svgElement("path", { d: outline(k, 0), class: "ghost" }, root);
      const group = svgElement("g", { "data-body": block.name }, root);
      svgElement("title", {}, group).textContent = block.name;
      const body = svgElement("path", { class: "body", style: `stroke: ${colour(k)}; fill: ${colour(k)}` }, group);
      const centre = svgElement("circle", { r: 2.5, style: `fill: ${colour(k)}` }, group);
      return { group, body, centre };
    });
    layers.network = chains?.build(root) ?? [];
    layers.loads = svgElement("g", {}, root);
    layers.arrows = svgElement("g", {}, root);
    scaleBar();
    locator();
    draw(frame, remembered);
  }

  /** The outlines of a block's parts; a disc with a radius, by which it is seen to roll. */
  function outline(block, at) {
    const { phi } = drawnPose(block, at);
    return partsOf(block, corners(drawnPose(block, at), scenery.blocks[block])).map(({ core, radius }) => {
      if (radius === 0) return `M${core.map(([x, y]) => place(x, y)).join("L")}Z`;
      const size = (radius * view.scale).toFixed(2);
      const arc = (x, y) => `A${size} ${size} 0 0 0 ${place(x, y)}`;
      if (core.length === 1) {
        const [[x, y]] = core;
        const [across, up] = [radius * Math.cos(phi), radius * Math.sin(phi)];
        return `M${place(x + across, y + up)}${arc(x - across, y - up)}${arc(x + across, y + up)}L${place(x, y)}`;
      }
      const sides = sidesOf(core).map(({ from, to, out }) =>
        [from, to].map(([x, y]) => [x + radius * out[0], y + radius * out[1]]));
      const pieces = sides.map(([, to], k) => {
        const next = sides[(k + 1) % sides.length][0];
        return `L${place(...to)}${arc(...next)}`;
      });
      return `M${place(...sides[0][0])}${pieces.join("")}Z`;
    }).join("");
  }

  /** The parts of a block: their corners out of all of them, and how far they reach beyond those. */
  function partsOf(block, all) {
    let first = 0;
    return scenery.blocks[block].parts.map(([count, radius]) => {
      first += count;
      return { core: all.slice(first - count, first), radius, first: first - count };
    });
  }

  /** The sides of a part, with their normals out of it. */
  function sidesOf(core) {
    return core.map((from, k) => {
      const to = core[(k + 1) % core.length];
      const [x, y] = [to[0] - from[0], to[1] - from[1]];
      const length = Math.hypot(x, y) || 1;
      return { from, to, out: [y / length, -x / length] };
    });
  }

  function scaleBar() {
    const most = (0.28 * width) / view.scale;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = power * [5, 2, 1].find((factor) => factor * power <= most);
    const [unit, factor] = [["km", 1e-3], ["m", 1], ["cm", 100], ["mm", 1e3], ["µm", 1e6]]
      .find(([, perMetre]) => length * perMetre >= 0.999) ?? ["nm", 1e9];
    const y = height - 12;
    svgElement("path", { d: `M12 ${y - 4}v8m0 -4h${(length * view.scale).toFixed(1)}m0 -4v8`, class: "scale" }, root);
    const label = svgElement("text", { x: 20 + length * view.scale, y: y + 4 }, root);
    label.textContent = `${Number((length * factor).toPrecision(3))} ${unit}`;
  }

  // Arrows are as long as forces usually are; a blow ends at a longest one.
  const usual = (() => {
    const sizes = forces.points.flatMap((point) => point.normal.filter((f) => f > 0)).sort((a, b) => a - b);
    return sizes[Math.floor(sizes.length / 2)] || 1;
  })();
  const hardest = data.impacts.reduce((most, impact) => Math.max(most, Math.hypot(...impact.impulse)), 1e-300);

  /**
   * The way out of a block at a point: that of the side, or away from the corner, that it is nearest to. At a corner of
   * both blocks it is that of the side which faces the other one's middle.
   */
  function outwardAt(block, x, y, at, other) {
    const { x: middleX, y: middleY } = truePose(other, at);
    const near = partsOf(block, corners(truePose(block, at), scenery.blocks[block])).map(({ core, radius }) => {
      const away = core.map(([cx, cy]) => {
        const distance = Math.hypot(x - cx, y - cy) || 1e-300;
        return { distance, out: [(x - cx) / distance, (y - cy) / distance] };
      });
      const sides = core.length < 2 ? [] : sidesOf(core).map(({ from, to, out }) => {
        const over = (x - from[0]) * out[0] + (y - from[1]) * out[1];
        const along = (x - from[0]) * (to[0] - from[0]) + (y - from[1]) * (to[1] - from[1]);
        const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
        const beside = along < 0 || along > length ** 2;
        const touches = Math.abs(over) <= 1e-3 * length && along >= -1e-3 * length ** 2 && along <= 1.001 * length ** 2;
        return { over, beside, out, facing: touches ? out[0] * (middleX - x) + out[1] * (middleY - y) : null };
      });
      const touching = radius > 0 ? [] : sides.filter((side) => side.facing !== null);
      if (touching.length > 1) {
        const side = touching.reduce((best, one) => (one.facing > best.facing ? one : best));
        return { gap: side.over, out: side.out };
      }
      const most = sides.reduce((best, side) => (best === null || side.over > best.over ? side : best), null);
      const corner = away.reduce((best, one) => (one.distance < best.distance ? one : best));
      const side = most !== null && (most.over <= 0 || !most.beside);
      return side ? { gap: most.over - radius, out: most.out } : { gap: corner.distance - radius, out: corner.out };
    });
    return near.reduce((best, one) => (one.gap < best.gap ? one : best)).out;
  }

  /** How far a block reaches beyond one of its corners. */
  function reachOf(block, corner) {
    const { radius } = partsOf(block, scenery.blocks[block].corners).find(({ first, core }) => corner < first + core.length);
    return radius;
  }

  /** Where a beam touches a side of a block: its end, or where it comes out furthest beside the block. */
  function onBeam(number, block, onSide, lower, at) {
    const beam = scenery.beams[number];
    const [across, up] = moved(number, at);
    const surface = beam.top ? (lower ? -0.5 : 0.5) * beam.thickness : 0;
    const height = (x) => exaggeration * deflection(number, at, x);
    const all = corners(truePose(block, at), scenery.blocks[block]).map(([x]) => x - beam.x - across);
    const beside = (x) => x >= Math.min(...all) && x <= Math.max(...all);
    const nodes = Array.from({ length: beam.points }, (_, i) => (i / (beam.points - 1)) * beam.span);
    const outmost = (a, b) => ((lower ? height(b) < height(a) : height(b) > height(a)) ? b : a);
    const middle = (Math.min(...all) + Math.max(...all)) / 2;
    const x = onSide === "hump" ? nodes.filter(beside).reduce(outmost, middle) : onSide.end * beam.span;
    return [beam.x + across + x, beam.y + up + surface + height(x)];
  }

  /** A contact point as drawn, with the directions of the contact's frame. */
  function contactPoint(contact, point, at) {
    const { block: first, beam, other, linear, lower, points: places } = scenery.contacts[contact];
    const { block, corner, crest, on_side: onSide } = places[point];
    if (crest !== null) {
      const [x, y] = onGround(crest, at);
      const normal = outwardAt(block, x, y, at, block).map((n) => -n);
      return { x: px(x), y: py(y), normal, tangent: [normal[1], -normal[0]] };
    }
    if (onSide !== null) {
      const [x, y] = onBeam(beam, block, onSide, lower, at);
      const normal = outwardAt(block, x, y, at, block).map((n) => -n);
      return { x: px(x), y: py(y), normal, tangent: [normal[1], -normal[0]] };
    }
    const [x, y] = corners(drawnPose(block, at), scenery.blocks[block])[corner];
    const reach = reachOf(block, corner);
    if (other !== null) {
      const touched = block === first ? other : first;
      const out = outwardAt(touched, x, y, at, block);
      const normal = out.map((n) => (block === first ? n : -n));
      return { x: px(x - reach * out[0]), y: py(y - reach * out[1]), normal, tangent: [normal[1], -normal[0]] };
    }
    let slope = beam === null ? Math.tan(groundAt(at).slope) : 0;
    if (beam === null && scenery.profile.length > 0) {
      const ground = groundAt(at);
      const along = (x - ground.x) * Math.cos(ground.slope) + (y - ground.y) * Math.sin(ground.slope);
      slope = Math.tan(ground.slope + Math.atan(profileAt(along).slope));
    }
    if (beam !== null && !linear) {
      const { span, points } = scenery.beams[beam];
      const left = leftOf(beam, at);
      const step = span / (points - 1);
      const place = corners(truePose(block, at), scenery.blocks[block])[corner][0] - left;
      slope = (deflection(beam, at, place + step) - deflection(beam, at, place - step)) / (2 * step);
    }
    const size = Math.hypot(1, slope);
    const facing = lower ? -1 : 1;
    const normal = [(-facing * slope) / size, facing / size];
    return { x: px(x - reach * normal[0]), y: py(y - reach * normal[1]), normal, tangent: [normal[1], -normal[0]] };
  }

  /** The forces of the points that press at a time, N, with where they are drawn. How points of a pair that face one way share their tangential force,
      equilibrium leaves open: it is shared as their normal forces are, which is what those that slide do anyway. Springs decide it themselves. */
  function pressing(t, at) {
    const stepped = (y) => valueAt({ t: forces.borders, y, stepped: true }, t);
    const all = forces.points
      .map((point) => ({ point, n: stepped(point.normal), s: stepped(point.tangential) }))
      .filter(({ n }) => n > 0)
      .map((force) => ({ ...force, place: contactPoint(force.point.contact, force.point.point, at) }));
    const facesAlike = (a, b) => a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] > 0.99;
    const byPairs = new Map(all.map(({ point }) => [point.contact, []]));
    all.forEach((force) => byPairs.get(force.point.contact).push(force));
    return all.map(({ point, n, s, place }) => {
      if (forces.compliant?.includes(point.contact)) return { point, n, s, place };
      const together = byPairs.get(point.contact).filter((other) => facesAlike(other.place, place));
      const [normal, tangential] = together.reduce((sum, other) => [sum[0] + other.n, sum[1] + other.s], [0, 0]);
      return { point, n, s: (tangential * n) / normal, place };
    });
  }

  function arrow(at, [normal, tangential], length, className, contact) {
    const direction = [0, 1].map((k) => normal * at.normal[k] + tangential * at.tangent[k]);
    const size = Math.hypot(...direction);
    if (!(size > 0) || length < 3) return;
    const tail = [at.x - (direction[0] / size) * length, at.y + (direction[1] / size) * length];
    svgElement("path", {
      d: `M${tail[0].toFixed(2)} ${tail[1].toFixed(2)}L${at.x.toFixed(2)} ${at.y.toFixed(2)}`,
      class: className, "marker-end": "url(#head)", "data-contact": contact,
    }, layers.arrows);
  }

  /** The outline of a block of many: as `outline`, without what costs time. */
  function crowdOutline(k, at) {
    const { x, y, phi } = truePose(k, at);
    const block = scenery.blocks[k];
    if (block.parts.length > 1 || block.parts[0][1] > 0) return outline(k, at);
    const [sin, cos] = [Math.sin(phi), Math.cos(phi)];
    let d = "";
    for (const [a, b] of block.corners) {
      d += `${d ? "L" : "M"}${Math.round(10 * px(x + cos * a - sin * b)) / 10} ${Math.round(10 * py(y + sin * a + cos * b)) / 10}`;
    }
    return `${d}Z`;
  }

  const heaviest = data.loads.reduce((most, { force, factor }) =>
    factor.reduce((largest, x) => Math.max(largest, Math.abs(x) * Math.hypot(...force)), most), 0);

  /** The forces on blocks and beams: arrows that end where they act, as long as they are large. */
  function drawLoads(at) {
    layers.loads.replaceChildren();
    const picture = Math.round(at);
    for (const load of data.loads) {
      const force = load.force.map((f) => f * load.factor[picture]);
      const size = Math.hypot(...force);
      const couple = (load.couple ?? 0) * load.factor[picture];
      if (!(size > 0) && couple === 0) continue;
      const ends = [];
      if (load.block !== undefined) {
        const { x, y } = drawnPose(load.block, at);
        ends.push([x, y]);
      } else {
        const beam = scenery.beams[load.beam];
        const [across, up] = moved(load.beam, picture);
        const [from, to] = load.span.map((x) => x + load.speed * times[picture]);
        const count = to > from ? 6 : 0;
        for (let k = 0; k <= count; k++) {
          const x = from + (count ? k / count : 0) * (to - from);
          if (x >= 0 && x <= beam.span) ends.push([beam.x + across + x, beam.y + up + exaggeration * deflection(load.beam, picture, x)]);
        }
      }
      if (couple !== 0) {
        // Three quarters of a turn about the point, the way it turns: counter-clockwise if positive.
        for (const [x, y] of ends) {
          const [a, b] = [px(x), py(y)];
          const from = couple > 0 ? a + 13 : a - 13;
          const d = `M${from.toFixed(2)} ${b.toFixed(2)}A13 13 0 1 ${couple > 0 ? 0 : 1} ${a.toFixed(2)} ${(b + 13).toFixed(2)}`;
          const arrow = svgElement("path", { d, class: "load couple", "data-load": load.name, "marker-end": "url(#load-head)" }, layers.loads);
          svgElement("title", {}, arrow).textContent = `${load.name}: ${withPrefix(Math.abs(couple), "N m")}`;
        }
      }
      if (!(size > 0)) continue;
      const length = Math.max(8, (46 * size) / heaviest);
      const [dx, dy] = [force[0] / size, -force[1] / size];
      for (const [x, y] of ends) {
        const [a, b] = [px(x), py(y)];
        const d = `M${(a - dx * length).toFixed(2)} ${(b - dy * length).toFixed(2)}L${a.toFixed(2)} ${b.toFixed(2)}`;
        const arrow = svgElement("path", { d, class: "load", "data-load": load.name, "marker-end": "url(#load-head)" }, layers.loads);
        svgElement("title", {}, arrow).textContent = `${load.name}: ${withPrefix(size, "N")}`;
      }
    }
  }

  /** Shows a picture; impacts within `memory` seconds before it are ringed. Pictures of many bodies have some in between. */
  function draw(position, memory = 0) {
    const at = crowded ? position : Math.round(position);
    frame = at;
    if (closest) {
      const next = inSight(at);
      if (followed) followed = middleOf(at);
      if (next.scale !== view.scale || Math.hypot(next.x - view.x, next.y - view.y) * view.scale > 0.1) {
        look(next.x, next.y, next.scale);
        return;
      }
    } else if (followed) {
      const now = middleOf(at);
      const by = [now[0] - followed[0], followsUp ? now[1] - followed[1] : 0];
      // Less than a tenth of a pixel is not seen to move.
      if (Math.hypot(...by) * view.scale > 0.1) {
        followed = now;
        view = { ...view, x: view.x + by[0], y: view.y + by[1] };
        build();
        return;
      }
    }
    const t = times[Math.ceil(at)];
    remembered = memory;
    const picture = Math.round(at);
    if (scenery.ground) {
      const { x, y, slope } = groundAt(picture);
      // Drawn around what is nearest to the middle of the picture, by whole hatches from the point that moves.
      const [cos, sin] = [Math.cos(slope), Math.sin(slope)];
      const along = (view.x - x) * cos + (view.y - y) * sin;
      const straight = scenery.profile.length === 0;
      const shift = straight ? (8 * Math.round((along * view.scale) / 8)) / view.scale : 0;
      const at0 = place(x + shift * cos, y + shift * sin);
      layers.ground.setAttribute("transform", `translate(${at0}) rotate(${(-slope * degrees).toFixed(4)})`);
    }
    scenery.beams.forEach((beam, k) => {
      const { group, line, thickness, edge, masses } = layers.beams[k];
      const [across, up] = moved(k, picture);
      group.setAttribute("transform", `translate(${(across * view.scale).toFixed(2)} ${(-up * view.scale).toFixed(2)})`);
      const top = [];
      const bottom = [];
      for (let i = 0; i < beam.points; i++) {
        const x = (i / (beam.points - 1)) * beam.span;
        const y = py(beam.y + exaggeration * deflection(k, picture, x)) - edge;
        top.push(`${px(beam.x + x).toFixed(2)} ${y.toFixed(2)}`);
        bottom.unshift(`${px(beam.x + x).toFixed(2)} ${(y + thickness).toFixed(2)}`);
      }
      line.setAttribute("d", `M${top.concat(bottom).join("L")}Z`);
      // On its axis, in the middle of what is drawn.
      masses.forEach((mass, i) => {
        const y = py(beam.y + exaggeration * deflection(k, picture, beam.masses[i])) - edge + thickness / 2;
        mass.setAttribute("cy", y.toFixed(2));
      });
    });
    for (const { blocks, path } of layers.crowd) path.setAttribute("d", blocks.map((k) => crowdOutline(k, at)).join(""));
    (crowded ? [] : scenery.blocks).forEach((_, k) => {
      const { group, body, centre } = layers.blocks[k];
      const pose = truePose(k, at);
      const drawn = drawnPose(k, at);
      setAll(group, { "data-x": pose.x, "data-y": pose.y, "data-phi": pose.phi });
      body.setAttribute("d", outline(k, at));
      setAll(centre, { cx: px(drawn.x).toFixed(2), cy: py(drawn.y).toFixed(2) });
    });
    // What led to the picture: between two, what leads to the next.
    if (chains && drawn === "network") chains.draw(layers.network, Math.ceil(at), (k) => drawnPose(k, at), place, view.scale);
    else if (chains) chains.clear(layers.network);
    drawLoads(at);
    layers.arrows.replaceChildren();
    if (drawn === "arrows") {
      for (const { point, n, s, place: end } of pressing(t, Math.round(at))) {
        const length = Math.min(padding.bottom - 22, (34 * Math.hypot(n, s)) / usual);
        arrow(end, [n, s], length, "force", point.contact);
      }
    }
    const since = t - Math.max(memory, 1.01 * (t - times[Math.max(0, Math.ceil(at) - 1)]));
    for (const impact of data.impacts.filter((one) => one.t > since && one.t <= t * (1 + 1e-12))) {
      const { x, y } = contactPoint(impact.contact, impact.point, Math.round(at));
      const r = 5 + 9 * Math.sqrt(Math.hypot(...impact.impulse) / hardest);
      svgElement("circle", { cx: x.toFixed(2), cy: y.toFixed(2), r: r.toFixed(1), class: "impact" }, layers.arrows);
    }
  }

  /** The exaggeration by which the largest deflection is seen: a round one, none where it is seen anyway. */
  function suitable(factors) {
    const largest = scenery.beams.reduce((most, _, k) => {
      const { unit, w } = frames.beams[k];
      return w.reduce((deepest, x) => Math.max(deepest, Math.abs(x) * unit), most);
    }, 0);
    const wanted = 14 / (largest * whole.scale);
    if (!(wanted > 3.5) || !Number.isFinite(wanted)) return 1;
    // What takes more than that to be seen isn't worth a distorted picture: the slider shows it.
    return factors.reduce((best, one) => (one <= Math.min(wanted, 100) ? one : best), 1);
  }

  return {
    draw,
    layout,
    layoutFor,
    crop,
    zoomBy,
    panBy,
    follow,
    closeUp,
    suitable,
    root,
    showAll: () => {
      [followed, closest] = [null, null];
      look(whole.x, whole.y, whole.scale);
    },
    isWhole,
    keepsInSight: () => closest !== null,
    isFollowing: () => followed !== null,
    onView(f) { onView = f; },
    forces(how) {
      drawn = how;
      draw(frame, remembered);
    },
    exaggerate(factor) {
      exaggeration = factor;
      [followed, closest] = [null, null];
      layout();
      onView(true);
    },
  };
})();
