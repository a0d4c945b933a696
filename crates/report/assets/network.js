// The network of contact forces: between two blocks a line from one centre to the other through the centre of pressure,
// between a block and anything else (ground, a beam, a block whose motion is prescribed) from its centre to there. Through a block that two
// opposed forces hold, as a drum of a column, it goes straight. As wide as the force is large.

const chains = (() => {
  if (!network) return null;
  const classes = 12;

  /** The force that has the widest line: the median over the pictures of their largest. */
  const usual = (() => {
    const sizes = network.largest.filter((force) => force > 0).sort((a, b) => a - b);
    return sizes[Math.floor(sizes.length / 2)] || 1;
  })();

  /** How thick a block is: twice the distance from its mass centre to its nearest side, of a disc its diameter. */
  const thickness = ({ corners, reach }) => {
    const sides = corners.map(([x, y], k) => {
      const [u, v] = corners[(k + 1) % corners.length];
      return Math.abs(x * v - u * y) / Math.hypot(u - x, v - y);
    }).filter((far) => far > 0);
    return 2 * (corners.length > 2 && sides.length ? Math.min(...sides) : reach);
  };
  const sizes = scenery.blocks.map(thickness).sort((a, b) => a - b);
  const typical = sizes[Math.floor(sizes.length / 2)];
  let shown = { picture: -1, links: [] };

  /** The links of a picture; at the start, before any step, those of the first steps. */
  function linksAt(at) {
    const picture = Math.max(at, Math.min(1, times.length - 1));
    if (shown.picture !== picture) shown = { picture, links: linksOf(picture) };
    return shown.links;
  }

  function build(parent) {
    const group = svgElement("g", { class: "network" }, parent);
    return Array.from({ length: classes }, () => svgElement("path", {}, group));
  }

  /** Draws the links of a picture, with the poses of the blocks and where a place (m) is in the picture. */
  function draw(paths, picture, poseOf, place, scale) {
    const lines = paths.map(() => "");
    // A third of a slender block at most, so that the block is seen beside it.
    const widest = Math.min(9, Math.max(1.2, 0.3 * typical * scale));
    const placed = linksAt(picture).map((link) => {
      const pose = poseOf(network.pairs[link.pair][0]);
      const [sin, cos] = [Math.sin(pose.phi), Math.cos(pose.phi)];
      return { link, at: [pose.x + cos * link.x - sin * link.y, pose.y + sin * link.x + cos * link.y] };
    });
    const joints = new Map();
    for (const { link, at } of placed) {
      network.pairs[link.pair].forEach((k, side) => { if (link.through[side]) joints.set(k, [...(joints.get(k) ?? []), at]); });
    }
    /** Where lines end in a block: halfway between its joints, where they go straight through it. */
    const nodeOf = (k) => {
      const [a, b] = joints.get(k) ?? [];
      const { x, y } = poseOf(k);
      return b ? place((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) : place(x, y);
    };
    for (const { link, at } of placed) {
      const number = Math.min(classes, Math.round((link.force / usual) * classes));
      if (number === 0) continue;
      const centres = network.pairs[link.pair].filter((k) => k >= 0 && !scenery.blocks[k].driven).map(nodeOf);
      const middle = place(...at);
      const line = centres.length ? `M${centres[0]}L${middle}${centres.length > 1 ? `L${centres[1]}` : ""}` : "";
      lines[number - 1] += line;
    }
    paths.forEach((path, k) => setAll(path, { d: lines[k], "stroke-width": ((widest * (k + 1)) / classes).toFixed(2) }));
  }

  const clear = (paths) => paths.forEach((path) => path.setAttribute("d", ""));

  return { build, draw, clear, usual, linksAt };
})();
