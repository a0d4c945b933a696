// The picture as a file of its own: colours and widths, which the page's style gives, written into it, and below it what the page says beside it: on a
// slide nobody else would say at which time it is, or that deflections are larger than they are.

function savedPicture(root, caption) {
  const copy = root.cloneNode(true);
  const style = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "stroke-linecap", "opacity", "font-size"];
  const write = (from, to) => {
    const computed = getComputedStyle(from);
    to.removeAttribute("class");
    to.removeAttribute("style");
    if (from.namespaceURI.endsWith("svg") && !["defs", "marker", "title", "g", "svg"].includes(from.localName)) {
      for (const name of style) to.setAttribute(name, computed.getPropertyValue(name));
    }
    [...from.children].forEach((child, k) => write(child, to.children[k]));
  };
  write(root, copy);
  for (const name of ["tabindex", "aria-describedby", "id"]) copy.removeAttribute(name);
  const box = root.viewBox.baseVal;
  const height = box.height + 20;
  const paper = svgElement("rect", { width: box.width, height, fill: getComputedStyle(document.body).backgroundColor });
  copy.prepend(paper);
  const text = svgElement("text", { x: 12, y: height - 8, fill: getComputedStyle(document.body).color, "font-size": 12 }, copy);
  text.textContent = caption;
  setAll(copy, { viewBox: `0 0 ${box.width} ${height}`, height });
  setAll(copy, { "font-family": "Helvetica, Arial, sans-serif", xmlns: root.namespaceURI });
  return new XMLSerializer().serializeToString(copy);
}

function savePicture(root, name, caption) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([savedPicture(root, caption)], { type: "image/svg+xml" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
