// Powers of ten: on axes, whose labels leave them to the unit beside the title, and in values.

/** Numbers and ticks that the page's own functions, taken from the text of its `script`, write wrongly. */
export function wrongPowers(script) {
  const [from, to] = [script.indexOf("function number("), script.indexOf("/** The unit of times over the whole run")];
  if (!(from >= 0 && to > from)) return ["the functions that write numbers are not where this check looks for them"];
  const { number, ticks, unitWith, powerOfTen } = new Function(`${script.slice(from, to)}; return { number, ticks, unitWith, powerOfTen };`)();
  const problems = [];
  const expect = (what, found, wanted) => found === wanted || problems.push(`${what} is "${found}", not "${wanted}"`);
  expect("10⁻¹²", powerOfTen(-12), "10⁻¹²");
  expect("a small number", number(-3.25e-7, 3), "−3.25 × 10⁻⁷");
  expect("a large number", number(1234567, 4), "1.235 × 10⁶");
  expect("a usual number", number(-0.0123, 3), "−0.0123");
  for (const [low, high, power, last] of [[0, 3.1e-6, -6, "3"], [-2.2e7, 1e7, 6, "10"], [0, 5.2e-10, -12, "500"], [0, 12, 0, "10"]]) {
    const found = ticks(low, high, 4);
    expect(`the power from ${low} to ${high}`, found.power, power);
    expect(`the last label from ${low} to ${high}`, found[found.length - 1].label, last);
    expect("the unit", unitWith(power, "m"), power ? `10${{ "-6": "⁻⁶", 6: "⁶", "-12": "⁻¹²" }[power]} m` : "m");
    found.forEach(({ at, label }) => {
      const read = Number(label.replace("−", "-")) * 10 ** power;
      if (Math.abs(read - at) > 1e-9 * (high - low)) problems.push(`a label from ${low} to ${high} reads ${read} at ${at}`);
    });
  }
  return problems;
}

/** Plots whose highest point, read by their labels with the power and the offset beside the title, isn't their largest value; `data` is that of the page,
    unpacked. */
export async function wrongAxes(page, data) {
  const drawn = await page.$$eval("#plots .panel:not([hidden])", (all) => all.map((panel) => ({
    id: panel.id.replace("panel-", ""),
    unit: panel.querySelector(".unit")?.textContent ?? "",
    offset: panel.querySelector(".offset")?.textContent ?? "",
    labels: [...panel.querySelectorAll('.plot text[text-anchor="end"]')].map((text) => [Number(text.getAttribute("y")) - 4, text.textContent]),
    tops: [...panel.querySelectorAll(".curve")].map((curve) => Math.min(...[...curve.getAttribute("d").matchAll(/[ML][-0-9.]+ ([-0-9.]+)/g)].map(([, y]) => Number(y)))),
  })));
  const read = (text) => Number(text.replace("−", "-"));
  const power = (text) => {
    const [, raised] = text.match(/10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/) ?? [, ""];
    return raised ? Number([...raised].map((sign) => (sign === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(sign))).join("")) : 0;
  };
  return drawn.flatMap(({ id, unit, offset, labels, tops }) => {
    const own = data.panels.find((panel) => panel.id === id);
    if (!own || own.cut || labels.length < 2 || !tops.length || data.moving || own.series.some(({ raw }) => raw)) return [];
    const [, sign, size] = offset.match(/([−+]) ([0-9.]+)/) ?? [, "+", "0"];
    const from = (sign === "−" ? 1 : -1) * Number(size);
    const [[y0, first], [y1, second]] = [labels[0], labels[labels.length - 1]].map(([y, text]) => [y, read(text) * 10 ** power(unit) + from]);
    const found = first + ((second - first) * (Math.min(...tops) - y0)) / (y1 - y0);
    const wanted = Math.max(...own.series.flatMap(({ y }) => y.filter((value) => value !== null)));
    const pixel = Math.abs((second - first) / (y1 - y0));
    return Math.abs(found - wanted) > 1.5 * pixel ? [`${id}: its highest point reads ${found} ${unit}, its largest value is ${wanted}`] : [];
  });
}
