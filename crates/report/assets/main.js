// What is plotted, and how time passes.

(() => {
  const several = scenery.blocks.length > 1;
  const sentence = (text) => `${text[0].toUpperCase()}${text.slice(1)}.`;
  if (crowd) addCrowd();
  addPanels(false);

  /** The plots over time that the page has in common with the figures: units, scales and what is left out are decided there. */
  function addPanels(late) {
    for (const panel of data.panels.filter((one) => one.late === late)) {
      // An angle has at a picture the value that is told below it.
      const turn = { "°": degrees, rad: 1, mrad: 1e3 }[panel.unit];
      const isAngle = !crowd && turn && (panel.id === "phi" || panel.id === "phi_rolling");
      const angles = (block) => new Map([...frames.blocks[block].phi].map((phi, k) => [k, phi * turn]));
      const series = panel.series.map(({ label, index, y, raw, turns, at_borders: atBorders, ...rest }) => ({
        label, index, y, raw, turns, t: panel.t ?? (atBorders ? forces.borders : curves.t), known: isAngle ? angles(index) : knownOf(rest),
      }));
      plots.add({
        id: panel.id, contact: panel.contact, title: panel.title, unit: panel.unit, series, guides: panel.guides, least: panel.least,
        cut: panel.cut, height: late ? 160 : 170,
      });
      if (panel.note) htmlElement("p", "note", sentence(panel.note), byId(`panel-${panel.id}`));
    }
  }

  /** The values of a curve at the pictures at which it shows others, by the numbers of these. */
  function knownOf({ other_at: otherAt = [], others = [] }, factor = 1) {
    let picture = 0;
    return new Map(otherAt.map((after, k) => [picture += after, others[k] === null ? null : others[k] * factor]));
  }

  /** The means of the stretches in which the pictures are, where a curve shows the extremes of these. */
  const atPictures = (means) => new Map(times.map((t, k) => [k, valueAt(means, t)]));

  /** Bands of many bodies, and those that go and turn furthest. */
  function addCrowd() {
    const numbers = new Map();
    [...crowd.distances.chosen, ...crowd.turns.chosen].forEach((k) => numbers.has(k) || numbers.set(k, numbers.size + 1));
    const bands = (t, all, factor) => {
      const [least, low, median, high, most] = all.map((values) => values.map((x) => x * factor));
      return [
        { label: "all bodies", index: 0, t, y: least, upper: most }, { label: "8 of 10", index: 0, t, y: low, upper: high, inner: true },
        { label: "median", index: 0, t, y: median },
      ];
    };
    const chosen = ({ chosen: blocks, values }, factor) => blocks.map((k, i) =>
      ({ label: scenery.blocks[k].name, index: numbers.get(k), t: times, y: values[i].map((x) => x * factor) }));
    const say = (id, text) => htmlElement("p", "note", text, byId(`panel-${id}`));
    const rule = (what) => `Of ${scenery.blocks.length} bodies at each time: least to largest, the middle 8 of 10, the median; by name the `
      + `${Math.min(3, scenery.blocks.length)} that ${what} furthest.`;
    const far = Math.max(...crowd.distances.bands[4]);
    const [prefix, factor] = [["k", 1e-3], ["", 1], ["m", 1e3], ["µ", 1e6], ["n", 1e9]].find(([, f]) => far * f >= 0.5) ?? ["n", 1e9];
    plots.add({
      id: "distance", title: "Distance from the start", unit: `${prefix}m`, least: 1e-9 * factor, height: 190,
      series: [...bands(times, crowd.distances.bands, factor), ...chosen(crowd.distances, factor)],
    });
    say("distance", rule("go"));
    plots.add({
      id: "phi", title: "Turn since the start", unit: "°", least: 2e-3, height: 190,
      series: [...bands(times, crowd.turns.bands, degrees), ...chosen(crowd.turns, degrees)],
    });
    say("phi", rule("turn"));
    plots.add({ id: "omega", title: "Angular velocity ω", unit: "rad/s", least: 2e-3, height: 160, series: bands(curves.t, crowd.omega, 1) });
  }
  /** What is pale first, then for each point the curve that has its name, in the order of the points. */
  const overTheRaw = (lines, means) =>
    [...lines.filter(({ raw }) => raw), ...[...lines.filter(({ raw }) => !raw), ...means].sort((a, b) => a.index - b.index)];

  const strongest = Math.max(1e-300, ...forces.points.map(({ normal }) => normal.reduce((most, f) => Math.max(most, f), 0)));
  /** The tangential force of several points together. */
  const sumOf = (points) => points.reduce((total, { tangential }) => tangential.map((f, i) => (f === null ? null : f + (total[i] ?? 0))), []);
  const scaled = (values, factor) => values.map((f) => (f === null ? null : f * factor));
  const active = scenery.contacts.map((_, k) => k).filter((k) => forces.points.some((point) => point.contact === k));
  /** Whether no force of a contact changes by more than can be seen: that tells less than those that do, however large it is. */
  const isConstant = (k) => forces.points.filter(({ contact }) => contact === k).every((point) => {
    const courses = [point.course?.[0].y ?? point.normal, point.course?.[1].y ?? point.tangential];
    const [normal, tangential] = courses.map((values) => values.filter(Number.isFinite));
    const ends = (values) => values.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    const largest = Math.max(...[normal, tangential].flatMap(ends).filter(Number.isFinite).map(Math.abs), 0);
    return !point.impacts && [normal, tangential].every((values) => !values.length || ends(values)[1] - ends(values)[0] <= 0.01 * largest);
  });
  const constant = new Set(active.filter(isConstant));
  /** First those that tell something. */
  const inOrder = active.filter((k) => !constant.has(k)).concat([...constant]);
  /** The contacts with the largest forces, as plotted, in their order; before others those whose forces change. An impulse counts as a force over a time that suits the block's size. */
  const strongestContacts = (count) => {
    const largest = (values) => (values ?? []).reduce((most, x) => Math.max(most, x ?? 0), 0);
    const strength = (k) => {
      const lasting = Math.sqrt(scenery.blocks[scenery.contacts[k].block].reach / 9.81);
      const force = ({ normal, course }) => (forces.forceless?.includes(k) ? 0 : largest(course?.[0].y ?? normal));
      return Math.max(...forces.points.filter(({ contact }) => contact === k).map((point) => Math.max(force(point), largest(point.impacts) / lasting)));
    };
    const kept = active.map((k) => [k, strength(k)]).sort(([j, a], [k, b]) => constant.has(j) - constant.has(k) || b - a).slice(0, count).map(([k]) => k);
    return inOrder.filter((k) => kept.includes(k));
  };
  // So many that one would look for them: one at a time.
  if (active.length > 3) {
    const label = htmlElement("label", "", "Forces of ", byId("plots"));
    label.id = "choice";
    const choice = htmlElement("select", "", undefined, label);
    for (const k of inOrder) choice.append(new Option(`${forces.names[k]}${constant.has(k) ? " (constant)" : ""}`, k));
    choice.addEventListener("change", () => plots.choose(Number(choice.value)));
  }

  for (const k of inOrder) {
    const contact = scenery.contacts[k];
    const points = forces.points.filter((point) => point.contact === k);
    const suffix = scenery.contacts.length > 1 ? `, ${forces.names[k]}` : "";
    const strikes = points.filter(({ impacts }) => impacts);
    // Colours are for those that touch: of all there would be too many.
    const series = (key, factor, of = points) => of.map((point) => {
      const named = { label: contact.points[point.point].label, index: points.indexOf(point) };
      const course = point.course?.[["normal", "tangential"].indexOf(key)];
      const means = { ...named, t: forces.borders, y: scaled(point[key], factor), stepped: true };
      if (!course) return means;
      const known = forces.compliant?.includes(k) ? knownOf(course, factor) : atPictures(means);
      return { ...named, t: curves.t, y: scaled(course.y, factor), known };
    });
    for (const [i, [key, title]] of [["normal", "Normal force"], ["tangential", "Tangential force"]].entries()) {
      if (key === "tangential" ? forces.frictionless.includes(k) : forces.forceless?.includes(k)) continue;
      const [prefix, factor] = forces.units[k][i];
      const sums = key === "tangential" && forces.shares?.includes(k);
      const [, sum] = forces.sums?.find(([of]) => of === k) ?? [];
      // Its colour is that of none of the points.
      const ofSum = { label: "sum", index: points.length };
      const meansOfSum = { ...ofSum, t: forces.borders, y: scaled(sumOf(points), factor), stepped: true };
      const lines = !sums ? series(key, factor) : [sum ? { ...ofSum, t: curves.t, y: scaled(sum, factor), known: atPictures(meansOfSum) } : meansOfSum];
      const means = key === "normal" ? points.filter(({ mean }) => mean).map((point) =>
        ({ label: contact.points[point.point].label, index: points.indexOf(point), t: forces.borders, y: scaled(point.mean, factor) })) : [];
      for (const line of lines) line.raw = means.some(({ index }) => index === line.index);
      const least = 1e-6 * strongest * factor;
      plots.add({
        id: `${key}-${k}`, contact: k, title: title + suffix, unit: `${prefix}N`, series: overTheRaw(lines, means), cut: forces.cuts[k][i] ?? undefined, floor: 0, least, height: 150,
      });
      const enlarged = key === "normal" && forces.enlarged[k];
      const over = `${forces.rigid}${strikes.length ? " without the impacts" : ""}`;
      const ofSprings = forces.compliant?.includes(k);
      if (ofSprings && forces.springs) htmlElement("p", "note", sentence(forces.springs), byId(`panel-${key}-${k}`));
      if (!ofSprings) htmlElement("p", "note", means.length ? `Pale: ${over}. Strong: without vibrations of periods below ${forces.period}.` : sentence(over), byId(`panel-${key}-${k}`));
      const [, unsmoothed] = (means.length && forces.unsmoothed?.find(([of]) => of === k)) || [];
      if (unsmoothed) htmlElement("p", "note", sentence(unsmoothed), byId(`panel-${key}-${k}`));
      if (sums) {
        htmlElement("p", "note", "The sum over the points: how those that stick share it, equilibrium leaves open. Their shares are in contacts.csv.", byId(`panel-${key}-${k}`));
      }
      if (forces.redundant?.includes(k)) {
        // On paper once for both.
        const isSaid = key === "tangential" && !forces.forceless?.includes(k);
        htmlElement("p", `note${isSaid ? " said" : ""}`, "Equilibrium alone doesn't decide these forces: of rigid bodies that are held more than they need be, they are one of many sets that keep them in balance.", byId(`panel-${key}-${k}`));
      }
      if (enlarged) {
        plots.add({
          id: `enlarged-${k}`, contact: k, title: `Normal force, enlarged${suffix}`, unit: `${prefix}N`, series: overTheRaw(lines, means).map((line) => ({ ...line })), cut: enlarged,
          enlarged: true, floor: 0, least, height: 130,
        });
        htmlElement("p", "note", `The same ${enlarged.reach}.`, byId(`panel-enlarged-${k}`));
      }
    }
    if (strikes.length) {
      const [prefix, factor] = forces.impulse_units[k];
      plots.add({
        id: `impacts-${k}`, contact: k, title: `Normal impulse of impacts${suffix}`, unit: `${prefix}N s`, series: series("impacts", factor, strikes).map((line) => ({ ...line, bars: true })), floor: 0, least: 1e-300, height: 110,
      });
      htmlElement("p", "note", sentence(forces.struck), byId(`panel-impacts-${k}`));
    }
    plots.add({
      id: `state-${k}`, contact: k, title: `Contact state${suffix}`, series: [],
      bands: points.map(({ point, state }) => {
        const { short, label, on_side: onSide } = contact.points[point];
        return { short: several || onSide ? short : label.replace("bottom ", ""), name: several ? label : undefined, state };
      }),
      height: plots.margin.top + plots.margin.bottom + plots.rowHeight * points.length,
    });
    const [, turning] = forces.alternating?.find(([of]) => of === k) ?? [];
    const [, unseen] = forces.unseen_slip?.find(([of]) => of === k) ?? [];
    const notes = [
      points.some(({ state }) => state.includes("b")) ? "Presses briefly: in at most half of the steps, as what strikes or chatters." : "",
      turning ? sentence(`${turning} by turns, so that the tangential force changes from step to step: the band has what is done in most of ${forces.bucket}`) : "",
      unseen ? `Slip of less than ${unseen} at a time is drawn as sticking.` : "",
    ].filter(Boolean);
    if (notes.length) htmlElement("p", "note", notes.join(" "), byId(`panel-state-${k}`));
  }

  if (scenery.hidden_points > 0 || scenery.unlisted) {
    const many = scenery.hidden_points > 0 ? `No contact has plots of its own: ${scenery.hidden_points} points can touch, more than 2000.`
      : "Pairs of blocks that no [contact] names have no plots of their own.";
    const where = network ? "The network in the picture shows their forces, and contacts.csv" : "contacts.csv";
    htmlElement("p", "note", `${many} ${where} has their impulses.`, byId("plots")).id = "hidden-contacts";
  }

  addPanels(true);
  if (document.querySelector("#plots .key b")) {
    const note = htmlElement("p", "note", "Numbers beside names: values at the time of the picture, or under the pointer.");
    if (data.panels.some(({ series }) => series.some(({ raw }) => raw)) || forces.points.some(({ mean }) => mean)) note.append(" Where a curve is pale: its value, then in brackets that of the strong one.");
    note.id = "readouts";
    byId("plots").prepend(note);
  }
  if (active.length > 3) {
    const hardest = strongestContacts(1)[0];
    byId("choice").querySelector("select").value = hardest;
    plots.choose(hardest);
  }
  const note = htmlElement("p", "note", undefined, byId("panel-works") ?? byId("panel-energy") ?? byId("plots"));
  note.append("Of the energy identity, the worst step leaves ");
  note.append(byId("residual").content.cloneNode(true), " of the scene's energy unexplained.");

  for (const { id, title, x_label: xLabel, unit, least, guides, note, series } of data.portraits) {
    const [, xName, xUnit] = xLabel.match(/^(.*) \(([^()]*)\)$/);
    plots.add({
      id, title, xName, xUnit, unit, guides, least: least[1], leastX: least[0], portrait: true, height: 300,
      series,
    });
    if (note) htmlElement("p", "note", sentence(note), byId(`panel-${id}`));
  }

  const [slider, play, speed] = ["time-slider", "play", "speed"].map(byId);
  const exaggeration = byId("exaggeration");
  /** The rows of each block in the table of half cycles, with their times. */
  const rowsOf = (() => {
    const byBody = new Map();
    for (const row of document.querySelectorAll("#rocking tbody tr")) {
      const { body } = row.dataset;
      byBody.set(body, [...(byBody.get(body) ?? []), row]);
    }
    return [...byBody.values()].map((own) => [own.map((row) => Number(row.dataset.t)), own]);
  })();
  const hundredths = (x) => (Math.abs(x) < 5e-3 ? "0.00" : x.toFixed(2).replace("-", "−"));
  const decimals = Math.min(9, Math.max(3, Math.ceil(-Math.log10(data.dt))));
  /** The first few blocks that are free to move, by name and number. */
  const readOut = scenery.blocks.map(({ name }, k) => [name, k]).filter(([, k]) => !scenery.blocks[k].driven).slice(0, 4);
  const unread = scenery.blocks.filter(({ driven }) => !driven).length - readOut.length;
  let frame = 0;
  /** Where between the pictures the clock is. */
  let position = 0;
  let clock = null;

  slider.max = times.length - 1;

  function show(index, between = index) {
    frame = Math.min(times.length - 1, Math.max(0, index));
    position = Math.min(times.length - 1, Math.max(0, between));
    const t = times[frame];
    const text = `t = ${t.toFixed(decimals)} s`;
    slider.value = frame;
    slider.setAttribute("aria-valuetext", text);
    byId("time-readout").textContent = text;
    byId("time-readout").dataset.t = t;
    const angles = (crowd ? [] : readOut)
      .map(([name, k]) => `${several ? `${name}: ` : ""}φ = ${hundredths(frames.blocks[k].phi[frame] * degrees)}°`);
    // A list of a few of many, or of zeros, tells nothing on paper, where no other time can be asked for.
    const isTelling = unread === 0 && readOut.some(([, k]) => hundredths(frames.blocks[k].phi[frame] * degrees) !== "0.00");
    byId("scene-readout").classList.toggle("on-screen", !isTelling);
    if (angles.length && unread > 0) angles.push(`… ${unread} more`);
    byId("scene-readout").replaceChildren();
    angles.forEach((text, k) => {
      byId("scene-readout").append(k ? " · " : "");
      htmlElement("span", "", text, byId("scene-readout"));
    });
    // In motion an impact is ringed for a moment, at rest only in the frame that it led to.
    scene.draw(position, clock ? 0.25 * factor() : 0);
    if (!clock) scene.root.setAttribute("aria-label", spoken.picture(frame));
    plots.showTime(t);
    for (const [past, own] of rowsOf) {
      const now = own[indexAt(past, t)];
      own.forEach((row) => row.classList.toggle("now", row === now && past[0] <= t));
    }
  }

  // Speeds that show the whole in 2 s to 200 s, or what moves of it; at first in about 10 s.
  /** Where the animation begins, and how long of the run it is about. */
  let opening = { t: start, lasts: end - start };
  function chooseSpeed() {
    const length = opening.lasts;
    speed.replaceChildren();
    for (const power of [-6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5]) {
      for (const digit of [1, 2, 5]) {
        const value = digit * 10 ** power;
        if (length / value < 2 || length / value > 200) continue;
        const name = value < 1 ? `1/${Number((1 / value).toPrecision(3))}` : String(value);
        speed.append(new Option(`${name} ×`, value));
      }
    }
    if (!speed.options.length) speed.append(new Option("1 ×", 1));
    speed.value = [...speed.options].map((option) => option.value)
      .reduce((best, value) => (Math.abs(Math.log(length / value / 10)) < Math.abs(Math.log(length / best / 10)) ? value : best));
  }
  chooseSpeed();
  const factor = () => Number(speed.value);

  function setPlaying(on) {
    clock = on ? { wall: performance.now(), t: frame >= times.length - 1 ? opening.t : times[frame] } : null;
    play.textContent = on ? "Pause" : "Play";
    play.setAttribute("aria-label", play.textContent);
    if (on) requestAnimationFrame(tick);
    else scene.root.setAttribute("aria-label", spoken.picture(frame));
  }

  function tick(wall) {
    if (!clock) return;
    clock.t += (Math.max(0, wall - clock.wall) / 1e3) * factor();
    clock.wall = wall;
    show(frameAt(clock.t), positionAt(clock.t));
    if (clock.t >= times[times.length - 1]) setPlaying(false);
    else requestAnimationFrame(tick);
  }

  /** The pictures before and after a time, as one number. */
  function positionAt(t) {
    const i = indexAt(times, t);
    return i + 1 < times.length ? i + Math.min(1, Math.max(0, (t - times[i]) / (times[i + 1] - times[i]))) : i;
  }

  function seek(t) {
    if (clock) clock.t = t;
    show(frameAt(t));
  }

  function step(by) {
    setPlaying(false);
    show(frame + by);
  }

  play.addEventListener("click", () => setPlaying(!clock));
  slider.addEventListener("input", () => {
    if (clock) clock.t = times[Number(slider.value)];
    show(Number(slider.value));
  });
  const factors = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  function exaggerate(value) {
    const slot = factors.reduce((best, one, k) => (Math.abs(one - value) < Math.abs(factors[best] - value) ? k : best), 0);
    exaggeration.value = slot;
    const text = value === 1 ? "true scale" : `exaggerated ${value} ×`;
    byId("exaggeration-readout").textContent = text;
    exaggeration.setAttribute("aria-valuetext", text);
    byId("true-scale").disabled = value === 1;
    scene.exaggerate(value);
    sayKey(value);
    show(frame);
  }
  exaggeration.addEventListener("input", () => exaggerate(factors[Number(exaggeration.value)]));
  byId("true-scale").addEventListener("click", () => exaggerate(1));
  byId("exaggeration-label").hidden = byId("true-scale").hidden = scenery.beams.length === 0;
  const how = byId("network");
  for (const [value, name, there] of [["network", "network", network], ["arrows", "arrows", forces.points.length], ["none", "hidden", true]]) {
    if (there) how.append(new Option(name, value));
  }
  byId("network-label").hidden = how.options.length < 2;
  // Of few blocks the arrows show more, of many they would hide each other.
  how.value = network && (scenery.blocks.length > 4 || !forces.points.length) ? "network" : how.options[forces.points.length && network ? 1 : 0].value;
  how.addEventListener("change", () => {
    scene.forces(how.value);
    sayKey();
  });

  const followBox = byId("follow");
  followBox.parentElement.hidden = scenery.blocks.length === 0;
  byId("view-in").addEventListener("click", () => scene.zoomBy(1.5));
  byId("view-out").addEventListener("click", () => scene.zoomBy(1 / 1.5));
  byId("view-all").addEventListener("click", () => scene.showAll());
  followBox.addEventListener("change", () => scene.follow(followBox.checked));
  scene.onView((all) => {
    byId("view-all").disabled = all;
    followBox.checked = scene.isFollowing();
    scene.root.classList.toggle("zoomed", !all);
  });
  byId("view-all").disabled = true;
  /** What a picture that is saved says of itself. */
  const caption = () => {
    const exaggerated = factors[Number(exaggeration.value)];
    return byId("time-readout").textContent + (scenery.beams.length && exaggerated !== 1 ? `, deflections × ${exaggerated}` : "");
  };
  byId("save-picture").addEventListener("click", () =>
    savePicture(scene.root, `${document.title.replace(/[^\p{L}\p{N}]+/gu, "-")}-${times[frame].toFixed(decimals)}s.svg`, caption()));

  /** A place of the pointer in the picture's own units. */
  const inPicture = (event) => {
    const box = scene.root.getBoundingClientRect();
    const size = scene.root.viewBox.baseVal;
    return [((event.clientX - box.left) * size.width) / box.width, ((event.clientY - box.top) * size.height) / box.height];
  };
  scene.root.addEventListener("wheel", (event) => {
    // Further out than all there is nothing: the page scrolls.
    if (event.deltaY > 0 && scene.isWhole()) return;
    event.preventDefault();
    scene.zoomBy(Math.exp(-Math.max(-120, Math.min(120, event.deltaY)) / 300), inPicture(event));
  }, { passive: false });
  let held = null;
  scene.root.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || scene.isWhole()) return;
    held = inPicture(event);
    scene.root.setPointerCapture(event.pointerId);
  });
  scene.root.addEventListener("pointermove", (event) => {
    if (!held) return;
    const now = inPicture(event);
    scene.panBy(now[0] - held[0], now[1] - held[1]);
    held = now;
  });
  for (const end of ["pointerup", "pointercancel"]) scene.root.addEventListener(end, () => { held = null; });
  const picture = {
    "+": () => scene.zoomBy(1.5), "=": () => scene.zoomBy(1.5), "-": () => scene.zoomBy(1 / 1.5), 0: () => scene.showAll(),
    ArrowLeft: () => scene.panBy(40, 0), ArrowRight: () => scene.panBy(-40, 0), ArrowUp: () => scene.panBy(0, 40), ArrowDown: () => scene.panBy(0, -40),
  };
  scene.root.addEventListener("keydown", (event) => {
    const action = picture[event.key];
    // Where all is shown the arrows step through time, as everywhere else.
    if (!action || event.ctrlKey || event.metaKey || event.altKey || (event.key.startsWith("Arrow") && scene.isWhole())) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  });
  byId("zoom-reset").addEventListener("click", () => plots.zoom(start, end));
  plots.onSeek(seek);
  plots.onZoom((zoomed) => {
    byId("zoom-reset").disabled = !zoomed;
  });

  const keys = {
    " ": () => setPlaying(!clock),
    ArrowLeft: () => step(-1),
    ArrowRight: () => step(1),
    Home: () => step(-Infinity),
    End: () => step(Infinity),
    "+": () => plots.zoomBy(0.5),
    "=": () => plots.zoomBy(0.5),
    "-": () => plots.zoomBy(2),
    0: () => plots.zoom(start, end),
  };
  document.addEventListener("keydown", (event) => {
    // A control keeps its own keys. Those that one may hit by speaking or scrolling act only where a plot or the picture
    // has the focus.
    const own = event.target.closest?.("input, select, button, summary, pre, .scroll");
    const anywhere = [" ", "ArrowLeft", "ArrowRight"].includes(event.key);
    const mine = own ? own === slider && event.key === " " : anywhere || event.target.closest?.(".plot, #scene");
    const action = keys[event.key];
    if (!mine || !action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });

  function sayKey(exaggerated = factors[Number(exaggeration.value)]) {
    const parts = [];
    if (how.value === "arrows" && forces.points.length) parts.push("Green arrows: the contact's force on the block, mean since the sample before, without impacts.");
    if (how.value === "network") {
      parts.push(`Green lines: contact forces, from centre to centre through the centre of pressure, straight through what two opposed forces hold, means since the picture before; widest: ${withPrefix(chains.usual, "N")} or more.`);
    }
    if (data.loads.length) parts.push("Purple arrows: loads.");
    if (data.impacts.length) {
      parts.push(data.density
        ? `Rings: impacts. Ticks on the plots: how many of the ${data.impact_count} impacts are about a time, by their length; zoomed in, each one.`
        : "Rings, and ticks on the plots: impacts.");
    }
    if (crowd) parts.push(`${times.length} pictures; between them the motion is interpolated.`);
    else if (scenery.blocks.length) parts.push("Dotted: the start.");
    if (scenery.beams.length && exaggerated !== 1) parts.push(`Deflections are drawn ${exaggerated} times as large as they are.`);
    if (data.impact_count > data.impacts.length) parts.push(`Only the first ${data.impacts.length} are ringed.`);
    byId("scene-key").textContent = parts.join(" ");
  }

  function relayout() {
    const wasNear = near !== null && (!scene.isWhole() || scene.keepsInSight());
    scene.layout();
    if (wasNear) scene.closeUp();
    plots.redraw();
    show(frame);
  }

  // `#t=0.3&x=5&zoom=0.1,0.2` opens the page at a time, with an exaggeration, zoomed in.
  function fromAddress() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    if (wanted.has("x")) {
      const value = Number(wanted.get("x"));
      exaggerate(value >= 1 ? value : 1);
    }
    const span = (wanted.get("zoom") ?? "").split(",").map(Number);
    if (span.length === 2 && span[0] < span[1]) plots.zoom(span[0], span[1]);
    if (wanted.has("t") && Number.isFinite(Number(wanted.get("t")))) seek(Number(wanted.get("t")));
  }

  /** Where all moves within a small part of the run, the plots open on that. */
  function openOnMotion() {
    if (!data.moving) return;
    const { moves: [first, last], shown: [from, to], beside } = data.moving;
    plots.zoom(from, to);
    opening = { t: times[frameAt(from)], lasts: to - from };
    chooseSpeed();
    show(frameAt(from));
    const say = (t) => `${Number((t * timeUnit[1]).toPrecision(3))} ${timeUnit[0]}`;
    const when = first - start < 1e-3 * (end - start) ? `after ${say(last)}` : `before ${say(first)} or after ${say(last)}`;
    const note = htmlElement("p", "note", `Hardly anything moves${beside ? ` relative to ${beside}` : ""} ${when}: the plots open on what does. `);
    note.id = "opened-on";
    const whole = htmlElement("button", "link", "Show all times", note);
    whole.type = "button";
    whole.addEventListener("click", () => plots.zoom(start, end));
    // Paper has no button, nor what stands after it.
    htmlElement("span", "on-screen", ". ", note);
    if (curves.thinned) note.append(`The curves have the lowest and the highest value of every ${forces.bucket}, not more, however far one zooms in.`);
    byId("plots").prepend(note);
  }

  /** What to say of the picture if it doesn't open on all. */
  let near = null;
  relayout();
  scene.forces(how.value);
  exaggerate(scene.suitable(factors));
  near = scene.closeUp();
  if (near !== null) byId("scene-keys").prepend(near);
  openOnMotion();
  fromAddress();
  window.addEventListener("hashchange", fromAddress);
  let lastWidth = document.documentElement.clientWidth;
  new ResizeObserver(() => {
    // Only a new width asks for a new layout: heights follow from it, and would ask again.
    if (document.documentElement.clientWidth === lastWidth) return;
    lastWidth = document.documentElement.clientWidth;
    requestAnimationFrame(relayout);
  }).observe(document.documentElement);
  /** How far a beam is deflected at most in a picture, m. */
  const bent = (k) => scenery.beams.reduce((most, { points }, beam) => {
    const { unit, w } = frames.beams[beam];
    return w.slice(k * points, (k + 1) * points).reduce((far, x) => Math.max(far, Math.abs(x) * unit), most);
  }, 0);

  /** The picture in which a block is turned furthest from its start, of beams alone that of the largest deflection, and the last one, if it looks otherwise. */
  function telling() {
    const last = times.length - 1;
    const turned = (k) => frames.blocks.reduce((most, { phi }) => Math.max(most, Math.abs(phi[k] - phi[0])), 0);
    const furthest = times.reduce((best, _, k) => (turned(k) > turned(best) ? k : best), 0);
    const swing = turned(furthest) > turned(last) + 1e-3 ? [[furthest, "With a block turned furthest from its start"]] : [];
    const deepest = scenery.blocks.length ? 0 : times.reduce((best, _, k) => (bent(k) > bent(best) ? k : best), 0);
    if (bent(deepest) > 1.05 * Math.max(bent(0), bent(last))) swing.push([deepest, "With the largest deflection"]);
    // What stands still looks as it does now.
    const moves = ({ x, y, phi }, k) => Math.hypot(x[last] - x[frame], y[last] - y[frame]) > 1e-3 * scenery.blocks[k].reach || Math.abs(phi[last] - phi[frame]) > 1e-3;
    const ending = scenery.beams.length > 0 || frames.blocks.some(moves) ? [[last, "At the end"]] : [];
    return [...swing, ...ending].filter(([k]) => k !== frame);
  }

  /** Widths of pictures on an A4 page, px: of two and of three beside each other. */
  const [half, third] = [330, 216];
  /** From this height to their width on three pictures stand beside each other. */
  const tall = 0.5;

  // Paper can't be asked for another time or contact: it has the telling pictures, and the strongest contacts.
  let printed = null;
  window.addEventListener("beforeprint", () => {
    // Long tables stay folded unless they were unfolded before: they are sheets of numbers that the files hold.
    document.querySelectorAll("details.again, #model, #warnings details").forEach((one) => one.setAttribute("open", ""));
    if (printed) return;
    setPlaying(false);
    printed = { frame, pictures: htmlElement("div", "printed") };
    byId("stage").querySelector("figure").after(printed.pictures);
    // Beside each other, with type as large as it is on a screen.
    const pictures = telling();
    byId("stage").classList.toggle("beside", pictures.length > 0);
    if (pictures.length > 0) scene.layoutFor(half);
    if (pictures.length > 1 && scene.crop(true) > tall) {
      byId("stage").classList.add("thirds");
      scene.layoutFor(third);
    }
    for (const [k, why] of pictures) {
      show(k);
      scene.crop(true);
      const figure = htmlElement("figure", "", undefined, printed.pictures);
      const picture = scene.root.cloneNode(true);
      picture.removeAttribute("id");
      figure.append(picture);
      const caption = htmlElement("figcaption", "", `${why}: ${byId("time-readout").textContent}`, figure);
      const angles = byId("scene-readout");
      if (!angles.classList.contains("on-screen")) caption.append(" · ", ...[...angles.childNodes].map((one) => one.cloneNode(true)));
    }
    show(printed.frame);
    scene.crop(true);
    byId("which").textContent = frame === 0 ? "At the start: " : frame === frameAt(opening.t) ? "Before the motion: " : "As chosen on the page: ";
    if (active.length > 3) plots.choose(...strongestContacts(3)); // More would be sheets of plots that look alike.
    // Paper has its own width; drawn for that of the screen, the plots' type would come out too small or too large.
    plots.drawFor(680);
  });
  window.addEventListener("afterprint", () => {
    if (!printed) return;
    scene.crop(false);
    printed.pictures.remove();
    byId("stage").classList.remove("beside", "thirds");
    scene.layoutFor(null);
    show(printed.frame);
    printed = null;
    if (active.length > 3) plots.choose(Number(byId("choice").querySelector("select").value));
    plots.drawFor(null);
  });
})();
