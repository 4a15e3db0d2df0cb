// Fails when PhysX does not give the committed traces any more, or when they outgrow their allowance.
import fs from "node:fs";
import { loadPhysX5 } from "./physx5.mjs";
import { run } from "./run.mjs";
import { scenarios } from "./scenarios.mjs";

const LARGEST_FILE = 200_000;
const TOLERANCE = 1e-6;

const text = fs.readFileSync(new URL("traces.json", import.meta.url), "utf8");
const faults = text.length > LARGEST_FILE ? [`traces.json has ${text.length} bytes, more than ${LARGEST_FILE}`] : [];
const committed = new Map(JSON.parse(text).map(({ trace, ...scenario }) => [scenario.name, { trace, scenario }]));
const world = await loadPhysX5();
for (const scenario of scenarios) {
  const known = committed.get(scenario.name);
  if (!known || JSON.stringify(known.scenario) !== JSON.stringify(scenario)) {
    faults.push(`${scenario.name}: not recorded as it stands`);
    continue;
  }
  const [x, y] = [known.trace.bodies.flat(), run(world, scenario).bodies.flat()];
  const gap = x.length === y.length ? x.reduce((worst, v, i) => Math.max(worst, Math.abs(v - y[i])), 0) : Infinity;
  if (!(gap <= TOLERANCE)) {
    faults.push(`${scenario.name}: differs from the committed trace by ${gap}`);
  }
  committed.delete(scenario.name);
}
faults.push(...[...committed.keys()].filter((name) => !scenarios.some((s) => s.name === name)).map((name) => `${name}: no such scenario any more`));
faults.forEach((f) => console.error(f));
console.log(`${scenarios.length} scenarios, ${faults.length} faults`);
process.exitCode = faults.length ? 1 : 0;
