// Texts that lie over each other.

/** Texts that lie over each other, within each picture and over the whole page. Runs in the page. */
export function overlaps() {
  const found = [];
  const visible = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility !== "hidden";
  const boxesOf = (elements) => elements.filter(visible).filter((e) => e.textContent.trim()).map((e) => {
    const { left, right, top, bottom } = e.getBoundingClientRect();
    return { text: e.textContent.trim().slice(0, 40), left, right, top, bottom };
  });
  const compare = (boxes, where) => {
    for (let i = 0; i < boxes.length; i++) {
      for (let j = i + 1; j < boxes.length; j++) {
        const [a, b] = [boxes[i], boxes[j]];
        const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        // A text's box is higher than its letters.
        if (wide > 1 && high > 3) found.push(`${where}: «${a.text}» and «${b.text}»`);
      }
    }
  };
  for (const svg of document.querySelectorAll("svg")) {
    compare(boxesOf([...svg.querySelectorAll("text")]), svg.id || svg.getAttribute("aria-label") || "picture");
  }
  const leaves = [...document.querySelectorAll("h1, h2, h3, dt, dd, button, label, summary, figcaption > span, p, td, th")]
    .filter((e) => !e.querySelector("p, dt, dd, td, th, button, label"));
  compare(boxesOf(leaves), "page");
  return found;
}
