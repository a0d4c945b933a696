// Legends that stand for those of other plots.

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
