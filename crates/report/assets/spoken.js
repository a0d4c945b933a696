// What a plot or the picture shows, in words, for those who hear the page.

const spoken = (() => {
  const round = (x) => number(x, 3);
  const atTime = (t) => `${Number(t.toPrecision(6))} s`;

  /** The numbers of least and largest value, of several that differ by rounding the first; `null` of a series without any. */
  function ends(values) {
    let [low, high] = [null, null];
    values.forEach((x, i) => {
      if (x === null || !Number.isFinite(x)) return;
      if (low === null || x < values[low] - 1e-9 * Math.abs(values[low])) low = i;
      if (high === null || x > values[high] + 1e-9 * Math.abs(values[high])) high = i;
    });
    return low === null ? null : [low, high];
  }

  function ofSeries({ label, t, y, upper }) {
    const name = label ? `${label}: ` : "";
    const found = ends(y);
    if (!found) return `${name}no value`;
    const [low] = found;
    const top = upper ?? y;
    const [, high] = ends(top) ?? found;
    if (top[high] === y[low]) return `${name}${round(y[low])} throughout`;
    return `${name}least ${round(y[low])} at ${atTime(t[low])}, largest ${round(top[high])} at ${atTime(t[high])}`;
  }

  /** How much of the time a contact sticks, slips, is open. */
  function ofBand({ short, state }) {
    const share = (letter) => [...state].filter((one) => one === letter).length / Math.max(1, state.length);
    const [stick, slip, briefly] = [share("k"), share("l"), share("b")];
    const percent = (part) => `${Math.round(100 * part)} %`;
    return `${short}: sticks ${percent(stick)}, slips ${percent(slip)}, ${briefly ? `presses briefly ${percent(briefly)}, ` : ""}is open ${percent(1 - stick - slip - briefly)} of the time`;
  }

  function ofPortrait({ label, x, y }, { xName, xUnit, title, unit }) {
    const [across, up] = [ends(x), ends(y)];
    if (!across || !up) return "no value";
    const [, rate] = title.match(/: (\S+) over /) ?? [, "its velocity"];
    return `${label ? `${label}: ` : ""}${xName} from ${round(x[across[0]])} to ${round(x[across[1]])} ${xUnit}, `
      + `${rate} from ${round(y[up[0]])} to ${round(y[up[1]])} ${unit}`;
  }

  /** A plot: its title, unit, and the extremes of its curves. */
  function plot(panel) {
    const unit = panel.unit && !panel.portrait ? ` in ${panel.unit}` : "";
    const parts = panel.bands ? panel.bands.map(ofBand) : panel.series.map((series) => (panel.portrait ? ofPortrait(series, panel) : ofSeries(series)));
    return `${panel.title}${unit}. ${parts.join("; ")}.`;
  }

  /** The picture in a frame: where the bodies are. Of many only how many they are. */
  function picture(frame) {
    const when = `The scene at t = ${atTime(times[frame])}`;
    if (scenery.blocks.length > 12) return `${when}: ${scenery.blocks.length} bodies`;
    const bodies = scenery.blocks.map(({ name }, k) => {
      const { x, y, phi } = frames.blocks[k];
      return `${name} at x = ${round(x[frame])} m, y = ${round(y[frame])} m, φ = ${round(phi[frame] * degrees)}°`;
    });
    const beams = scenery.beams.map(({ name, span }, k) => `${name}: w = ${round(deflection(k, frame, span / 2) * 1e3)} mm at midspan`);
    return [when, bodies.concat(beams).join("; ")].filter(Boolean).join(": ");
  }

  return { plot, picture };
})();
