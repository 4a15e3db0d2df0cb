// Fails when PhysX does not give the committed traces any more, or when they outgrow their allowance.
import fs from "node:fs";
import { traces } from "./traces.mjs";

const LARGEST_FILE = 200_000;
const TOLERANCE = 1e-6;

const text = fs.readFileSync(new URL("traces.json", import.meta.url), "utf8");
const faults = [];
if (text.length > LARGEST_FILE) {
  faults.push(`traces.json has ${text.length} bytes, more than ${LARGEST_FILE}`);
}
const committed = JSON.parse(text);
const fresh = await traces();
for (const name of new Set([...Object.keys(committed), ...Object.keys(fresh)])) {
  const [a, b] = [committed[name], fresh[name]];
  if (!a || !b) {
    faults.push(`${name}: ${a ? "no such scenario any more" : "not recorded"}`);
    continue;
  }
  const [x, y] = [a.bodies.flat(), b.bodies.flat()];
  const gap = x.length === y.length ? x.reduce((worst, v, i) => Math.max(worst, Math.abs(v - y[i])), 0) : Infinity;
  if (!(gap <= TOLERANCE) || JSON.stringify(a.broken) !== JSON.stringify(b.broken)) {
    faults.push(`${name}: differs from the committed trace by ${gap}`);
  }
}
faults.forEach((f) => console.error(f));
console.log(`${Object.keys(fresh).length} scenarios, ${faults.length} faults`);
process.exitCode = faults.length ? 1 : 0;
