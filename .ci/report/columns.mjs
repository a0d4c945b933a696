// The data of a page, with its packed columns of numbers read: by the format that crates/report/src/page/data/column.rs describes, apart from
// the page's own script.

/** Whole numbers of seven bits a byte, lowest first, in base64. */
export function wholeNumbers(text) {
  const numbers = [];
  let [number, place] = [0n, 0n];
  for (const byte of Buffer.from(text, "base64")) {
    number |= BigInt(byte & 127) << place;
    place += 7n;
    if (byte & 128) continue;
    numbers.push(number);
    [number, place] = [0n, 0n];
  }
  return numbers;
}

/** A difference from its number: 0, 1, 2, 3 are 0, −1, 1, −2. */
export const signed = (number) => Number(number & 1n ? -(number + 1n) / 2n : number / 2n);

function column({ unit, order, packed }) {
  const values = [];
  let [before, now] = [0, 0];
  for (const number of wholeNumbers(packed)) {
    if (number === 0n) {
      values.push(null);
      continue;
    }
    const next = signed(number - 1n) + (order === 2 ? 2 * now - before : now);
    [before, now] = [now, next];
    values.push(next * unit);
  }
  return values;
}

/** The data of a page from its text. */
export const pageData = (text) => JSON.parse(text, (_, value) => (typeof value?.packed === "string" ? column(value) : value));
