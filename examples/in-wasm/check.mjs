// Instantiates the module without any import, runs its scene, and compares the motion with that of the native program:
//
//     node check.mjs in_wasm.wasm rows-of-the-native-program.txt
import { readFileSync } from "node:fs";

const [modulePath, nativePath] = process.argv.slice(2);
const fail = (text) => {
  console.error(text);
  process.exit(1);
};

const module = new WebAssembly.Module(readFileSync(modulePath));
const imports = WebAssembly.Module.imports(module);
if (imports.length > 0) {
  fail(`the module asks for ${imports.length} imports: ${imports.map(({ module, name }) => `${module}.${name}`).join(", ")}`);
}
const { exports } = new WebAssembly.Instance(module, {});
const length = exports.run();
if (length === 0) {
  fail("the run failed in the module");
}
const columns = exports.columns();
const found = new Float64Array(exports.memory.buffer, exports.numbers(), length);
const native = readFileSync(nativePath, "utf8").trim().split("\n").map((line) => line.split(" ").map(Number));
if (length !== native.length * columns) {
  fail(`${length / columns} rows in the module, ${native.length} natively`);
}

// What a program with the same conventions may differ by, in t, X, Y, φ and their velocities: the reference cases' tolerance
// `same_scheme` for this scene. (The two have other sines, right to rounding each.)
const tolerance = [1e-12, 1e-11, 1e-11, 1e-11, 1e-9, 1e-9, 1e-9];
let worst = 0;
for (const [k, row] of native.entries()) {
  for (const [column, expected] of row.entries()) {
    const off = Math.abs(found[k * columns + column] - expected);
    // The horizon widens that of the angle at last.
    const allowed = tolerance[column] * (column === 3 && row[0] > 0.35 ? (row[0] > 0.45 ? 7 : 2.5) : 1);
    if (!(off <= allowed)) {
      fail(`t = ${row[0]} s, column ${column}: ${found[k * columns + column]} in the module, ${expected} natively`);
    }
    worst = Math.max(worst, off / allowed);
  }
}
console.log(`${native.length} rows of ${columns} numbers, no import; off by at most ${worst.toExponential(1)} of the tolerance`);
